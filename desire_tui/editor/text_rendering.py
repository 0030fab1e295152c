"""How a program is drawn: Textual's TextArea with the language's colours and marks in the gutter.

Overridden of TextArea: `_build_highlight_map` (colours without tree-sitter), `render_line` and `refresh`
(gutter marks; only rows that look otherwise than before are drawn), `get_line` and what measures its columns
(control characters are seen), `find_matching_bracket` (near the cursor only).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual._cells import cell_width_to_column_index
from textual.cache import LRUCache
from textual.expand_tabs import expand_tabs_inline
from textual.geometry import Region
from textual.strip import Strip
from textual.widgets import TextArea

from desire_tui.editor.brackets import partner
from desire_tui.editor.folding import folded_line
from desire_tui.editor.highlighting import LineHighlights
from desire_tui.engine.visible_text import visible

if TYPE_CHECKING:
    from typing import Self

    from textual.document._document import Location

    from desire_tui.editor.line_marks import Marks
    from desire_tui.editor.program_lines import ProgramLines

GUTTER_SIGNS = {
    "error": ("✖", "error"),
    "warning": ("▲", "warning"),
    "break": ("●", "error"),
    "trace": ("▶", "success"),
}
"""Signs, each with the colour of the theme it is drawn in."""


ROWS_KEPT = 1024
"""So many drawn rows are kept: what a key does not change is not drawn again."""


class RenderedText(TextArea):
    """Draws lines with colours and `marks`."""

    document: ProgramLines

    def __init__(self, marks: Marks) -> None:
        self.marks = marks
        self._drawn: LRUCache[tuple[object, ...], Strip] = LRUCache(ROWS_KEPT)
        self._shown: dict[int, tuple[object, ...]] = {}
        """How each row of the window looked when it was drawn."""
        self._common: tuple[object, ...] = ()
        self._is_due = False
        self.fold: int | None = None
        """The row behind which nothing is shown, where what a program must show is folded."""
        super().__init__(show_line_numbers=True, soft_wrap=False, tab_behavior="indent", max_checkpoints=500)
        self._coloured = LineHighlights()
        self._highlights = self._coloured

    def on_mount(self) -> None:
        """Take the colours of the app's theme."""
        self.follow_theme()

    def follow_theme(self) -> None:
        """Take over the colours of the app's current theme."""
        from desire_tui.common.themes import editor_theme

        theme = editor_theme(self.app.current_theme)
        self.register_theme(theme)
        self.theme = theme.name

    def _build_highlight_map(self) -> None:
        highlights = self._highlights
        highlights.clear()
        if isinstance(highlights, LineHighlights):  # TextArea's own constructor comes here before
            highlights.document = self.document
            highlights.marks = self.marks.problems
            highlights.found = self.marks.found
            highlights.is_program = self.marks.is_program

    def refresh(
        self, *regions: Region, repaint: bool = True, layout: bool = False, recompose: bool = False
    ) -> Self:
        """Draw again: the regions, or the rows that no longer look as they are shown."""
        if regions or layout or recompose or not repaint or not self._shown:
            return super().refresh(*regions, repaint=repaint, layout=layout, recompose=recompose)
        if not self._is_due:
            self._is_due = True
            self.call_next(self._refresh_rows)  # after all that the key does
        return self

    def _refresh_rows(self) -> None:
        self._is_due = False
        top, width, shown = self.scroll_offset.y, self.size.width, self._shown
        common = self._common_looks()
        rows = [y for y in range(self.size.height) if self._looks(top + y, common) != shown.get(y)]
        if rows:
            super().refresh(*(Region(0, y, width, 1) for y in rows))

    def get_line(self, line_index: int) -> Text:
        """Return a line as it is drawn: control characters are seen, each in a column of its own."""
        line = visible(self.document.get_line(line_index))
        if line_index == self.fold:
            line = folded_line(line, self.document.line_count - line_index - 1)
        return Text(line, end="", no_wrap=True)

    def get_column_width(self, row: int, column: int) -> int:
        """Return the cell at which a column is drawn."""
        return cell_len(expand_tabs_inline(visible(self.document.get_line(row)[:column]), self.indent_width))

    def cell_width_to_column_index(self, cell_width: int, row_index: int) -> int:
        """Return the column that is drawn in a cell."""
        line = visible(self.document.get_line(row_index))
        return cell_width_to_column_index(line, cell_width, self.indent_width)

    def render_lines(self, crop: Region) -> list[Strip]:
        """Draw rows; blank ones before the style sheet was applied (a tab opened as a dialog closes)."""
        if not self._component_styles:
            return [Strip.blank(crop.width)] * crop.height
        common = self._common_looks()
        if common != self._common:
            self._common = common
            if self._theme:
                self._theme.apply_css(self)
        return super(TextArea, self).render_lines(crop)

    def render_line(self, y: int) -> Strip:
        """Draw a row, with its mark in the gutter; rows that look as before are kept."""
        row = y + self.scroll_offset.y
        looks = self._shown[y] = self._looks(row, self._common)
        strip = self._drawn.get(looks)
        if strip is None:
            strip = self._signed(self._render_line(y), self._sign(row))
            if row < self.wrapped_document.height:
                strip = self._cut_marked(strip, row)
            self._drawn[looks] = strip
        return strip

    def _cut_marked(self, strip: Strip, row: int) -> Strip:
        """Mark where the line goes on beyond the window, but not in the cursor's cell."""
        left, width, scrolled = self.gutter_width, self.size.width, self.scroll_offset.x
        line = self.document.get_line(row)
        if not scrolled and len(line) <= width - left and line.isascii() and "\t" not in line:
            return strip  # most lines: nothing is to be measured
        here, column = self.cursor_location
        cursor = left + self.get_column_width(row, column) - scrolled if here == row else -1
        if scrolled and cursor != left and line[: self.cell_width_to_column_index(scrolled, row)].strip():
            strip = Strip.join([strip.crop(0, left), self._cut_mark("‹"), strip.crop(left + 1)])
        if self.get_column_width(row, len(line)) - scrolled > width - left and cursor != width - 1:
            strip = Strip.join([strip.crop(0, width - 1), self._cut_mark("›")])
        return strip

    def _cut_mark(self, mark: str) -> Strip:
        style = self.rich_style + Style(color=str(self.app.current_theme.primary), bold=True)
        return Strip([Segment(mark, style)], 1)

    def _common_looks(self) -> tuple[object, ...]:
        """Return what the looks of all rows depend on."""
        return (
            self.size.width, max(self.virtual_size.width, self.size.width), self.gutter_width,
            self.scroll_offset.x, self.theme, self.rich_style, self.has_focus,
            LineHighlights.are_on() and self.marks.is_program, self.fold,
            self.document.line_count if self.fold is not None else 0,
        )  # fmt: skip

    def _looks(self, row: int, common: tuple[object, ...]) -> tuple[object, ...]:
        """Return all that a row's looks depend on."""
        if row >= self.wrapped_document.height:
            return common
        (top, left), (bottom, right) = sorted(self.selection)
        selected = None
        if top <= row <= bottom:
            selected = (left if row == top else -1, right if row == bottom else -1, top == bottom)
        cursor = None
        bracket = self._matching_bracket_location
        if self.cursor_location[0] == row:
            cursor = (self._draw_cursor, self.cursor_location, bracket is not None)
        partner_here = bracket if bracket is not None and bracket[0] == row else None
        problems = (*self.marks.problems.get(row, ()), *self.marks.found.get(row, ()))
        return (
            common, row, self.document.get_line(row), self._coloured.before(row), self._sign(row), problems,
            selected, cursor, partner_here,
        )  # fmt: skip

    def _signed(self, strip: Strip, sign: str | None) -> Strip:
        if sign is None:
            return strip
        character, colour = GUTTER_SIGNS[sign]
        width = self.gutter_width
        left, right = strip.crop(0, width - 1), strip.crop(width)
        style = next(iter(left), Segment("")).style or Style()
        colour = str(getattr(self.app.current_theme, colour))
        mark = Strip([Segment(character, style + Style(color=colour, bold=True))], 1)
        return Strip.join([left, mark, right])

    def _sign(self, row: int) -> str | None:
        if row == self.marks.traced:
            return "trace"
        if problems := self.marks.problems.get(row):
            return "error" if any(mark.style == "error" for mark in problems) else "warning"
        return "break" if row in self.marks.breakpoints else None

    def find_matching_bracket(self, bracket: str, search_from: Location) -> Location | None:
        """Return where the partner of a bracket stands, if it stands near it."""
        return partner(self.document.lines, search_from) if bracket in "([{)]}" and bracket else None
