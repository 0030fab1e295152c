"""Whether the graph's window follows its curves, and what is said of those that leave the program's scale."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.panes.zoom_window import Window

if TYPE_CHECKING:
    from desire_tui.engine.graph.fit import Extent
    from desire_tui.panes.graph_paging import GraphPaging


class CurveFit:
    """How far the curves of a page reach, as they grow."""

    def __init__(self) -> None:
        self.wanted: bool | None = None
        """Whether the user wants the window that holds all curves; None: as the program says."""
        self._extent: Extent | None = None
        self._extent_of: tuple[object, ...] = ()

    @property
    def is_on(self) -> bool:
        """Whether the window is the one that holds all curves."""
        if self.wanted is not None or self._extent is None:
            return bool(self.wanted)
        return self._extent.is_fitted

    @property
    def notice(self) -> str:
        """What is said of curves that leave the program's scale."""
        if self._extent is None or self.is_on:
            return ""
        from desire_tui.engine.graph.fit import notice

        return notice(self._extent, "Shift+F7 fits")

    def window(self, paging: GraphPaging, window: Window) -> Window:
        """Return the window for what there is of the curves now; `window` if it is not to follow them."""
        page = paging.page
        if page is None or page.frame.kind == "picture":
            self._extent, self._extent_of = None, ()
            return window
        shown = (page, page.axes, page.erased, *paging.behind)
        if self._extent is None or self._extent_of != shown:
            from desire_tui.engine.graph.fit import Extent

            self._extent, self._extent_of = Extent(paging.with_all_under(page)), shown
        before = self.is_on
        self._extent.update()
        if self.is_on:
            return Window(*self._extent.view())
        return Window() if before else window
