"""Messages of the analysis stage."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

MESSAGES: dict[str, Wording] = {}
