"""A view of a program: Textual's TextArea over lines that other views may show and change, with marks.

TextArea's internals are overridden in few places, each named here: `_build_highlight_map` (colours without
tree-sitter), `_set_document` (shared lines, no wrapping tables), `edit` / `_undo_batch` / `_redo_batch`
(other views follow), `render_line` and `refresh` (gutter marks; only rows that look otherwise than before are
drawn), `move_cursor` / `scroll_cursor_visible` (no more movement than it takes), `_refresh_size` (no
measuring, no layout at each key), `find_matching_bracket` (near the cursor only).
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.cache import LRUCache
from textual.document._document_navigator import DocumentNavigator
from textual.geometry import Region, Size
from textual.strip import Strip
from textual.widgets import TextArea
from textual.widgets.text_area import Selection

from desire_tui.editor import indent
from desire_tui.editor.brackets import partner
from desire_tui.editor.document import Lines, follow
from desire_tui.editor.highlighting import LineHighlights
from desire_tui.editor.marks import Marks
from desire_tui.editor.unwrapped import UnwrappedDocument

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import Self

    from textual.document._document import EditResult, Location
    from textual.document._edit import Edit
    from textual.geometry import Offset

GUTTER_SIGNS = {
    "error": ("✖", "error"),
    "warning": ("▲", "warning"),
    "break": ("●", "error"),
    "trace": ("▶", "success"),
}
"""Signs, each with the colour of the theme it is drawn in."""


ROWS_KEPT = 1024
"""So many drawn rows are kept: what a key does not change is not drawn again."""


WIDTH_STEP = 16
"""The width of the text grows by so much, so that not every letter of the longest line changes it."""


class ProgramView(TextArea):
    """Shows a program's lines with marks and colours. `views` are all views of the same lines, itself too."""

    document: Lines

    def __init__(self, text: str, twin: ProgramView | None = None) -> None:
        self.marks: Marks = twin.marks if twin else Marks()
        self.views: list[ProgramView] = []
        self._is_changing = False
        self._rows_moved = 0
        self._width_most = 0
        self._text: str | None = None
        self._drawn: LRUCache[tuple[object, ...], Strip] = LRUCache(ROWS_KEPT)
        self._shown: dict[int, tuple[object, ...]] = {}
        """How each row of the window looked when it was drawn."""
        self._common: tuple[object, ...] = ()
        self._is_due = False
        super().__init__(show_line_numbers=True, soft_wrap=False, tab_behavior="indent", max_checkpoints=500)
        self._coloured = LineHighlights()
        self._highlights = self._coloured
        self.indent_width = indent.WIDTH
        self.views = [*twin.views, self] if twin else [self]
        for view in self.views:
            view.views = self.views
        if twin is None:
            self._set_document(text, None)
        else:
            self.history = twin.history
            self.show_lines(twin.document)

    def on_mount(self) -> None:
        """Take the colours of the app's theme."""
        self.follow_theme()

    def follow_theme(self) -> None:
        """Take over the colours of the app's current theme."""
        from desire_tui.themes import editor_theme

        theme = editor_theme(self.app.current_theme)
        self.register_theme(theme)
        self.theme = theme.name

    # -------------------------------------------------------------------------------------- lines and views

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
        highlights = self._highlights
        highlights.clear()
        if isinstance(
            highlights, LineHighlights
        ):  # TextArea's own constructor comes here before ours is in place
            highlights.document = self.document
            highlights.marks = self.marks.problems
            highlights.found = self.marks.found

    def _set_document(self, text: str, language: str | None) -> None:
        del language
        self._highlight_query = None
        lines = Lines(text)
        lines.followers.append(self.marks.replaced)
        for view in self.views:
            view.show_lines(lines)

    def show_lines(self, lines: Lines) -> None:
        """Show other lines."""
        self._width_most = _width(lines.lines)
        self.document = lines
        lines.followers.append(self._replaced)
        self.wrapped_document = UnwrappedDocument(lines, tab_width=self.indent_width)
        self.navigator = DocumentNavigator(self.wrapped_document)
        self._build_highlight_map()
        self.move_cursor((0, 0))
        self._rewrap_and_refresh_virtual_size()

    def part(self) -> None:
        """Leave the other views alone with the lines."""
        self.views.remove(self)
        self.document.followers.remove(self._replaced)

    def marks_changed(self) -> None:
        """Draw again after `marks` changed."""
        for view in self.views:
            view.draw_again()

    def draw_again(self) -> None:
        """Draw this view again, with nothing kept from before."""
        self._build_highlight_map()
        self.refresh()

    def edit(self, edit: Edit) -> EditResult:
        """Carry out an edit."""
        self.marks.problems.pop(edit.top[0], None)
        with self._changing():
            return super().edit(edit)

    def _undo_batch(self, edits: Sequence[Edit]) -> None:
        with self._changing(takes_back=True):
            super()._undo_batch(edits)

    def _redo_batch(self, edits: Sequence[Edit]) -> None:
        with self._changing(takes_back=True):
            super()._redo_batch(edits)

    @contextmanager
    def _changing(self, *, takes_back: bool = False) -> Iterator[None]:
        self._is_changing, self.marks.takes_back = True, takes_back
        try:
            yield
        finally:
            self._is_changing = self.marks.takes_back = False
        for view in self.views:
            if view is not self:
                view.follow_text()

    def _replaced(self, top: Location, bottom: Location, end: Location) -> None:
        """Note how wide the new lines are; keep the cursor on its text while another view changes it."""
        self._width_most = max(self._width_most, _width(self.document.lines[top[0] : end[0] + 1]))
        if self._is_changing:
            return
        rows_above = end[0] - bottom[0] if bottom[0] < self.scroll_offset.y else 0
        moved = Selection(*(follow(place, top, bottom, end) for place in self.selection))
        self.set_reactive(TextArea.selection, moved)  # without scrolling to it
        self._rows_moved += rows_above

    def follow_text(self) -> None:
        """Draw the text anew after another view changed it; what is seen stays in its place."""
        self._build_highlight_map()
        self._recompute_cursor_offset()  # type: ignore[no-untyped-call]
        self._refresh_size()
        if self._rows_moved:
            self.scroll_to(y=self.scroll_offset.y + self._rows_moved, animate=False)
            self._rows_moved = 0
        self.refresh()

    def move_cursor(
        self, location: Location, select: bool = False, center: bool = False, record_width: bool = True
    ) -> None:
        """Move the cursor; `center` puts a row not in view into the middle, and shows the first columns."""
        top = self.scroll_offset.y
        if center and top <= location[0] < top + self.size.height:
            center = False
            self.scroll_to(x=0, animate=False, immediate=True)
        super().move_cursor(location, select, center, record_width)

    def scroll_cursor_visible(self, center: bool = False, animate: bool = False) -> Offset:
        """Bring the cursor into view; `center` is about rows only."""
        if center and self._has_cursor:
            self._recompute_cursor_offset()  # type: ignore[no-untyped-call]
            y = self._cursor_offset[1] - self.size.height // 2
            self.scroll_to(0, y, animate=False, immediate=True, force=True)
        return super().scroll_cursor_visible(animate=animate)

    def _refresh_size(self) -> None:
        width = -(-(self._width_most + self.gutter_width + 1) // WIDTH_STEP) * WIDTH_STEP
        size = Size(width, self.document.line_count)
        if size == self.virtual_size:
            return
        self.set_reactive(ProgramView.virtual_size, size)  # no new layout of the whole desktop
        self._scroll_update(size)
        self._refresh_scrollbars()

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
            strip = self._drawn[looks] = self._signed(self._render_line(y), self._sign(row))
        return strip

    def _common_looks(self) -> tuple[object, ...]:
        """Return what the looks of all rows depend on."""
        return (
            self.size.width, max(self.virtual_size.width, self.size.width), self.gutter_width,
            self.scroll_offset.x, self.theme, self.rich_style, self.has_focus, LineHighlights.are_on(),
        )  # fmt: skip

    def _looks(self, row: int, common: tuple[object, ...]) -> tuple[object, ...]:
        """Return all that a row's looks depend on."""
        if row >= self.document.line_count:
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


def _width(lines: Sequence[str]) -> int:
    """Return how many cells the longest of some lines takes, tabs and wide characters counted."""
    return max((_cells(line) for line in lines), default=0)


def _cells(line: str) -> int:
    return len(line) if line.isascii() and "\t" not in line else cell_len(line.expandtabs(indent.WIDTH))
