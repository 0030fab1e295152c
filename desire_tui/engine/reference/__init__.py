"""The lowered segment evaluated by NumPy: the yardstick in tests."""

from __future__ import annotations

from desire_tui.engine.reference.backend import ReferenceBackend

__all__ = ["ReferenceBackend"]
