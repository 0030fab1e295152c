"""A view of a program: drawn text over lines that other views may show and change.

TextArea's internals are overridden in few places, named here and in `text_rendering`: `_set_document` (shared
lines, no wrapping tables), `edit` / `_undo_batch` / `_redo_batch` (other views follow), `move_cursor` /
`scroll_cursor_visible` (no more movement than it takes), `_refresh_size` (no measuring, no layout at each
key).
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.cells import cell_len
from textual.geometry import Size
from textual.widgets import TextArea
from textual.widgets.text_area import Selection

from desire_tui.editor import folding, indent
from desire_tui.editor.line_marks import Marks
from desire_tui.editor.program_lines import ProgramLines
from desire_tui.editor.text_rendering import RenderedText
from desire_tui.editor.unwrapped_lines import ShownRows, UnwrappedDocument
from desire_tui.engine.visible_text import visible

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from textual.document._document import EditResult, Location
    from textual.document._edit import Edit
    from textual.geometry import Offset

WIDTH_STEP = 16
"""The width of the text grows by so much, so that not every letter of the longest line changes it."""


class ProgramView(RenderedText):
    """Shows a program's lines with marks and colours. `views` are all views of the same lines, itself too."""

    document: ProgramLines

    def __init__(self, text: str, twin: ProgramView | None = None) -> None:
        self.views: list[ProgramView] = []
        self._is_changing = False
        self._rows_moved = self._rows_shown = 0
        self._width_most = 0
        self._text: str | None = None
        super().__init__(twin.marks if twin else Marks())
        self.indent_width = indent.WIDTH
        self.views = [*twin.views, self] if twin else [self]
        for view in self.views:
            view.views = self.views
        if twin is None:
            self._set_document(text, None)
        else:
            self.history = twin.history
            self.show_lines(twin.document)

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
        super()._build_highlight_map()

    def _set_document(self, text: str, language: str | None) -> None:
        del language
        self._highlight_query = None
        lines = ProgramLines(text)
        lines.followers.append(self.marks.replaced)
        for view in self.views:
            view.show_lines(lines)

    def show_lines(self, lines: ProgramLines) -> None:
        """Show other lines."""
        self._width_most = _width(lines.lines)
        self.fold = None
        self.document = lines
        lines.followers.append(self._replaced)
        self.wrapped_document = UnwrappedDocument(lines, tab_width=self.indent_width)
        self.navigator = ShownRows(self.wrapped_document)
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
        if self.fold is not None and edit.bottom[0] >= self.fold:
            self.set_fold(None)
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
        rows = self.document.line_count
        self._is_changing, self.marks.takes_back = True, takes_back
        try:
            yield
        finally:
            self._is_changing = self.marks.takes_back = False
        self._refresh_size()
        if rows != self.document.line_count:
            self.scroll_cursor_visible()
        for view in self.views:
            if view is not self:
                view.follow_text()

    def _replaced(self, top: Location, bottom: Location, end: Location) -> None:
        """Note how wide the new lines are; keep the cursor on its text while another view changes it."""
        self._width_most = max(self._width_most, _width(self.document.lines[top[0] : end[0] + 1]))
        if self.fold is not None:
            self._keep_fold(None if bottom[0] >= self.fold else self.fold + end[0] - bottom[0])
        if self._is_changing:
            return
        rows_above = end[0] - bottom[0] if bottom[0] < self.scroll_offset.y else 0
        moved = Selection(*(self.document.followed(place, top, bottom, end) for place in self.selection))
        self.set_reactive(TextArea.selection, moved)  # without scrolling to it
        self._rows_moved += rows_above

    # ---------------------------------------------------------------------------------------------- folding

    def fold_expectations(self) -> bool:
        """Fold what the program must show; False if there is no such thing."""
        row = folding.fold_row(self.document.lines)
        if row is not None:
            if max(self.selection)[0] > row:
                self.move_cursor((row, len(self.document.get_line(row))))
            self.set_fold(row)
        return row is not None

    def set_fold(self, row: int | None) -> None:
        """Show nothing behind a row; None: show everything."""
        self._keep_fold(row)
        self._refresh_size()
        self.draw_again()

    def _keep_fold(self, row: int | None) -> None:
        self.fold = row
        assert isinstance(self.wrapped_document, UnwrappedDocument)
        self.wrapped_document.fold = row

    def _watch_selection(self, previous_selection: Selection, selection: Selection) -> None:
        """Open the fold where the cursor goes into it: a place found, a problem, the whole text."""
        if self.fold is not None and max(selection)[0] > self.fold:
            self.set_fold(None)
        super()._watch_selection(previous_selection, selection)

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
            # a view just made is not held to the end of the text by itself
            end = self.wrapped_document.height - self.size.height
            y = min(self._cursor_offset[1] - self.size.height // 2, max(end, 0))
            self.scroll_to(0, y, animate=False, immediate=True, force=True)
        return super().scroll_cursor_visible(animate=animate)

    def _on_resize(self) -> None:
        """Keep the cursor in sight where the view becomes lower: by the terminal, by a problem below it."""
        super()._on_resize()
        before, self._rows_shown = self._rows_shown, self.size.height
        if self._rows_shown <= self.cursor_location[0] - self.scroll_offset.y < before:
            self.scroll_cursor_visible()

    def _refresh_size(self) -> None:
        if self._is_changing:
            return  # TextArea's undo comes here while the cursor stands where the text no longer is
        width = -(-(self._width_most + self.gutter_width + 1) // WIDTH_STEP) * WIDTH_STEP
        size = Size(width, self.wrapped_document.height)
        if size == self.virtual_size:
            return
        self.set_reactive(TextArea.virtual_size, size)  # no new layout of the whole desktop
        self._scroll_update(size)
        self._refresh_scrollbars()


def _width(lines: Sequence[str]) -> int:
    """Return how many cells the longest of some lines takes, tabs and wide characters counted."""
    return max((_cells(line) for line in lines), default=0)


def _cells(line: str) -> int:
    return (
        len(line) if line.isascii() and "\t" not in line else cell_len(visible(line).expandtabs(indent.WIDTH))
    )
