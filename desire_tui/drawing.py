"""When the screen is drawn: a run's first frame at once, then no more frames than the terminal takes."""

from __future__ import annotations

from contextlib import ExitStack
from time import monotonic

from desire_tui.actions import Controller

APART_S = 0.03
"""Between a frame and one that does not wait for its turn: not each of a thousand runs is drawn."""
HOLD_S = 0.05


class Drawing(Controller):
    """Decides when; the panes know what."""

    _drawn_at = 0.0
    _held: ExitStack | None = None

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
        if monotonic() - self._drawn_at >= APART_S:
            self.frame()
            self.release()
            self._send_graph()

    def _send_graph(self) -> None:
        """Send what is new in the graph, and nothing else; Textual's own way takes up to 20 ms longer."""
        desk = self.app.desk
        if desk.is_current and not self.is_backed_up:
            compositor = desk._compositor  # noqa: SLF001 - as above
            compositor.update_widgets(set(self.app.graph.children) & compositor.visible_widgets.keys())
            desk._compositor_refresh()  # noqa: SLF001 - as above

    def hold(self) -> None:
        """Send nothing to the terminal until a run's first curves stand there, or for a moment.

        What a command changes on its way there — its echo, tabs, status — then is one picture with them, and
        making three pictures of it does not keep the engine's thread waiting.
        """
        if self._held is None:
            self._held = ExitStack()
            self._held.enter_context(self.app.batch_update())
            self.app.desk.set_timer(HOLD_S, self.release)

    def release(self) -> None:
        """Send what has changed meanwhile."""
        if self._held is not None:
            held, self._held = self._held, None
            held.close()
            self.app.desk.check_idle()
