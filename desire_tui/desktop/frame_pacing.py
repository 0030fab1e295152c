"""When the screen is drawn: a run's first frame at once, then no more frames than the terminal takes."""

from __future__ import annotations

from time import monotonic

from desire_tui.actions import Controller

APART_S = 0.03
"""Between a frame and one that does not wait for its turn: not each of a thousand runs is drawn."""
HOLD_S = 0.05


class FramePacing(Controller):
    """Decides when; the panes know what."""

    _drawn_at = 0.0

    def frame(self) -> None:
        """Draw what is new in the graph, unless the terminal has not yet taken the last frame."""
        if not self.is_backed_up and self.app.graph.tick():
            self._drawn_at = monotonic()

    @property
    def is_backed_up(self) -> bool:
        """Whether the terminal is slower than the app."""
        writer = getattr(self.app._driver, "_writer_thread", None)  # noqa: SLF001 - Textual is pinned; it has no public way
        return writer is not None and writer._queue.qsize() > 0  # noqa: SLF001

    def at_once(self) -> None:
        """Draw a graph that has just begun and send it; one that follows another fast waits for its turn."""
        if monotonic() - self._drawn_at >= APART_S and not self.is_backed_up:
            self.frame()
            self.app.main_screen.send_only(*self.app.graph.children)

    def hold(self) -> None:
        """Send nothing to the terminal until a run's first curves stand there, or for a moment.

        What a command changes on its way there — its echo, tabs, status — is one picture after them then, and
        making three pictures of it does not keep the engine's thread waiting.
        """
        screen = self.app.main_screen
        if not screen.is_held:
            screen.hold()
            screen.set_timer(HOLD_S, screen.release)
