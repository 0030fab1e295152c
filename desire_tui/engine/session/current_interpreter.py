"""The interpreter of the active program, which comes and goes while its host stays."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.interpreter.interpreter import Interpreter


class CurrentInterpreter:
    """Holds the interpreter for those who made it (`ScriptRunner`) and those it calls (`ScriptHost`)."""

    def __init__(self) -> None:
        self.interpreter: Interpreter | None = None
        """None: no program has run since the names were cleared."""

    def stop_here(self) -> None:
        """Stop the script before the statement that comes next."""
        if self.interpreter is not None:
            self.interpreter.stop_here()

    def runs_ahead(self) -> int | None:
        """Return how many runs come after the one being made; None: that cannot be told."""
        return self.interpreter.runs_ahead() if self.interpreter is not None else None

    def write_to_channel(self, channel: int, text: str) -> None:
        """Write to a file that the script connected."""
        assert self.interpreter is not None, "only a script's run writes to channels"
        self.interpreter.channels.write(channel, text)
