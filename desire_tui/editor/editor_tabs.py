"""The tabs of the editor pane: opened, closed, moved, chosen; and when their texts are to be checked."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual import on
from textual.containers import Horizontal
from textual.message import Message

from desire_tui.editor.buffer import Buffer, free_label
from desire_tui.editor.code_area import CodeArea
from desire_tui.editor.editor_views import EditorViews
from desire_tui.editor.line_ends import kind
from desire_tui.editor.tab_strip import NEW, TabStrip

if TYPE_CHECKING:
    from textual.timer import Timer

    from desire_tui.common.completion_hook import CompletionHook

CHECK_AFTER_S = 0.25
"""A text is checked when nobody typed for so long."""


class EditorTabs(EditorViews):
    """Any number of programs."""

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
        super().__init__(completion)
        self._checks_due: dict[int, Timer] = {}
        """By the tab's number: an edit in one tab does not put off the check of another."""

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
