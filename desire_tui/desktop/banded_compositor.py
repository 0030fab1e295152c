"""Draws parts of the screen that changed far from each other each for itself, and nothing that is covered.

Textual draws the rectangle around everything that changed and sends what changed of it: a letter typed into
the text and the cursor's place in the row below made it draw all lines between them, a curve and the status
row the whole screen. And it draws and cuts the empty lines of each container behind what stands in it: five
of six lines.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, cast

from textual._compositor import ChopsUpdate, Compositor
from textual.geometry import Region

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from textual.strip import Strip

GAP_ROWS = 3
"""Parts with fewer rows between them are drawn as one: looking for what stands there takes its time, too."""


def bands(regions: Iterable[Region]) -> list[list[Region]]:
    """Return regions in groups, from the top, between which there are at least GAP_ROWS rows."""
    found: list[list[Region]] = []
    bottom = 0
    for region in sorted(regions, key=lambda region: region.y):
        if not found or region.y >= bottom + GAP_ROWS:
            found.append([])
        found[-1].append(region)
        bottom = max(bottom, region.bottom)
    return found


class BandedCompositor(Compositor):
    """Textual's compositor (pinned) without rows between those that changed and widgets that are covered."""

    def render_partial_update(self) -> ChopsUpdate | None:
        """Return what changed, None if nothing did."""
        screen = self.size.region
        regions = [part for region in self._dirty_regions if (part := region.intersection(screen))]
        self._dirty_regions.clear()
        if not regions:
            return None
        spans = list(self._regions_to_spans(regions))
        is_drawn = {y for y, _, _ in spans}.__contains__
        parts = []
        for band in bands(regions):
            crop = Region.from_union(band)
            parts.append((crop, self._render_chops(crop, is_drawn)))
        rows = list(parts[0][1])
        for crop, chops in parts[1:]:
            rows[crop.y : crop.bottom] = chops[crop.y : crop.bottom]
        return ChopsUpdate(rows, spans, [cuts[1:] for cuts in self.cuts])

    def _render_chops(
        self, crop: Region, is_rendered_line: Callable[[int], bool]
    ) -> Sequence[Mapping[int, Strip]]:
        """Return the pieces of each row by the column where they begin, each the foremost widget's."""
        chops: list[dict[int, Strip | None]] = [dict.fromkeys(cuts[:-1]) for cuts in self.cuts]
        bare = {y: self._pieces_within(y, crop) for y in crop.line_range if is_rendered_line(y)}
        """The pieces that are still missing, by row."""
        for widget, (region, clip) in self.visible_widgets.items():
            shown = region.intersection(clip)
            if not shown or not crop.overlaps(clip):
                continue
            rows = [
                y for y in shown.line_range if y in bare and any(shown.x <= x < shown.right for x in bare[y])
            ]
            if not rows:
                continue
            lines = widget.render_lines(shown.translate(-region.offset))
            for y in rows:
                cuts = [cut for cut in self.cuts[y] if shown.x <= cut <= shown.right]
                pieces = lines[y - shown.y].divide([cut - shown.x for cut in cuts[1:]])
                row = chops[y]
                for cut, piece in zip(cuts, pieces, strict=False):
                    if row.get(cut) is None:
                        row[cut] = piece
                bare[y].difference_update(cuts[:-1])
                if not bare[y]:
                    del bare[y]
        return cast("Sequence[Mapping[int, Strip]]", chops)

    def _pieces_within(self, y: int, crop: Region) -> set[int]:
        return {x for x, end in pairwise(self.cuts[y]) if x < crop.right and end > crop.x}
