"""The editor pane: tabs, one or two texts, the find bar, and a row that says what is wrong at the cursor."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.binding import Binding
from textual.widgets import TextArea

from desire_tui.editor.code_area import CodeArea
from desire_tui.editor.editor_tabs import EditorTabs
from desire_tui.editor.find_bar import FindBar
from desire_tui.editor.status_row import StatusRow

if TYPE_CHECKING:
    from collections.abc import Iterable

    from textual.binding import BindingType

    from desire_tui.common.completion_hook import CompletionHook
    from desire_tui.engine.diagnostics import Diagnostic


class EditorPane(EditorTabs):
    """Follows what happens in its texts."""

    DEFAULT_CSS = """
    EditorPane #editor-body, EditorPane #areas { height: 1fr; }
    EditorPane #areas.-split CodeArea { border-right: solid $panel; }
    """

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "close_find", "Close find bar", show=False)]

    def __init__(self, completion: CompletionHook) -> None:
        super().__init__(completion)
        self.versions: dict[int, int] = {}

    def set_problems(self, area: CodeArea, diagnostics: Iterable[Diagnostic]) -> None:
        """Show a text's problems in it; nothing is drawn again if they are those it shows."""
        before = area.marks.problems
        area.marks.set_problems(diagnostics)
        if area.marks.problems != before:
            area.marks_changed()
        elif self._status_row.rows == 1:
            return
        self._status_row.show(self.front, checked=True)

    @on(TextArea.Changed)
    def _changed(self, event: TextArea.Changed) -> None:
        event.stop()
        area = event.text_area
        assert isinstance(area, CodeArea)
        self.versions[area.buffer.number] = self.versions.get(area.buffer.number, 0) + 1
        self.refresh_tabs()
        area.completion.text_changed(area)
        self._ask_check(area)
        self.query_one(FindBar).text_changed()

    def kind_changed(self, area: CodeArea) -> None:
        """Colour and check a text by its name, which is perhaps no longer that of a program."""
        area.marks.is_program = area.buffer.is_program
        if not area.buffer.is_program:
            area.marks.set_problems(())
        area.marks_changed()
        self.refresh_tabs()
        self._status_row.show(self.front)
        self._ask_check(area.tab)

    @on(TextArea.SelectionChanged)
    def _moved(self, event: TextArea.SelectionChanged) -> None:
        event.stop()
        area = event.text_area
        assert isinstance(area, CodeArea)
        area.completion.text_changed(area)
        self._status_row.show(self.front)

    @on(StatusRow.Accepted)
    def _accepted(self, event: StatusRow.Accepted) -> None:
        event.stop()
        self.post_message(self.ActionRequested("run.accept"))

    @on(CodeArea.GutterClicked)
    def _gutter_clicked(self, event: CodeArea.GutterClicked) -> None:
        event.stop()
        self.show(event.area, focus=True)
        self.post_message(self.ActionRequested("run.breakpoint", str(event.row + 1)))

    def on_descendant_focus(self) -> None:
        """Bring the text that got the focus to the front."""
        focused = self.screen.focused
        if isinstance(focused, CodeArea) and focused is not self._front and focused in self._views:
            self.show(focused)

    def action_close_find(self) -> None:
        """Hide the find bar."""
        bar = self.query_one(FindBar)
        if bar.display:
            bar.action_close()

    @on(FindBar.Closed)
    def _find_closed(self, event: FindBar.Closed) -> None:
        event.stop()
        self.front.focus()
