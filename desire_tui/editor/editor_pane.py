"""The editor pane: tabs, one or two texts, the find bar, and a row that says what is wrong at the cursor."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.binding import Binding
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import TextArea

from desire_tui.editor.buffer import Buffer, free_label
from desire_tui.editor.code_area import CodeArea
from desire_tui.editor.find_bar import FindBar
from desire_tui.editor.line_ends import kind
from desire_tui.editor.status_row import StatusRow
from desire_tui.editor.tab_strip import NEW, TabLabel, TabStrip

if TYPE_CHECKING:
    from collections.abc import Iterable

    from textual.app import ComposeResult
    from textual.binding import BindingType
    from textual.timer import Timer

    from desire_tui.common.completion_hook import CompletionHook
    from desire_tui.engine.diagnostics import Diagnostic

CHECK_AFTER_S = 0.25
"""A text is checked when nobody typed for so long."""


class EditorPane(Vertical):
    """Any number of programs, one of them in front, perhaps another beside it."""

    DEFAULT_CSS = """
    EditorPane #editor-body, EditorPane #areas { height: 1fr; }
    EditorPane #areas.-split CodeArea { border-right: solid $panel; }
    """

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "close_find", "Close find bar", show=False)]

    class ActionRequested(Message):
        """The pane wants an action carried out (`id` of the command table)."""

        def __init__(self, command_id: str, argument: str = "") -> None:
            super().__init__()
            self.command_id = command_id
            self.argument = argument

    class CheckRequested(Message):
        """A text came to rest and should be checked."""

        def __init__(self, area: CodeArea) -> None:
            super().__init__()
            self.area = area

    def __init__(self, completion: CompletionHook) -> None:
        super().__init__(id="editor")
        self._completion = completion
        self._status_row = StatusRow()
        self.areas: list[CodeArea] = []
        """One for each tab."""
        self._front: CodeArea | None = None
        self._second: CodeArea | None = None
        """What is shown beside the front: another tab, or the twin."""
        self._twin: CodeArea | None = None
        """A second view of one of the tabs."""
        self._active: CodeArea | None = None
        self.versions: dict[int, int] = {}
        self._checks_due: dict[int, Timer] = {}
        """By the tab's number: an edit in one tab does not put off the check of another."""

    def compose(self) -> ComposeResult:
        """Tabs above, texts, find bar and message row below."""
        yield TabStrip()
        with Vertical(id="editor-body"):
            yield Horizontal(id="areas")
            yield FindBar()
            yield self._status_row

    # ------------------------------------------------------------------------------------------------- tabs

    @property
    def front(self) -> CodeArea:
        """The text the user works on, perhaps in its second view (`front.tab` is the tab's own)."""
        assert self._front is not None
        return self._front

    @property
    def active(self) -> CodeArea | None:
        """The tab that holds the active program."""
        return self._active

    @active.setter
    def active(self, area: CodeArea | None) -> None:
        self._active = area.tab if area is not None else None

    def accept(self, area: CodeArea) -> None:
        """Note that a tab's text, as it is now, becomes the active program."""
        self.active = area
        area.marks.accepted()
        if area.marks.traced is not None:
            area.marks.traced = None
            area.marks_changed()
        self.refresh_tabs()

    async def add(self, buffer: Buffer, text: str | None = None, *, front: bool = True) -> CodeArea:
        """Open a tab; an untouched empty one is replaced."""
        if buffer.path is None:
            buffer.label = free_label(buffer.label, {area.buffer.name for area in self.areas})
        area = CodeArea(buffer, buffer.ended_text if text is None else text, self._completion)
        buffer.line_ends = kind(area.document.ends)
        area.fold_expectations()
        blank = self._front
        if blank is not None and (blank.text or blank.buffer.path is not None):
            blank = None
        self.areas.append(area)
        await self.query_one("#areas", Horizontal).mount(area)
        if front or self._front is None:
            self.show(area)
        else:
            area.display = False
            self.refresh_tabs()
        if blank is not None and text is None and blank is not self.active and buffer.path:
            await self.close_tab(blank)
        self._ask_check(area)
        return area

    def show(self, area: CodeArea, *, focus: bool = False) -> None:
        """Bring a tab, or the second view of one, to the front."""
        if area is self._second:
            self._second = self._front
        self._front = area
        self.query_one(FindBar).follow(area)
        views = self._views
        if self._second is area or self._second not in views:
            self._second = None
        for other in views:
            other.display = other in (area, self._second)
        self.query_one("#areas").set_class(self._second is not None, "-split")
        if focus:
            self.screen.set_focus(area)  # at once: letters typed next belong there
        self.refresh_tabs()
        self._status_row.show(self.front)

    @property
    def _views(self) -> list[CodeArea]:
        return [*self.areas, self._twin] if self._twin is not None else self.areas

    async def close_tab(self, area: CodeArea) -> None:
        """Close a tab without asking; the last one leaves an empty one."""
        area = area.tab
        had_focus = self.front.has_focus
        if self._twin is not None and self._twin.tab is area:
            await self._drop_twin()
        at = self.areas.index(area)
        self.areas.remove(area)
        due = self._checks_due.pop(area.buffer.number, None)
        if due is not None:
            due.stop()
        if area is self._second:
            self._second = None
        if area is self.active:
            self.active = None
        if not self.areas:
            self._front = None
            await self.add(Buffer())
        elif area is self._front:
            self.show(self.areas[min(at, len(self.areas) - 1)], focus=had_focus)
        await area.remove()
        self.show(self.front, focus=had_focus)

    def step(self, by: int) -> None:
        """Show the next tab or the one before."""
        at = self.areas.index(self.front.tab)
        self.show(self.areas[(at + by) % len(self.areas)], focus=True)

    def move_tab(self, area: CodeArea, to: int) -> None:
        """Give a tab another place in the row."""
        area, to = area.tab, min(max(to, 0), len(self.areas) - 1)
        at = self.areas.index(area)
        if at == to:
            return
        holder, neighbour = self.query_one("#areas", Horizontal), self.areas[to]
        if to > at:
            holder.move_child(area, after=neighbour)
        else:
            holder.move_child(area, before=neighbour)
        self.areas.insert(to, self.areas.pop(at))
        if self._twin is not None:
            holder.move_child(self._twin, after=self._twin.tab)
        self.refresh_tabs()

    # ------------------------------------------------------------------------------------------- side by side

    async def split(self) -> None:
        """Show two tabs side by side (a single one twice), or one again."""
        if self._second is not None:
            await self._one_view()
        elif len(self.areas) > 1:
            at = self.areas.index(self.front.tab)
            self._second = self.areas[(at + 1) % len(self.areas)]
            self.show(self.front, focus=True)
        else:
            await self.show_twice()

    async def show_twice(self) -> None:
        """Show the front tab a second time beside itself, or once again."""
        tab = self.front.tab
        if self._twin is not None and self._twin.tab is tab and self._second is not None:
            await self._one_view()
            return
        await self._drop_twin()
        self._twin = twin = CodeArea(tab.buffer, "", self._completion, twin=tab)
        await self.query_one("#areas", Horizontal).mount(twin, after=tab)
        twin.go_to(*tab.cursor_location)
        self._second = twin
        self.show(tab, focus=True)

    async def _one_view(self) -> None:
        place, front = self.front.cursor_location, self.front.tab
        if self.front is not front:
            front.go_to(*place)
        self._second = None
        await self._drop_twin()
        self.show(front, focus=True)

    async def _drop_twin(self) -> None:
        twin, self._twin = self._twin, None
        if twin is None:
            return
        if self._front is twin:
            self._front = twin.tab
        if self._second is twin or self._second is self._front:
            self._second = None
        twin.part()
        await twin.remove()

    def find(self, number: int) -> CodeArea | None:
        """Return the tab with that buffer number."""
        return next((area for area in self.areas if area.buffer.number == number), None)

    def follow_theme(self) -> None:
        """Take over the colours of the app's current theme."""
        for area in self._views:
            area.follow_theme()

    def refresh_tabs(self) -> None:
        """Draw names and marks again."""
        strip = self.query_one(TabStrip)
        strip.front = self.front.buffer.number
        strip.second = self._second.buffer.number if self._second else None
        strip.tabs = tuple(
            TabLabel(a.buffer.number, a.buffer.name, a.is_dirty, a is self.active) for a in self.areas
        )

    @property
    def has_unsaved_work(self) -> bool:
        """Whether a tab is marked so."""
        return any(tab.dirty for tab in self.query_one(TabStrip).tabs)

    @on(TabStrip.Chosen)
    async def _tab_chosen(self, event: TabStrip.Chosen) -> None:
        event.stop()
        area = self.find(event.key)
        if event.key == NEW:
            self.post_message(self.ActionRequested("file.new"))
        elif area is not None:
            self.show(self.front if area is self.front.tab else area, focus=True)
            if event.close:
                self.post_message(self.ActionRequested("file.close"))

    @on(TabStrip.Dragged)
    def _tab_dragged(self, event: TabStrip.Dragged) -> None:
        event.stop()
        area, over = self.find(event.key), self.find(event.over)
        if area is not None and over is not None:
            self.move_tab(area, self.areas.index(over))

    # --------------------------------------------------------------------------------------------- problems

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

    def _ask_check(self, area: CodeArea) -> None:
        if not area.buffer.is_program:
            return
        number = area.buffer.number
        due = self._checks_due.pop(number, None)
        if due is not None:
            due.stop()

        def ask() -> None:
            self._checks_due.pop(number, None)
            self.post_message(self.CheckRequested(area))

        self._checks_due[number] = self.set_timer(CHECK_AFTER_S, ask)

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
