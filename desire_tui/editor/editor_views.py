"""The texts of the editor pane: one in front, perhaps another, or the same once more, beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.containers import Horizontal, Vertical

from desire_tui.editor.code_area import CodeArea
from desire_tui.editor.find_bar import FindBar
from desire_tui.editor.status_row import StatusRow
from desire_tui.editor.tab_strip import TabLabel, TabStrip

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from desire_tui.common.completion_hook import CompletionHook


class EditorViews(Vertical):
    """Which texts there are, and which of them are seen."""

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

    def compose(self) -> ComposeResult:
        """Tabs above, texts, find bar and message row below."""
        yield TabStrip()
        with Vertical(id="editor-body"):
            yield Horizontal(id="areas")
            yield FindBar()
            yield self._status_row

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

    def find(self, number: int) -> CodeArea | None:
        """Return the tab with that buffer number."""
        return next((area for area in self.areas if area.buffer.number == number), None)

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

    def step(self, by: int) -> None:
        """Show the next tab or the one before."""
        at = self.areas.index(self.front.tab)
        self.show(self.areas[(at + by) % len(self.areas)], focus=True)

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

    # ------------------------------------------------------------------------------------------------- looks

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
