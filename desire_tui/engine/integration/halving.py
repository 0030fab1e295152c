"""How far an interval of t is halved to find where something switches or happens in it."""

from __future__ import annotations

RESOLUTION = 1e-30
"""Part of the larger end: two ends are neighbouring numbers long before, except around t = 0, where numbers
are so dense that a thousand halvings, each with the model's equations, would end at 5e-324."""
