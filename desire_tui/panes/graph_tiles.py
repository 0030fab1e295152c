"""The pieces of the graph on screen: tiles of 8 columns with frame and curves.

A widget's partial refresh sends a row again from the widget's left edge: tiles keep a frame at a few
kilobytes. They stand where the pane's size puts them, whatever the frame: a new graph lays nothing out anew.
"""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING

from textual.geometry import Region
from textual.widget import Widget

from desire_tui.panes.graph_sheet import TILE_COLUMNS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from textual.strip import Strip

    from desire_tui.panes.graph_sheet import GraphSheet


class SheetTile(Widget):
    """Columns `number * 8 …` of the sheet."""

    DEFAULT_CSS = "SheetTile { width: 8; height: 1fr; }"
    can_focus = False
    ALLOW_SELECT = False

    def __init__(self, sheet: GraphSheet, number: int) -> None:
        super().__init__()
        self._sheet = sheet
        self._number = number

    def render_line(self, y: int) -> Strip:
        """Draw a row of cells."""
        return self._sheet.piece(self._number, y)

    def render_lines(self, crop: Region) -> list[Strip]:
        """Draw rows.

        Widget's own way deals with padding, border, opacity and links in each row. Tiles have none, and
        it took most of the time from a run's start to its first dots.
        """
        piece = self._sheet.piece
        strips = [piece(self._number, y) for y in crop.line_range]
        filters = self.get_line_filters()
        if filters:
            background = self.background_colors[1]
            for line_filter in filters:
                strips = [strip.apply_filter(line_filter, background) for strip in strips]
        if crop.column_span != (0, TILE_COLUMNS):
            strips = [strip.crop(*crop.column_span) for strip in strips]
        return strips


class Tiles:
    """All tiles of a sheet, from the left."""

    def __init__(self, sheet: GraphSheet) -> None:
        self._sheet = sheet
        self._tiles: list[SheetTile] = []

    def grow(self, columns: int) -> list[SheetTile]:
        """Make what is missing for so many columns; return the new ones."""
        wanted = -(-columns // TILE_COLUMNS)
        new = [SheetTile(self._sheet, number) for number in range(len(self._tiles), wanted)]
        self._tiles += new
        return new

    def refresh(self, cells: Iterable[tuple[int, int]]) -> None:
        """Have those cells (row, tile) sent that look different from before."""
        changed = sorted((tile, row) for row, tile in self._sheet.changed(cells))
        for number, of_tile in groupby(changed, key=lambda cell: cell[0]):
            if number >= len(self._tiles):
                continue
            rows = [row for _, row in of_tile]
            regions, first = [], rows[0]
            for row, following in zip(rows, [*rows[1:], -1], strict=True):
                if following != row + 1:
                    regions.append(Region(0, first, TILE_COLUMNS, row - first + 1))
                    first = following
            self._tiles[number].refresh(*regions)
