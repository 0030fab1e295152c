"""Where panes meet: moved by keys or dragged with the mouse, remembered from session to session."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from textual import events

from desire_tui.common.remembered import remember, remembered

if TYPE_CHECKING:
    from textual.geometry import Region
    from textual.screen import Screen
    from textual.widget import Widget

    from desire_tui.desktop.layout_rules import Pane

Split = Literal["columns", "rows", "left", "right"]
"""Between the columns, beside each other or one above the other; within the left one; within the right."""
COLUMNS_LEAST, ROWS_LEAST = 16, 4
"""What a pane keeps."""
_LINE = "─│╭╮╰╯"


class _Sides(NamedTuple):
    first: Widget
    second: Widget

    @property
    def are_shown(self) -> bool:
        return self.first.display and self.second.display


class Splits:
    """The part that the first of two neighbours has of both; by itself the style sheet's."""

    def __init__(self, screen: Screen[None]) -> None:
        self._screen = screen
        kept = remembered().get("splits")
        self._parts: dict[str, float] = {
            name: part
            for name, part in (kept.items() if isinstance(kept, dict) else ())
            if isinstance(part, float) and 0 < part < 1
        }
        self._held: Split | None = None
        self._column_split: Split | None = None

    def _sides(self, split: Split | None) -> _Sides:
        names = {"left": ("#editor", "#command"), "right": ("#graph", "#side")}
        return _Sides(*(self._screen.query_one(name) for name in names.get(split or "", ("#left", "#right"))))

    def lay(self, column_split: Split | None) -> None:
        """Give all panes their parts; `column_split`: how the columns stand, None where only one is shown."""
        self._column_split = column_split
        for side in (*self._sides("columns"), *self._sides("left"), *self._sides("right")):
            side.styles.clear_rule("width")
            side.styles.clear_rule("height")
        splits: tuple[Split | None, ...] = ("left", "right", column_split)
        for split in splits:
            part, sides = self._parts.get(split or ""), self._sides(split)
            if part is not None and sides.are_shown:
                for side, share in zip(sides, (f"{100 * part:.3f}%", "1fr"), strict=True):
                    if split == "columns":
                        side.styles.width = share
                    else:
                        side.styles.height = share

    def reset(self) -> None:
        """Let the style sheet decide."""
        self._parts.clear()
        self.lay(self._column_split)
        remember(splits={})

    def grow(self, pane: Pane, columns: int, rows: int) -> bool:
        """Make a pane wider or higher by so many cells; False if nothing stands beside it there."""
        in_left = pane in ("editor", "command")
        split: Split | None = "left" if in_left else "right"
        is_first = pane in ("editor", "graph")
        if columns:
            split, is_first = self._column_split, in_left
        if split is None or not self._sides(split).are_shown:
            return False
        first, _ = self._sides(split)
        step = (columns or rows) * (1 if is_first else -1)
        self._place(split, (first.region.width if split == "columns" else first.region.height) + step)
        remember(splits=self._parts)
        return True

    def _place(self, split: Split, size: int) -> None:
        """Give the first of two neighbours so many columns or rows, as far as both keep enough."""
        regions = [side.region for side in self._sides(split)]
        across = split == "columns"
        total = sum(region.width if across else region.height for region in regions)
        least = min(COLUMNS_LEAST if across else ROWS_LEAST, total // 2)
        kept = min(max(size, least), total - least)
        self._parts[split] = (kept + 0.1) / max(
            total, 1
        )  # a part of a cell more: sizes are cut to whole ones
        self.lay(self._column_split)

    # -------------------------------------------------------------------------------------------- the mouse

    def takes(self, event: events.Event) -> bool:
        """Whether a mouse event is about a split: it is carried out, and nobody else's."""
        if isinstance(event, events.MouseDown) and event.button == 1:
            self._held = self._at(int(event.screen_x), int(event.screen_y))
        elif isinstance(event, events.MouseMove) and self._held is not None:
            first = self._sides(self._held).first.region
            if self._held == "columns":
                self._place(self._held, int(event.screen_x) - first.x)
            else:
                self._place(self._held, int(event.screen_y) - first.y)
        elif isinstance(event, events.MouseUp) and self._held is not None:
            self._held = None
            remember(splits=self._parts)
            return True
        return self._held is not None

    def _at(self, x: int, y: int) -> Split | None:
        """Return the split whose line is drawn in a cell."""
        for split in (self._column_split, "left", "right"):
            if split is None or not self._sides(split).are_shown:
                continue
            first, second = (side.region for side in self._sides(split))
            at, begins = (x, second.x) if split == "columns" else (y, second.y)
            here = first.contains(x, y) or second.contains(x, y)
            if here and at in (begins, begins - 1) and self._is_line(x, y):
                return split
        return None

    def _is_line(self, x: int, y: int) -> bool:
        """Whether a line of a frame is drawn in a cell, and not a tab, a text or a curve."""
        widget, region = self._screen.get_widget_at(x, y)
        return _drawn(widget, region, x, y) in _LINE


def _drawn(widget: Widget, region: Region, x: int, y: int) -> str:
    strip = widget.render_lines(region.reset_offset)[y - region.y]
    return strip.crop(x - region.x, x - region.x + 1).text or " "
