"""Exceptions in handlers, timers, workers and widgets that draw never take the desktop down.

Textual (pinned) ends the app at the first one. Here what a message sets off is abandoned, the work is kept,
the fault is written up, and the desktop goes on; it ends where faults come so fast that nothing else happens.
"""

from __future__ import annotations

import contextlib
import traceback
from collections import deque
from time import monotonic
from typing import TYPE_CHECKING

from rich.segment import Segment
from textual._callback import invoke
from textual.message_pump import MessagePump
from textual.strip import Strip
from textual.worker import WorkerFailed

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.geometry import Region
    from textual.message import Message
    from textual.widget import Widget

FAULTS_MOST, WITHIN_S = 100, 1.0
"""With more faults in so short a time the desktop ends. A timer that fails at every frame stays below."""
FAILED = "internal error: this cannot be drawn"

_dispatch = MessagePump._dispatch_message  # noqa: SLF001 - no public way (Textual is pinned)


async def _dispatch_message(pump: MessagePump, message: Message) -> None:
    """Deal with a message; what it raises ends neither the pump's loop nor the app."""
    try:
        await _dispatch(pump, message)
    except Exception as error:  # noqa: BLE001 - the last line
        pump.app._handle_exception(error)  # noqa: SLF001 - as Textual does


async def _flush_next_callbacks(pump: MessagePump) -> None:
    """Call what waits; one that fails does not take the others with it."""
    callbacks = pump._next_callbacks.copy()  # noqa: SLF001 - as Textual does
    pump._next_callbacks.clear()  # noqa: SLF001
    for callback in callbacks:
        try:
            with pump.prevent(*callback._prevent):  # noqa: SLF001
                await invoke(callback.callback)
        except Exception as error:  # noqa: BLE001 - the last line
            pump.app._handle_exception(error)  # noqa: SLF001


def install() -> None:
    """Have messages dispatched behind the barrier."""
    MessagePump._dispatch_message = _dispatch_message  # type: ignore[assignment, method-assign]  # noqa: SLF001
    MessagePump._flush_next_callbacks = _flush_next_callbacks  # type: ignore[assignment, method-assign]  # noqa: SLF001


class FaultBarrier:
    """Counts the faults of one app and reports each once."""

    def __init__(self, keep_work: Callable[[], object], report: Callable[[str, str], object]) -> None:
        self._keep_work = keep_work
        self._report = report
        self._times: deque[float] = deque(maxlen=FAULTS_MOST)
        self._reported: set[tuple[str, ...]] = set()

    def survived(self, error: Exception) -> bool:
        """Keep the work and report a fault; False if the app must end."""
        if isinstance(error, WorkerFailed) and isinstance(error.error, Exception):
            error = error.error
        now = monotonic()
        self._times.append(now)
        if len(self._times) == FAULTS_MOST and now - self._times[0] < WITHIN_S:
            return False
        self._report_once(error)
        return True

    def _report_once(self, error: Exception) -> None:
        place = traceback.extract_tb(error.__traceback__)[-1:]
        key = (
            type(error).__name__,
            str(error)[:80],
            *(f"{frame.filename}:{frame.lineno}" for frame in place),
        )
        if key in self._reported:
            return
        self._reported.add(key)
        with contextlib.suppress(Exception):
            self._keep_work()
        details = "".join(traceback.format_exception(error))
        with contextlib.suppress(Exception):  # where the report itself fails, the log has both
            self._report(f"{type(error).__name__}: {error}", details)

    def guard(self, widget: Widget) -> None:
        """Have a widget that cannot be drawn say so in its place; it is tried again at every frame."""
        draw = widget.render_lines

        def render_lines(crop: Region) -> list[Strip]:
            try:
                return draw(crop)
            except Exception as error:  # noqa: BLE001 - the last line
                self._report_once(error)
                lines = [Strip([Segment(FAILED if y == 0 else "")]) for y in range(crop.height)]
                return [line.adjust_cell_length(crop.width) for line in lines]

        widget.render_lines = render_lines  # type: ignore[method-assign]
