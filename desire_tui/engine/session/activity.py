"""What a session is doing, and the frame of everything that may be paused and ended."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellable
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.session.status import State

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.runtime.pause_and_stop import Control


class Activity:
    """The session's state. Changed on the session's thread, read from any."""

    def __init__(self, control: Control) -> None:
        self._control = control
        self.state = State.IDLE

    @contextmanager
    def during(self, state: State) -> Iterator[None]:
        """Be in a state for a while, then in the one before."""
        before, self.state = self.state, state
        try:
            yield
        finally:
            self.state = before

    @contextmanager
    def working(self, state: State) -> Iterator[None]:
        """Frame of work that the user may pause and end. May nest."""
        self._control.begin()
        try:
            with self.during(state), cancellable(self._leave):
                yield
        finally:
            self._control.done()

    def _leave(self) -> None:
        """Break off what is prepared for a script or a run."""
        if self._control.ending:
            raise Interrupted

    @property
    def ending(self) -> bool:
        """Whether the user wants the work to end."""
        return self._control.ending

    def interrupted(self) -> bool:
        """Wait while the user pauses; return whether the work is to end."""
        if self._control.paused:
            with self.during(State.PAUSED):
                self._control.wait()
        return self._control.ending
