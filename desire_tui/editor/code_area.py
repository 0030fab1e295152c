"""The text of one tab, or a second view of it: what keys and commands do to a program."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.binding import Binding, BindingType
from textual.message import Message
from textual.widgets.text_area import Selection

from desire_tui.editor import indent, line_ends
from desire_tui.editor.line_ends import EndedText
from desire_tui.editor.program_view import ProgramView
from desire_tui.language.line_tokens import joined_word_at

if TYPE_CHECKING:
    from textual import events
    from textual.document._document import Location

    from desire_tui.common.completion_hook import CompletionHook
    from desire_tui.editor.buffer import Buffer


class CodeArea(ProgramView):
    """Edits one program."""

    DEFAULT_CSS = """
    CodeArea { border: none; padding: 0; height: 1fr; width: 1fr; scrollbar-size-vertical: 1;
               scrollbar-size-horizontal: 0; }
    CodeArea:focus { border: none; }
    CodeArea .text-area--gutter { color: $foreground 70%; }
    CodeArea .text-area--cursor-gutter { color: $foreground; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+home", "to_end(-1)", "Top of the text", show=False),
        Binding("ctrl+end", "to_end(1)", "End of the text", show=False),
        Binding("ctrl+shift+home", "to_end(-1, True)", "Select to the top", show=False),
        Binding("ctrl+shift+end", "to_end(1, True)", "Select to the end", show=False),
    ]

    class GutterClicked(Message):
        """The mouse was pressed beside a row."""

        def __init__(self, area: CodeArea, row: int) -> None:
            super().__init__()
            self.area = area
            self.row = row

    def __init__(
        self, buffer: Buffer, text: str, completion: CompletionHook, twin: CodeArea | None = None
    ) -> None:
        self.buffer = buffer
        self.completion = completion
        super().__init__(text, twin)
        if not buffer.is_program:
            self.marks.is_program = False
            self._build_highlight_map()

    @property
    def tab(self) -> CodeArea:
        """The first view of this text, which stands for the tab."""
        first = self.views[0] if self.views else self
        assert isinstance(first, CodeArea)
        return first

    @property
    def is_dirty(self) -> bool:
        """Whether there is unsaved work."""
        return self.text != self.buffer.saved_text

    # ----------------------------------------------------------------------------------------------- typing

    async def _on_key(self, event: events.Key) -> None:
        if self.completion.handle_key(event, self):
            event.stop()
            event.prevent_default()
            return
        if event.key == "escape":
            event.prevent_default()  # TextArea would move the focus
            return
        if event.key == "enter":
            event.stop()
            event.prevent_default()
            self._new_line()
            return
        if event.key == "tab" and self.selection.start[0] != self.selection.end[0]:
            event.stop()
            event.prevent_default()
            self.shift_lines(1)
            return
        await super()._on_key(event)
        if event.is_printable:
            self.completion.letter_typed(self)

    async def _on_mouse_down(self, event: events.MouseDown) -> None:
        if event.x < self.gutter_width:
            event.stop()
            event.prevent_default()
            row = event.y + self.scroll_offset.y
            if row < self.document.line_count:
                self.post_message(self.GutterClicked(self, row))

    def on_blur(self) -> None:
        """Close the completions."""
        self.completion.focus_lost(self)

    def _new_line(self) -> None:
        row, column = min(self.selection)
        line = self.document.get_line(row)
        if not self.buffer.is_program:
            margin = line[: min(column, len(line) - len(line.lstrip()))]
            self._replace_via_keyboard("\n" + margin, *self.selection)
            return
        rows_above = self._coloured.before(row)
        at_end = self.selection.is_empty and column == len(line)
        if at_end and not rows_above and indent.closes(line):
            blanks = indent.closing_indent(self.document.lines, row)
            old = line[: len(line) - len(line.lstrip())]
            if blanks is not None and len(blanks) < len(old):
                self.replace(blanks, (row, 0), (row, len(old)), maintain_selection_offset=True)
                line = self.document.get_line(row)
                column = len(line)
                self.move_cursor((row, column))
        blanks = indent.indent_after(line[:column], rows_above) if column else ""
        self._replace_via_keyboard("\n" + blanks, *self.selection)

    def _selected_rows(self) -> tuple[int, int]:
        (top, _), (bottom, column) = sorted(self.selection)
        if bottom > top and column == 0:
            bottom -= 1
        return top, bottom

    def rewrite_rows(self, top: int, bottom: int, lines: list[str], ends: list[str] | None = None) -> None:
        """Replace whole rows as one undoable edit; the rows stay selected if there were several.

        `ends`: what ends the new rows in the file, if that is not what ends the old ones.
        """
        end = len(self.document.get_line(bottom))
        row, column = self.cursor_location
        old = self.document.lines[top : bottom + 1]
        if lines != old:  # else what can be redone is kept
            if ends is None:
                ends = self.document.ends[top : bottom + 1]
                if len(lines) != len(old):
                    ends = line_ends.following(old, ends, lines, self.document.usual_end)
            text = EndedText("\n".join(lines), ends)
            self.history.checkpoint()
            self.replace(text, (top, 0), (bottom, end), maintain_selection_offset=False)
            self.history.checkpoint()
        if top != bottom:
            self.selection = Selection((top, 0), (top + len(lines) - 1, len(lines[-1])))
        else:
            self.move_cursor((row, min(column, len(lines[0]))))

    def replace_as_one(self, text: str, start: Location, end: Location) -> None:
        """Replace a piece of the text as one undoable edit."""
        self.history.checkpoint()
        self.replace(text, start, end)
        self.history.checkpoint()

    def shift_lines(self, levels: int) -> None:
        """Indent or dedent the selected rows."""
        top, bottom = self._selected_rows()
        self.rewrite_rows(top, bottom, indent.shift(self.document.lines[top : bottom + 1], levels))

    def toggle_comment(self) -> None:
        """Turn the selected rows into comments, or back."""
        top, bottom = self._selected_rows()
        self.rewrite_rows(top, bottom, indent.toggle_comment(self.document.lines[top : bottom + 1]))

    def duplicate_line(self) -> None:
        """Repeat the cursor's row below it."""
        row, column = self.cursor_location
        self.insert("\n" + self.document.get_line(row), (row, len(self.document.get_line(row))))
        self.move_cursor((row + 1, column))

    def move_line(self, step: int) -> None:
        """Move the selected rows up or down by one."""
        top, bottom = self._selected_rows()
        if not 0 <= (top if step < 0 else bottom) + step < self.document.line_count:
            return
        lines = self.document.lines
        first, last = (top - 1, bottom) if step < 0 else (top, bottom + 1)
        moved, ends = lines[first : last + 1], self.document.ends[first : last + 1]
        if ends[-1]:  # the last line of all has no end to take along
            ends = _rotated(ends, step)
        self.rewrite_rows(first, last, _rotated(moved, step), ends)
        self.marks.rotated(first, last, step)
        self.marks_changed()
        self.selection = Selection(
            (top + step, 0), (bottom + step, len(self.document.get_line(bottom + step)))
        )

    def action_to_end(self, step: int, select: bool = False) -> None:
        """Move the cursor to the top (-1) or the end (1) of the text."""
        last = self.wrapped_document.height - 1
        end = (last, len(self.document.get_line(last)))
        self.move_cursor((0, 0) if step < 0 else end, select=select)

    def go_to(self, row: int, column: int = 0) -> None:
        """Put the cursor on a row (from 0), in the middle of the view."""
        row = min(max(row, 0), self.document.line_count - 1)
        self.move_cursor((row, min(column, len(self.document.get_line(row)))), center=True)

    def word_at_cursor(self) -> str:
        """Return the name or word the cursor is on or just behind, or an empty text."""
        row, column = self.cursor_location
        return joined_word_at(self.document.lines, row, column)


def _rotated(lines: list[str], step: int) -> list[str]:
    return [*lines[1:], lines[0]] if step < 0 else [lines[-1], *lines[:-1]]
