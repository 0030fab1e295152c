"""Line n stands in row n: TextArea's wrapping tables without the tables.

The editor never wraps. Textual's `WrappedDocument` still builds four lists over all lines at every load,
resize and change of the gutter's width: half a minute for a program of 20 MB.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, overload

from textual._cells import cell_width_to_column_index
from textual.document._document_navigator import DocumentNavigator
from textual.document._wrapped_document import WrappedDocument
from textual.expand_tabs import get_tab_widths

from desire_tui.engine.visible_text import visible

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.document._document import DocumentBase, Location
    from textual.geometry import Offset


class _Rows(Sequence[Any]):
    """A list with one entry for each line, made when asked for."""

    def __init__(self, document: DocumentBase, entry: Callable[[int], Any]) -> None:
        self._document = document
        self._entry = entry

    def __len__(self) -> int:
        return self._document.line_count

    @overload
    def __getitem__(self, row: int) -> Any: ...
    @overload
    def __getitem__(self, row: slice) -> Sequence[Any]: ...
    def __getitem__(self, row: int | slice) -> Any:
        count = len(self)
        if isinstance(row, slice):
            return [self._entry(number) for number in range(count)[row]]
        if not -count <= row < count:
            raise IndexError(row)
        return self._entry(row % count)


class UnwrappedDocument(WrappedDocument):
    """A document whose lines are never broken; those behind `fold` are not shown."""

    fold: int | None = None

    def wrap(self, width: int, tab_width: int | None = None) -> None:
        """Nothing is wrapped, whatever the width."""
        del width
        self._width = 0
        self._tab_width = tab_width or self._tab_width
        document = self.document
        self._wrap_offsets = _Rows(document, lambda _: [])  # type: ignore[assignment]
        self._offset_to_line_info = _Rows(document, lambda row: (row, 0))  # type: ignore[assignment]
        self._line_index_to_offsets = _Rows(document, lambda row: [row])  # type: ignore[assignment]
        self._tab_width_cache = _Rows(document, self._tabs)  # type: ignore[assignment]

    def _tabs(self, row: int) -> list[int]:
        return [width for _, width in get_tab_widths(self._shown(row), self._tab_width)]

    def _shown(self, row: int) -> str:
        """Return a line as it is drawn, where control characters take a cell each."""
        return visible(self.document.get_line(row))

    def get_sections(self, line_index: int) -> list[str]:
        """Return a line, which is one section."""
        return [self._shown(line_index)]

    def offset_to_location(self, offset: Offset) -> Location:
        """Return the place that is drawn in a row and a cell."""
        row = min(max(offset.y, 0), self.height - 1)
        return row, cell_width_to_column_index(self._shown(row), max(offset.x, 0), self._tab_width)

    @property
    def height(self) -> int:
        """As many rows as lines are shown."""
        return self.document.line_count if self.fold is None else self.fold + 1

    def wrap_range(self, start: Location, old_end: Location, new_end: Location) -> None:
        """Nothing to bring up to date after an edit."""


class ShownRows(DocumentNavigator):
    """Finds the way among the rows that are shown: the last of them is the end."""

    def is_last_document_line(self, location: Location) -> bool:
        """Whether a place is in the last row that is shown."""
        return location[0] >= self._wrapped_document.height - 1
