"""What the desktop does about each message from the engine's thread."""

from __future__ import annotations

from functools import singledispatchmethod
from typing import TYPE_CHECKING

from desire_tui.actions import Controller
from desire_tui.commands import BY_ID, BY_WORD
from desire_tui.common.dialogs import Choice
from desire_tui.common.key_names import key_names
from desire_tui.desktop import engine_messages
from desire_tui.desktop.engine_thread import STOPPED_BY_USER
from desire_tui.engine.data_classes import replace
from desire_tui.language.problem_marks import mark_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.editor.code_area import CodeArea
    from desire_tui.engine.diagnostics import Diagnostic

FIRST_SAMPLE_S = 0.003
"""A run's first sample mostly comes sooner: it is drawn together with the graph's frame."""


def numbers(problems: Sequence[Diagnostic]) -> str:
    """Return how many errors and how many warnings these are: `2 errors, 1 warning`."""
    counts = [(sum(p.severity == kind for p in problems), kind) for kind in ("error", "warning")]
    return ", ".join(f"{count} {kind}{'s' if count > 1 else ''}" for count, kind in counts if count)


class MessageHandlers(Controller):
    """`handle(message)`; all of it happens on the screen's thread."""

    @singledispatchmethod
    def handle(self, message: engine_messages.EngineMessage) -> None:
        """Carry out what a message asks for."""
        raise NotImplementedError(type(message).__name__)

    @handle.register
    def _up(self, message: engine_messages.EngineReady) -> None:
        del message
        self.app.engine_ready()

    @handle.register
    def _missing(self, message: engine_messages.EngineMissing) -> None:
        self.app.end_badly(message.error)

    @handle.register
    def _text(self, message: engine_messages.ConsoleText) -> None:
        del message
        self.app.command.console.write(self.app.listener.take_text())

    @handle.register
    def _input(self, message: engine_messages.InputRequested) -> None:
        self.flush()
        pasted = self.app.command_line.answer()
        if pasted is not None:  # it came with the line that started the program
            self.app.command.console.add(message.prompt + pasted, "output")
            self.app.listener.answer(pasted)
            return
        self.app.move_focus(self.app.command.prompt)
        self.app.command.ask(message.prompt)

    @handle.register
    def _permission(self, message: engine_messages.PermissionRequested) -> None:
        def answered(choice: str | None) -> None:
            message.answer.give(choice == "Allow")

        sentence = f"The program wants to {message.request.sentence}"
        self.app.push_screen(
            Choice("Permission", sentence, ("Allow", "Refuse"), unasked=True, safe="Refuse"), answered
        )

    @handle.register
    def _accepted(self, message: engine_messages.ProgramAccepted) -> None:
        area = self.app.editor.active
        if area is not None:
            self.app.editor.set_problems(area, message.problems)
            self.app.list_problems()
        if message.problems:
            command = BY_ID["edit.next_problem"]
            keys = key_names(self.app.settings.keys.get(command.id, command.keys))
            self.app.command.console.add(f"{numbers(message.problems)}: {keys} goes from one to the next")

    @handle.register
    def _run_started(self, message: engine_messages.RunStarted) -> None:
        app = self.app
        app.graph.follow_newest(app.session.graph)
        app.show_status()
        if message.record.count:
            app.frame_pacing.at_once()
        else:
            app.main_screen.set_timer(FIRST_SAMPLE_S, app.frame_pacing.at_once)

    @handle.register
    def _run_ended(self, message: engine_messages.RunEnded) -> None:
        record = message.record
        if record.ended in ("term", "stopped") and record.message:
            self.flush()
            self.app.command.console.add(record.message, "notice")
        self.app.tour.run_ended()

    @handle.register
    def _problems(self, message: engine_messages.ProblemsFound) -> None:
        if not message.stops:
            self.flush()
            self.app.command.problems(message.diagnostics)
            return
        own_wish = [d for d in message.diagnostics if d.code == STOPPED_BY_USER]
        if own_wish and len(own_wish) == len(message.diagnostics):
            self.flush()
            self.app.command.console.add("ended", "notice")
            return
        self.show(message.diagnostics)

    def show(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Print problems, mark them in the editor, and go to the first one that has a place there."""
        self.flush()
        app = self.app
        app.command.problems(diagnostics)
        went = False
        for diagnostic in diagnostics:
            area = self._area_of(diagnostic)
            mark = mark_of(diagnostic)
            if area is None or mark is None:
                continue
            if area is app.editor.active:  # edited meanwhile, perhaps
                mark = replace(mark, row=_row_now(area, mark.row))
            marks = area.marks.problems.setdefault(mark.row, [])
            if mark not in marks:
                marks.insert(0, mark)
            area.marks_changed()
            if not went:
                app.editor.show(area)
                area.go_to(mark.row, mark.start)
                went = True
        app.list_problems()

    def _area_of(self, diagnostic: Diagnostic) -> CodeArea | None:
        source, editor = diagnostic.source, self.app.editor
        if source is None or source.name == "<command>":
            return None
        candidates = [editor.active, editor.front, *editor.areas]
        return next(
            (area for area in candidates if area is not None and area.buffer.name == source.name), None
        )

    @handle.register
    def _checked(self, message: engine_messages.CheckFinished) -> None:
        area = self.app.editor.find(message.number)
        if area is not None and self.app.editor.versions.get(message.number, 0) == message.version:
            self.app.editor.set_problems(area, message.diagnostics)
            self.app.list_problems()

    @handle.register
    def _stopped(self, message: engine_messages.Stopped) -> None:
        self.flush()
        place = message.place
        row = place.source.position(place.placed.at).row - 1
        app = self.app
        area = app.editor.active
        if area is not None:
            area.marks.traced = _row_now(area, row)
            area.marks_changed()
            view = app.editor.front if app.editor.front.tab is area else area
            app.editor.show(view)
            view.go_to(area.marks.traced)
        line = place.source.line(row + 1).strip()
        app.command.console.add(
            f"{'next' if place.tracing else 'stopped'} at line {row + 1}: {line}", "notice"
        )
        app.quantities.show(app.session.values)

    @handle.register
    def _line(self, message: engine_messages.LineWanted) -> None:
        """Show a line where the program is on the screen; the focus stays where it is."""
        editor = self.app.editor
        if editor.active is not None and editor.front.tab is editor.active:
            editor.front.go_to(_row_now(editor.active, message.row - 1))

    @handle.register
    def _graph(self, message: engine_messages.GraphChanged) -> None:
        del message
        self.app.graph.follow_newest(self.app.session.graph)

    @handle.register
    def _cleared(self, message: engine_messages.QuantitiesCleared) -> None:
        del message
        area = self.app.editor.active
        if area is not None and area.marks.traced is not None:
            area.marks.traced = None
            area.marks_changed()

    @handle.register
    def _noted(self, message: engine_messages.NoteWritten) -> None:
        self.flush()
        self.app.command.console.add(message.text, "output")

    @handle.register
    def _command(self, message: engine_messages.AppCommand) -> None:
        self.flush()
        self.app.do(BY_WORD[message.word].id, message.argument)

    @handle.register
    def _idle(self, message: engine_messages.EngineIdle) -> None:
        self.flush()
        if message.failed:
            self.app.command_line.failed()
        app = self.app
        app.main_screen.release()
        if (
            app.session.stopped_at is None
            and app.editor.active is not None
            and app.editor.active.marks.traced is not None
        ):
            app.editor.active.marks.traced = None
            app.editor.active.marks_changed()
        app.show_status()
        app.quantities.show(app.session.values)
        app.tour.program_ended()
        app.live_mode.engine_idle()
        app.command_line.next()

    @handle.register
    def _fault(self, message: engine_messages.EngineFault) -> None:
        self.flush()
        self.app.checkpoint()
        self.app.log_fault(message.summary, message.details)

    def flush(self) -> None:
        """Show output that waits, so that what comes next stands below it."""
        self.app.command.console.write(self.app.listener.take_text())


def _row_now(area: CodeArea, row: int) -> int:
    """Return where a row of the accepted text is now; the nearest there is if it was deleted."""
    now = area.marks.row_now(row)
    return now if now is not None else min(row, area.document.line_count - 1)
