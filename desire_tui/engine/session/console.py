"""Where a session's output goes."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.session.listener import Listener
    from desire_tui.engine.session.notebook import Notebook


class Console:
    """Output of scripts and commands: to the front end, and into the notebook."""

    def __init__(self, listener: Listener, notebook: Notebook) -> None:
        self._listener, self._notebook = listener, notebook

    def write(self, text: str) -> None:
        """Write exactly this text."""
        self._notebook.output(text)
        self._listener.console_text(text)
