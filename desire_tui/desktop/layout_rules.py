"""Which panes are shown at a terminal's size, and how they stand to each other. No widget: only the rules."""

from __future__ import annotations

from typing import Literal

from desire_tui.engine.data_classes import dataclass

Pane = Literal["editor", "command", "graph", "side"]
Order = Literal["columns", "rows", "one"]

SMALLEST = (16, 3)
"""Columns and rows below which nothing useful can be shown."""
ONE_BELOW = (30, 10)
"""Below, one pane fills the screen: the one that has the focus."""
FEW_BELOW = (60, 16)
"""Below, the command line stands under the graph; editor and side pane are shown alone."""
TALL_BELOW, TALL_FROM = 72, 30
"""Narrower than the one and at least as high as the other: graph below the editor, not beside it."""
SIDE_FROM = (120, 40)
"""From this size on the side pane is shown without being asked for."""
FRAMED_FROM = (100, 28)
"""From this size on each pane has a frame of its own; below, lines between panes take no row from them."""
EVERYTHING: frozenset[Pane] = frozenset(("editor", "command", "graph", "side"))


@dataclass(frozen=True, slots=True)
class Arrangement:
    """What is shown, and in which order: two columns, one column, or a pane alone."""

    panes: frozenset[Pane]
    order: Order = "columns"
    too_small: bool = False
    framed: bool = False
    """Whether each pane has a frame."""

    @property
    def column_split(self) -> Literal["columns", "rows"] | None:
        """How the columns of editor and graph stand to each other; None where they are not both shown."""
        if self.order == "one" or "editor" not in self.panes:
            return None
        return self.order


def arrange(
    width: int, height: int, *, focused: Pane, maximized: Pane | None = None, side: bool | None = None
) -> Arrangement:
    """Return the arrangement for a terminal of `width` × `height`.

    `focused`: the pane that has the focus. `maximized`: a pane the user maximized. `side`: whether the user
    opened or closed the side pane, None for neither.
    """
    if width < SMALLEST[0] or height < SMALLEST[1]:
        return Arrangement(frozenset(), "one", too_small=True)
    if maximized is not None:
        return Arrangement(frozenset((maximized,)), "one")
    if width < ONE_BELOW[0] or height < ONE_BELOW[1]:
        return Arrangement(frozenset((focused,)), "one")
    if width < FEW_BELOW[0] or height < FEW_BELOW[1]:
        if focused in ("editor", "side"):
            return Arrangement(frozenset((focused,)), "one")
        return Arrangement(frozenset(("graph", "command")), "rows")
    wanted = width >= SIDE_FROM[0] and height >= SIDE_FROM[1] if side is None else side
    panes = EVERYTHING if wanted else EVERYTHING - {"side"}
    tall = width < TALL_BELOW and height >= TALL_FROM
    framed = width >= FRAMED_FROM[0] and height >= FRAMED_FROM[1]
    return Arrangement(panes, "rows" if tall else "columns", framed=framed)
