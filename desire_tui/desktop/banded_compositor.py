"""Draws parts of the screen that changed far from each other each for itself.

Textual draws the rectangle around everything that changed and sends what changed of it: a letter typed into
the text and the cursor's place in the row below made it draw all lines between them, a curve and the status
row the whole screen.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual._compositor import ChopsUpdate, Compositor
from textual.geometry import Region

if TYPE_CHECKING:
    from collections.abc import Iterable

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
    """Textual's compositor (pinned), whose partial updates draw no rows between those that changed."""

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
