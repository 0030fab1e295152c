"""What the actions of the command table do: one controller for each part of the desktop.

A method's argument is what followed the word on the command line, empty for a key. Methods that ask the user
something are coroutines; the app runs them in a worker.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.app import DesireApp


class Controller:
    """Base of the controllers."""

    def __init__(self, app: DesireApp) -> None:
        self.app = app
