"""The text of one tab: Textual's TextArea, with the language's own colours, problem marks and habits.

TextArea's internals are overridden in few places, each named here: `_build_highlight_map` (colours without
tree-sitter), `_set_document` (no wrapping tables), `edit` / `_undo_batch` / `_redo_batch` (marks move with
the text), `render_line` (gutter marks), `_refresh_size` (the width is not measured anew at each key).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.segment import Segment
from rich.style import Style
from textual.binding import Binding, BindingType
from textual.document._document import Document
from textual.document._document_navigator import DocumentNavigator
from textual.geometry import Size
from textual.strip import Strip
from textual.widgets import TextArea
from textual.widgets.text_area import Selection

from desire_tui.editor import indent
from desire_tui.editor.aid import TypingAid
from desire_tui.editor.highlighting import LineHighlights
from desire_tui.editor.marks import Marks
from desire_tui.editor.unwrapped import UnwrappedDocument

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual import events
    from textual.document._document import EditResult
    from textual.document._edit import Edit
    from textual.geometry import Region

    from desire_tui.editor.buffer import Buffer

GUTTER_SIGNS = {
    "error": ("✖", "#f4737b"),
    "warning": ("▲", "#e5c07b"),
    "break": ("●", "#f4737b"),
    "trace": ("▶", "#7fc97f"),
}


class CodeArea(TextArea):
    """Edits one program."""

    DEFAULT_CSS = """
    CodeArea { border: none; padding: 0; height: 1fr; width: 1fr; scrollbar-size-vertical: 1;
               scrollbar-size-horizontal: 0; }
    CodeArea:focus { border: none; }
    CodeArea .text-area--gutter { color: $foreground 50%; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("shift+tab", "shift_lines(-1)", "Dedent", show=False),
        Binding("ctrl+d", "duplicate_line", "Duplicate line", show=False),
        Binding("alt+shift+up", "move_line(-1)", "Move line up", show=False),
        Binding("alt+shift+down", "move_line(1)", "Move line down", show=False),
    ]

    def __init__(self, buffer: Buffer, text: str) -> None:
        self.buffer = buffer
        self.marks = Marks()
        self.aid = TypingAid()
        self._width_most = 0
        self._text: str | None = None
        super().__init__(show_line_numbers=True, soft_wrap=False, tab_behavior="indent", max_checkpoints=500)
        self._highlights = LineHighlights()
        self.indent_width = indent.WIDTH
        self._set_document(text, None)

    def on_mount(self) -> None:
        """Take the colours of the app's theme."""
        self.follow_theme()

    def follow_theme(self) -> None:
        """Take over the colours of the app's current theme."""
        from desire_tui.themes import editor_theme

        theme = editor_theme(self.app.current_theme)
        self.register_theme(theme)
        self.theme = theme.name

    @property
    def is_dirty(self) -> bool:
        """Whether there is unsaved work."""
        return self.text != self.buffer.saved_text

    # ------------------------------------------------------------------------------------- colours and marks

    @property
    def text(self) -> str:
        """The whole text, joined once an edit: TextArea asks for it at every line it draws."""
        if self._text is None:
            self._text = self.document.text
        return self._text

    @text.setter
    def text(self, value: str) -> None:
        self.load_text(value)

    def _build_highlight_map(self) -> None:
        self._text = None
        self._line_cache.clear()
        highlights = self._highlights
        highlights.clear()
        if isinstance(
            highlights, LineHighlights
        ):  # TextArea's own constructor comes here before ours is in place
            highlights.document = self.document
            highlights.marks = self.marks.problems

    def _set_document(self, text: str, language: str | None) -> None:
        del language
        self._highlight_query = None
        self._width_most = 0
        self.document = Document(text)
        self.wrapped_document = UnwrappedDocument(self.document, tab_width=self.indent_width)
        self.navigator = DocumentNavigator(self.wrapped_document)
        self._build_highlight_map()
        self.move_cursor((0, 0))
        self._rewrap_and_refresh_virtual_size()

    def marks_changed(self) -> None:
        """Draw again after `marks` changed."""
        self._build_highlight_map()
        self.refresh()

    def edit(self, edit: Edit) -> EditResult:
        """Carry out an edit; marks below move with the text."""
        before = self.document.line_count
        self.marks.problems.pop(edit.top[0], None)
        result = super().edit(edit)
        self._moved(edit.top[0], before)
        return result

    def _undo_batch(self, edits: Sequence[Edit]) -> None:
        before = self.document.line_count
        super()._undo_batch(edits)
        self._moved(min((edit.top[0] for edit in edits), default=0), before)

    def _redo_batch(self, edits: Sequence[Edit]) -> None:
        before = self.document.line_count
        super()._redo_batch(edits)
        self._moved(min((edit.top[0] for edit in edits), default=0), before)

    def _moved(self, row: int, lines_before: int) -> None:
        lines = self.document.line_count - lines_before
        if lines:
            self.marks.shift(row, lines)
            self._build_highlight_map()

    def _refresh_size(self) -> None:
        row = self.cursor_location[0]
        if not self._width_most:
            self._width_most = max((len(line) for line in self.document.lines), default=0)
        self._width_most = max(self._width_most, len(self.document.get_line(row)))
        width = self._width_most + self.gutter_width + 1
        self.virtual_size = Size(width, self.document.line_count)
        self._refresh_scrollbars()

    def render_lines(self, crop: Region) -> list[Strip]:
        """Draw rows; blank ones before the style sheet was applied (a tab opened as a dialog closes)."""
        if not self._component_styles:
            return [Strip.blank(crop.width)] * crop.height
        return super().render_lines(crop)

    def render_line(self, y: int) -> Strip:
        """Draw a row, with its mark in the gutter."""
        strip = super().render_line(y)
        row = y + self.scroll_offset.y
        sign = self._sign(row)
        if sign is None:
            return strip
        character, colour = GUTTER_SIGNS[sign]
        width = self.gutter_width
        left, right = strip.crop(0, width - 1), strip.crop(width)
        style = next(iter(left), Segment("")).style or Style()
        mark = Strip([Segment(character, style + Style(color=colour, bold=True))], 1)
        return Strip.join([left, mark, right])

    def _sign(self, row: int) -> str | None:
        if row == self.marks.traced:
            return "trace"
        if problems := self.marks.problems.get(row):
            return "error" if any(mark.style == "error" for mark in problems) else "warning"
        return "break" if row in self.marks.breakpoints else None

    # ----------------------------------------------------------------------------------------------- typing

    async def _on_key(self, event: events.Key) -> None:
        if self.aid.takes(event, self):
            event.stop()
            event.prevent_default()
            return
        if event.key == "escape":  # TextArea would move the focus
            return
        if event.key == "enter":
            event.stop()
            event.prevent_default()
            self._new_line()
            return
        if event.key == "tab" and self.selection.start[0] != self.selection.end[0]:
            event.stop()
            event.prevent_default()
            self.action_shift_lines(1)
            return
        await super()._on_key(event)
        if event.is_printable:
            self.aid.typed(self)

    def on_blur(self) -> None:
        """Close the completions."""
        self.aid.left(self)

    def _new_line(self) -> None:
        row, column = self.cursor_location
        line = self.document.get_line(row)
        if self.selection.is_empty and column == len(line) and indent.closes(line):
            blanks = indent.closing_indent(self.document.lines, row)
            old = line[: len(line) - len(line.lstrip())]
            if blanks is not None and len(blanks) < len(old):
                self.replace(blanks, (row, 0), (row, len(old)), maintain_selection_offset=True)
                line = self.document.get_line(row)
                column = len(line)
                self.move_cursor((row, column))
        blanks = indent.indent_after(line[:column]) if column else ""
        self._replace_via_keyboard("\n" + blanks, *self.selection)

    def _selected_rows(self) -> tuple[int, int]:
        (top, _), (bottom, column) = sorted(self.selection)
        if bottom > top and column == 0:
            bottom -= 1
        return top, bottom

    def rewrite_rows(self, top: int, bottom: int, lines: list[str]) -> None:
        """Replace whole rows as one undoable edit; the rows stay selected if there were several."""
        end = len(self.document.get_line(bottom))
        row, column = self.cursor_location
        self.history.checkpoint()
        self.replace("\n".join(lines), (top, 0), (bottom, end), maintain_selection_offset=False)
        self.history.checkpoint()
        if top != bottom:
            self.selection = Selection((top, 0), (top + len(lines) - 1, len(lines[-1])))
        else:
            self.move_cursor((row, min(column, len(lines[0]))))

    def action_shift_lines(self, levels: int) -> None:
        """Indent or dedent the selected rows."""
        top, bottom = self._selected_rows()
        self.rewrite_rows(top, bottom, indent.shift(self.document.lines[top : bottom + 1], levels))

    def toggle_comment(self) -> None:
        """Turn the selected rows into comments, or back."""
        top, bottom = self._selected_rows()
        self.rewrite_rows(top, bottom, indent.toggle_comment(self.document.lines[top : bottom + 1]))

    def action_duplicate_line(self) -> None:
        """Repeat the cursor's row below it."""
        row, column = self.cursor_location
        self.insert("\n" + self.document.get_line(row), (row, len(self.document.get_line(row))))
        self.move_cursor((row + 1, column))

    def action_move_line(self, step: int) -> None:
        """Move the selected rows up or down by one."""
        top, bottom = self._selected_rows()
        if not 0 <= (top if step < 0 else bottom) + step < self.document.line_count:
            return
        lines = self.document.lines
        if step < 0:
            self.rewrite_rows(top - 1, bottom, [*lines[top : bottom + 1], lines[top - 1]])
        else:
            self.rewrite_rows(top, bottom + 1, [lines[bottom + 1], *lines[top : bottom + 1]])
        self.selection = Selection(
            (top + step, 0), (bottom + step, len(self.document.get_line(bottom + step)))
        )

    def go_to(self, row: int, column: int = 0) -> None:
        """Put the cursor on a row (from 0), in the middle of the view."""
        row = min(max(row, 0), self.document.line_count - 1)
        self.move_cursor((row, min(column, len(self.document.get_line(row)))), center=True)

    def word_at_cursor(self) -> str:
        """Return the name or word the cursor is on or just behind, or an empty text."""
        row, column = self.cursor_location
        line = self.document.get_line(row)
        start, end = column, column
        while start > 0 and (line[start - 1].isalnum() or line[start - 1] in "_$/"):
            start -= 1
        while end < len(line) and (line[end].isalnum() or line[end] in "_$/"):
            end += 1
        return line[start:end].strip("/")
