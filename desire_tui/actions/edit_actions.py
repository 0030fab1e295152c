"""Working on the text in front."""

from __future__ import annotations

from desire_tui.actions import Controller
from desire_tui.common.dialogs import LineDialog
from desire_tui.editor.code_area import CodeArea
from desire_tui.editor.find_bar import FindBar
from desire_tui.panes.prompt import Prompt


class EditActions(Controller):
    """Part `edit` of the command table."""

    def _open_bar(self, wanted: str, *, replace: bool) -> None:
        area = self.app.editor.front
        selected = area.selected_text
        if not wanted and selected and "\n" not in selected and not self._bar.finder.has_selected(area):
            wanted = selected
        self._bar.open(area, wanted, replace=replace)

    def find(self, argument: str = "") -> None:
        """Open the find bar."""
        self._open_bar(argument, replace=False)

    def replace(self, argument: str = "") -> None:
        """Open the find bar with a field to replace by; in the command line, search the history."""
        prompt = self.app.command.prompt
        if prompt.has_focus:
            prompt.search()
            return
        self._open_bar(argument, replace=True)

    @property
    def _bar(self) -> FindBar:
        return self.app.editor.query_one(FindBar)

    def _step(self, step: int) -> None:
        bar = self._bar
        bar.follow(self.app.editor.front)
        bar.action_step(step)

    def find_next(self, argument: str = "") -> None:
        """Go to the next occurrence."""
        del argument
        self._step(1)

    def find_previous(self, argument: str = "") -> None:
        """Go to the occurrence before."""
        del argument
        self._step(-1)

    def _switch(self, name: str) -> None:
        if not self._bar.display:
            self._open_bar("", replace=False)
        self._bar.switch(name)

    def match_case(self, argument: str = "") -> None:
        """Distinguish capitals from small letters in a search, or not."""
        del argument
        self._switch("case")

    def whole_words(self, argument: str = "") -> None:
        """Find whole names and numbers only, or not."""
        del argument
        self._switch("word")

    def expression(self, argument: str = "") -> None:
        """Take what is searched for as a regular expression, or as it stands."""
        del argument
        self._switch("regex")

    def in_selection(self, argument: str = "") -> None:
        """Search inside the selection only, or everywhere."""
        del argument
        self._switch("within")

    def replace_all(self, argument: str = "") -> None:
        """Replace every occurrence; opens the bar if it is not there."""
        del argument
        if self._bar.display and self._bar.has_class("-replace"):
            self._bar.replace_all()
        else:
            self._open_bar("", replace=True)

    async def goto(self, argument: str = "") -> None:
        """Go to a row, or `row:column`."""
        area = self.app.editor.front
        count = area.document.line_count
        text = argument or await self.app.push_screen_wait(
            LineDialog("Go to line", hint=f"1 … {count}, or line:column")
        )
        if not text:
            return
        row, _, column = text.partition(":")
        if not row.strip().isdecimal():
            self.app.notify(f"'{text}' is no line number.", severity="error", markup=False)
            return
        area.go_to(int(row) - 1, int(column) - 1 if column.strip().isdecimal() else 0)
        self.app.move_focus(area)

    def comment(self, argument: str = "") -> None:
        """Turn the selected rows into comments, or back."""
        del argument
        self.app.editor.front.toggle_comment()

    def complete(self, argument: str = "") -> None:
        """Open the list of completions."""
        del argument
        focused = self.app.focused
        if isinstance(focused, CodeArea | Prompt):
            self.app.completer.offer(focused)

    def _go_to_problem(self, step: int) -> None:
        area = self.app.editor.front
        mark = area.marks.next_problem(area.cursor_location[0], step)
        if mark is None:
            self.app.notify("No problems in this program.", timeout=2)
            return
        self.app.move_focus(area)
        area.go_to(mark.row, mark.start)

    def next_problem(self, argument: str = "") -> None:
        """Go to the next problem."""
        del argument
        self._go_to_problem(1)

    def previous_problem(self, argument: str = "") -> None:
        """Go to the problem before."""
        del argument
        self._go_to_problem(-1)

    def fix(self, argument: str = "") -> None:
        """Replace the word at the problem under the cursor, or on its row, by the one that was meant."""
        del argument
        app, area = self.app, self.app.editor.front
        row, column = area.cursor_location
        marks = [mark for mark in area.marks.problems.get(row, ()) if mark.fix is not None]
        here = (mark for mark in marks if mark.start <= column <= mark.end)
        mark = next(here, marks[0] if marks else None)
        if mark is None or mark.fix is None:
            app.notify("No suggestion for this line. F8 goes to the next problem.", timeout=3)
            return
        start, old, new = mark.fix
        if area.document.get_line(row)[start : start + len(old)] != old:
            return  # edited, and not checked again yet
        area.replace_as_one(new, (row, start), (row, start + len(old)))
        app.notify(f"{mark.fix.text} · Ctrl+Z takes it back", timeout=3, markup=False)

    def fold(self, argument: str = "") -> None:
        """Fold what the program must show, or open it."""
        del argument
        area = self.app.editor.front
        if area.fold is not None:
            area.set_fold(None)
        elif not area.fold_expectations():
            self.app.notify("No lines with --? or --| at the end of this program.", timeout=3)

    def duplicate(self, argument: str = "") -> None:
        """Repeat the cursor's row."""
        del argument
        self.app.editor.front.duplicate_line()

    def move_up(self, argument: str = "") -> None:
        """Move the selected rows up."""
        del argument
        self.app.editor.front.move_line(-1)

    def move_down(self, argument: str = "") -> None:
        """Move the selected rows down."""
        del argument
        self.app.editor.front.move_line(1)

    def indent(self, argument: str = "") -> None:
        """Indent the selected rows."""
        del argument
        self.app.editor.front.shift_lines(1)

    def dedent(self, argument: str = "") -> None:
        """Dedent the selected rows."""
        del argument
        self.app.editor.front.shift_lines(-1)

    def cut(self, argument: str = "") -> None:
        """Cut the selection or the row."""
        del argument
        self.app.editor.front.action_cut()

    def copy(self, argument: str = "") -> None:
        """Copy the selection or the row, whether or not a run goes on."""
        del argument
        view = self.app.view_actions
        area = self.app.editor.front
        view.copy(view.selected_text or area.document.get_line(area.cursor_location[0]))

    def paste(self, argument: str = "") -> None:
        """Insert what was cut or copied here; what others copied comes by the terminal's own key."""
        del argument
        if self.app.clipboard:
            self.app.editor.front.action_paste()
        else:
            sentence = (
                "Nothing was copied here. The terminal's own key (mostly Ctrl+Shift+V) pastes the rest."
            )
            self.app.notify(sentence, timeout=4)

    def undo(self, argument: str = "") -> None:
        """Undo."""
        del argument
        self.app.editor.front.action_undo()

    def redo(self, argument: str = "") -> None:
        """Redo."""
        del argument
        self.app.editor.front.action_redo()

    def select_all(self, argument: str = "") -> None:
        """Select the whole text; in a field, go to its start as usual there."""
        del argument
        self.app.editor.front.select_all()
