"""Running programs: accept, run, pause, go on, trace, breakpoints, live mode."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.actions import Controller
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.status import State
from desire_tui.engine.source import Source
from desire_tui.engine.visible_text import visible_line
from desire_tui.language.live_check import CHECKED_MAX

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.editor.code_area import CodeArea


def source_of(area: CodeArea) -> Source:
    """Return a tab's text under its file's name."""
    return Source(area.text, area.buffer.name, area.buffer.path)


class RunActions(Controller):
    """Part `run` of the command table."""

    _copied = ""
    """What Ctrl+C copied last during a run: pressed again, it pauses."""
    _is_trace_asked = False
    """Whether F12 was pressed and has not been carried out yet; a start ends what waits, but not that."""

    def start(self, argument: str = "") -> None:
        """`zz`: accept the front tab and run it; a run that goes on is ended first."""
        del argument
        app = self.app
        if not self._front_is_program():
            return
        app.show_run()
        app.file_actions.save_and_reload.notice_changes()
        source = self._accept_front()
        app.listener.front = source
        self.end_now()
        app.frame_pacing.hold()

        def run() -> None:
            self._trace_if_asked()
            app.send_breakpoints()  # not before: the program that just ends has others
            self._watched(source.file_name, lambda: app.session.erun(source))

        app.engine.submit(run)

    def accept(self, argument: str = "") -> None:
        """OK: the front tab becomes the active program."""
        del argument
        app = self.app
        if not self._front_is_program():
            return
        app.file_actions.save_and_reload.notice_changes()
        source = self._accept_front()
        name = app.editor.front.buffer.name

        def accept() -> None:
            app.send_breakpoints()
            problems = app.session.accept(source)
            if not problems:
                app.on_screen(app.notify, f"{name} is the active program.", timeout=2, markup=False)

        app.engine.submit(accept)

    def _front_is_program(self) -> bool:
        """Whether the front tab can be run; the user is told if not."""
        name = self.app.editor.front.buffer.name
        if self.app.editor.front.buffer.is_program:
            return True
        again = "; Shift+F5 runs the active program" if self.app.editor.active is not None else ""
        self.app.report_error(
            f"{visible_line(name)} is no program by its ending: nothing was run{again}", code=None
        )
        return False

    def _accept_front(self) -> Source:
        editor = self.app.editor
        editor.accept(editor.front)
        return source_of(editor.front)

    def again(self, argument: str = "") -> None:
        """`run`: the active program from the top."""
        del argument
        app = self.app
        if app.editor.active is None:
            self.start()
            return
        self.end_now()
        app.frame_pacing.hold()
        name = app.editor.active.buffer.name

        def run() -> None:
            self._trace_if_asked()
            self._watched(Path(name).name, app.session.run)

        app.engine.submit(run)

    def _watched(self, name: str, run: Callable[[], object]) -> None:
        """Run a program; where it fails before it has a graph, or a run, graph pane and status bar say so."""
        app = self.app
        bar = app.main_screen.status_bar
        graph, run_before = app.session.graph, app.session.status.record
        app.on_screen(setattr, bar, "failed", "")
        try:
            run()
        except DesireError:
            if app.session.graph is graph:
                app.on_screen(app.graph.show_failed, name)
            if app.session.status.record is run_before:
                app.on_screen(setattr, bar, "failed", f"{visible_line(name)} did not run")
            raise

    def proceed(self, argument: str = "") -> None:
        """`go`; a paused run is resumed."""
        del argument
        if self.app.session.status.state is State.PAUSED:
            self.resume()
            return
        self.app.engine.submit(self.app.session.go)

    def pause(self, argument: str = "") -> None:
        """Ctrl-C: pause what goes on, resume what is paused; what is selected is copied first.

        With an argument, nothing is copied.
        """
        app = self.app
        state = app.session.status.state
        if app.command.is_asking:
            app.command.stop_asking()
            app.listener.answer(None)
        elif state is State.PAUSED:
            self.resume()
        elif app.engine.is_busy:
            if not argument and (text := app.view_actions.selected_text) and text != self._copied:
                self._copied = text
                app.view_actions.copy(text)
                app.notify("The run goes on: Ctrl+C again pauses it.", timeout=3)
                return
            self._copied = ""
            app.session.pause()
            app.command.prompt.focus()
            app.show_status()
        else:
            app.view_actions.copy_selection()

    def resume(self) -> None:
        """Go on after a pause."""
        self.app.session.resume()
        self.app.show_status()

    def end(self, argument: str = "") -> None:
        """End what goes on or is paused."""
        del argument
        if self.app.engine.is_busy:
            self.end_now()
            self.app.show_status()
        elif self.app.analyses.is_going:
            self.app.analyses.stop()
        else:
            self.app.notify("Nothing is running.", timeout=2)

    def end_now(self) -> None:
        """End what goes on, if anything does, and forget what waits."""
        app = self.app
        if app.engine.is_busy:
            app.engine.forget_waiting()
            app.command_line.forget()
            app.session.end()
        if app.command.is_asking:
            app.command.stop_asking()
            app.listener.answer(None)

    def report(self, argument: str = "") -> None:
        """`dump run`, at any time: also of the run that goes on."""
        del argument
        from desire_tui.engine.session.report import run_report

        runs = self.app.session.runs
        if runs:
            self.app.command.console.add(run_report(runs[-1]).rstrip("\n"), "output")
        else:
            self.app.notify("No run yet: press F5.", timeout=2)

    # ------------------------------------------------------------------------------ stops

    def trace(self, argument: str = "") -> None:
        """Single-step: the script of the front tab stops before its next statement."""
        del argument
        app = self.app
        self._is_trace_asked = True
        app.engine.submit(self._trace_if_asked)
        app.notify(
            "Trace: the script stops before each statement. F10 the next · Shift+F10 ends it.", timeout=4
        )

    def _trace_if_asked(self) -> None:
        """Switch tracing, on the engine's thread, unless that was done."""
        if self._is_trace_asked:
            self.app.session.execute("trace")
            self._is_trace_asked = False

    def breakpoint(self, argument: str = "") -> None:
        """Set or remove a breakpoint on the cursor's row, or on the numbered one."""
        area = self.app.editor.front
        if not area.buffer.is_program:
            return
        row = int(argument) - 1 if argument.isdecimal() else area.cursor_location[0]
        setting = row not in area.marks.breakpoints
        if setting and not self._can_stop(area, row):
            sentence = f"No statement of the script begins in line {row + 1}: it cannot stop there."
            self.app.notify(sentence, severity="warning", timeout=4)
            return
        area.marks.breakpoints = area.marks.breakpoints ^ {row}
        area.marks_changed()
        self.app.send_breakpoints()

    def _can_stop(self, area: CodeArea, row: int) -> bool:
        app = self.app
        if not app.engine.is_ready or len(area.text) > CHECKED_MAX:
            return True
        return row + 1 in app.session.script_lines(source_of(area))

    def clear_breakpoints(self, argument: str = "") -> None:
        """Remove all breakpoints."""
        del argument
        for area in self.app.editor.areas:
            area.marks.breakpoints = set()
            area.marks_changed()
        self.app.send_breakpoints()

    # --------------------------------------------------------------------------------------------- live mode

    async def live(self, argument: str = "") -> None:
        """Give a parameter a slider: the named one, or those chosen from a list."""
        await self.app.live_mode.choose(argument)

    def live_overlay(self, argument: str = "") -> None:
        """Turn overlaying of live runs on or off."""
        del argument
        on = self.app.graph.sliders.toggle_overlay()
        self.app.notify(f"Live runs {'overlay' if on else 'replace'} their curves.", timeout=2)

    def live_write(self, argument: str = "") -> None:
        """Write the values of the sliders into the program."""
        del argument
        self.app.live_mode.write()
