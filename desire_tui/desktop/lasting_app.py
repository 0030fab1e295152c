"""The app keeps the user's work however it ends: at faults of ours, at signals, when a page goes away."""

from __future__ import annotations

import asyncio
import contextlib
import signal
import threading
import traceback
from typing import TYPE_CHECKING, Any

from desire_tui.common import paths
from desire_tui.desktop import fault_barrier, forced_end
from desire_tui.desktop.app_base import AppBase
from desire_tui.desktop.engine_messages import EngineFault
from desire_tui.editor import recovery
from desire_tui.editor.checkpoints import Checkpoints

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.dom import DOMNode
    from textual.widget import Widget

    from desire_tui.engine.session.permissions import Permissions
    from desire_tui.language.live_check import LiveChecker


class LastingApp(AppBase):
    """What keeps the work safe, and the app going."""

    checker: LiveChecker

    def __init__(self, permissions: Permissions | None) -> None:
        super().__init__(permissions)
        self.checkpoints = Checkpoints(self.editor)
        fault_barrier.install()
        self.faults = fault_barrier.FaultBarrier(self.checkpoints.checkpoint, self.log_fault)
        self.is_shown = False
        """Whether the desktop stands; before, a fault ends it."""

    # -------------------------------------------------------------------------------------------- the work

    def checkpoint(self) -> None:
        """Write unsaved work to the recovery file, as soon as there can be any."""
        if not self.checkpoints.checkpoint():
            self._not_kept()

    def checkpoint_soon(self) -> None:
        """Write unsaved work while the user types on."""
        self.checkpoints.begin(lambda: self.on_screen(self._not_kept))

    def on_exit_app(self) -> None:
        """Keep the work when a served page goes away."""
        if not self._exit:
            self.checkpoint()
            self._stop_engine()

    def _not_kept(self) -> None:
        folder = paths.state_folder()
        self.notify(
            f"Unsaved work cannot be kept safe: {folder} cannot be written.",
            severity="warning",
            markup=False,
        )

    def on_app_blur(self) -> None:
        """Keep the work safe when the window loses the focus."""
        self.checkpoint()

    # ------------------------------------------------------------------------------------------------- end

    def listen_to_signals(self) -> None:
        """End well when another process asks for it."""
        if threading.current_thread() is threading.main_thread():
            loop = asyncio.get_running_loop()

            def asked(*_: object) -> None:  # at once, even while a handler of ours waits or computes
                forced_end.end_soon(self.checkpoints.checkpoint)
                with contextlib.suppress(RuntimeError):  # the loop is over: the process is about to end
                    loop.call_soon_threadsafe(self._ended_from_outside)

            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, asked)

    def _ended_from_outside(self) -> None:
        """End at a signal or a lost connection: the work is kept, the terminal restored."""
        self.checkpoint()
        self._stop_engine()
        self.exit()

    def leave(self) -> None:
        """End well."""
        self._stop_engine()
        self.checkpoints.leave()
        self.exit()

    async def _close_all(self) -> None:
        """Leave widgets and threads as they are if the process ends with the desktop: widgets take 0.1 s."""
        if self.is_headless:
            await super()._close_all()
            self.engine.end()
            self.checker.end()

    def _stop_engine(self) -> None:
        if self.engine.is_ready:
            self.session.end()

    # ---------------------------------------------------------------------------------------------- faults

    def _handle_exception(self, error: Exception) -> None:
        """Go on after a fault of ours; end where that is not possible."""
        if self.is_headless and self._exception is None:  # what runs the desktop without a terminal is told
            self._exception = error
            self._exception_event.set()
        if not self.faults.survived(error) or not self.is_shown:
            self.end_badly(error)

    def end_badly(self, error: Exception) -> None:
        """End the desktop; why, and where the work is, stands on the normal screen."""
        from rich.text import Text

        if self._return_code == 1:
            return  # it is ending
        self.checkpoints.checkpoint()  # says nothing, unlike the app's own
        kept = recovery.recovery_file()
        sentences = [f"Desire ended: {type(error).__name__}: {error}"]
        if (log := self.write_fault("".join(traceback.format_exception(error)))) is not None:
            sentences.append(f"Details are in {log}.")
        if kept.exists():
            sentences.append(f"Unsaved work is kept in {kept}; the next start offers it.")
        self._exit_renderables.append(Text("\n".join(sentences)))
        self._return_code = 1
        self._close_messages_no_wait()

    def _register(self, parent: DOMNode, *widgets: Widget, **options: Any) -> list[Widget]:
        """Let no widget that cannot be drawn keep the others from being drawn."""
        for widget in widgets:
            self.faults.guard(widget)
        return super()._register(parent, *widgets, **options)

    def in_background(self, job: Callable[[], None]) -> None:
        """Do something slow that is not the engine's, such as drawing a picture."""

        def watched() -> None:
            try:
                job()
            except Exception as error:  # noqa: BLE001 - the last line: threads have nobody else to tell
                self.report_fault(error)

        threading.Thread(target=watched, daemon=True, name="desire-picture").start()

    def report_fault(self, error: BaseException) -> None:
        """Tell the user of a fault of ours in another thread."""
        self.post_message(
            EngineFault(f"{type(error).__name__}: {error}", "".join(traceback.format_exception(error)))
        )
