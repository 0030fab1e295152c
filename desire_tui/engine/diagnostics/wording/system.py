"""Messages of the system stage."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

MESSAGES: dict[str, Wording] = {
    "out-of-memory": Wording(40, "no room for {elements} more numbers", "make the arrays smaller, or clear"),
}
