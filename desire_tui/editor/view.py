"""A view of a program: Textual's TextArea over lines that other views may show and change, with marks.

TextArea's internals are overridden in few places, each named here: `_build_highlight_map` (colours without
tree-sitter), `_set_document` (shared lines, no wrapping tables), `edit` / `_undo_batch` / `_redo_batch`
(other views follow), `render_line` (gutter marks), `_refresh_size` (the width is not measured anew at each
key), `find_matching_bracket` (near the cursor only), `selection` and `_watch_selection` (only the rows
concerned are drawn again: TextArea sends all that is seen of the text at each key, 20 KB).
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.document._document_navigator import DocumentNavigator
from textual.geometry import Region, Size
from textual.reactive import Reactive, reactive
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

    from textual.document._document import EditResult, Location
    from textual.document._edit import Edit

GUTTER_SIGNS = {
    "error": ("✖", "#f4737b"),
    "warning": ("▲", "#e5c07b"),
    "break": ("●", "#f4737b"),
    "trace": ("▶", "#7fc97f"),
}


class ProgramView(TextArea):
    """Shows a program's lines with marks and colours. `views` are all views of the same lines, itself too."""

    document: Lines
    selection: Reactive[Selection] = reactive(Selection(), init=False, always_update=True, repaint=False)

    def __init__(self, text: str, twin: ProgramView | None = None) -> None:
        self.marks: Marks = twin.marks if twin else Marks()
        self.views: list[ProgramView] = []
        self._is_changing = False
        self._rows_moved = 0
        self._width_most = 0
        self._text: str | None = None
        super().__init__(show_line_numbers=True, soft_wrap=False, tab_behavior="indent", max_checkpoints=500)
        self._highlights = LineHighlights()
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
        self.refresh()

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
        lines = self.document.line_count
        with self._changing():
            result = super().edit(edit)
        if self.document.line_count == lines:
            self._refresh_rows(edit.top[0], max(edit.bottom[0], result.end_location[0]))
        else:
            self.refresh()
        return result

    def _undo_batch(self, edits: Sequence[Edit]) -> None:
        with self._changing():
            super()._undo_batch(edits)
        self.refresh()

    def _redo_batch(self, edits: Sequence[Edit]) -> None:
        with self._changing():
            super()._redo_batch(edits)
        self.refresh()

    def _watch_selection(self, previous_selection: Selection, selection: Selection) -> None:
        bracket = self._matching_bracket_location
        super()._watch_selection(previous_selection, selection)
        for places in (previous_selection, selection):
            (top, _), (bottom, _) = sorted(places)
            self._refresh_rows(top, bottom)
        for place in (bracket, self._matching_bracket_location):
            if place is not None:
                self._refresh_rows(place[0], place[0])

    def _refresh_rows(self, top: int, bottom: int) -> None:
        """Draw rows `top … bottom` of the text again, as far as they are seen."""
        first = max(top - self.scroll_offset.y, 0)
        last = min(bottom - self.scroll_offset.y, self.size.height - 1)
        if first <= last:
            self.refresh(Region(0, first, self.size.width, last - first + 1))

    @contextmanager
    def _changing(self) -> Iterator[None]:
        self._is_changing = True
        try:
            yield
        finally:
            self._is_changing = False
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

    def _refresh_size(self) -> None:
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

    def find_matching_bracket(self, bracket: str, search_from: Location) -> Location | None:
        """Return where the partner of a bracket stands, if it stands near it."""
        return partner(self.document.lines, search_from) if bracket in "([{)]}" and bracket else None


def _width(lines: Sequence[str]) -> int:
    """Return how many cells the longest of some lines takes, tabs and wide characters counted."""
    return max((_cells(line) for line in lines), default=0)


def _cells(line: str) -> int:
    return len(line) if line.isascii() and "\t" not in line else cell_len(line.expandtabs(indent.WIDTH))
