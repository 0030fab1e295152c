"""Which of the session's graphs is shown, and which older ones lie under it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.graph.color_keys import Key
    from desire_tui.engine.graph.curve import Curve
    from desire_tui.engine.graph.model import Graph

OVERLAYS_MAX = 12


class GraphPaging:
    """The page shown; `overlay_next`: the next new one is laid over it; `ghost_next`: over that ghost."""

    def __init__(self) -> None:
        self.page: Graph | None = None
        self.under: list[Graph] = []
        self.ghost: Graph | None = None
        """The page whose curves stand pale in the background."""
        self._pale: tuple[Graph | None, list[Curve]] = None, []
        self.overlay_next = False
        self.ghost_next: Graph | None = None

    def follow(self, graph: Graph) -> bool:
        """Show a graph that was just begun; returns whether it draws other variables than the one before."""
        before = self.page
        others = before is None or (before.caption, before.frame.kind) != (graph.caption, graph.frame.kind)
        if self.overlay_next and before is not None:
            self.under = [*([] if others else self.under), before][-OVERLAYS_MAX:]
        elif others or not self.overlay_next:
            self.under = []
        self.overlay_next = False
        self.ghost, self.ghost_next = None if others else self.ghost_next, None
        self.page = graph
        return others

    def show_none(self) -> None:
        """Show no page; turning back shows the newest."""
        self.page, self.under, self.ghost = None, [], None

    def turn(self, pages: Sequence[Graph], step: int) -> bool:
        """Show an older (-1) or newer (1) page; False if there is none."""
        at = pages.index(self.page) if self.page in pages else len(pages)
        if not 0 <= at + step < len(pages):
            return False
        self.page, self.under, self.ghost = pages[at + step], [], None
        return True

    def lay_under(self, pages: Sequence[Graph], number: int | None) -> bool:
        """Lay page `number` (from 1; None: the one before) under the one shown; None again takes all away."""
        if self.under and number is None:
            self.under = []
            return True
        if number is not None:
            at = number - 1
        else:
            at = (pages.index(self.page) if self.page in pages else len(pages)) - 1
        if self.page is None or not 0 <= at < len(pages) or pages[at] is self.page:
            return False
        self.under.append(pages[at])
        return True

    def place(self, pages: Sequence[Graph]) -> str:
        """Return which page is shown if it is not the newest."""
        if self.page is None or not pages or self.page is pages[-1]:
            return ""
        return f"page {pages.index(self.page) + 1}/{len(pages)}" if self.page in pages else "old page"

    @property
    def behind(self) -> tuple[Graph, ...]:
        """The pages whose curves are drawn before those of the page shown."""
        return (*self.under, *([self.ghost] if self.ghost is not None else []))

    def with_all_under(self, page: Graph) -> Graph:
        """Return a page with the curves of those under it, and the pale ones of the ghost."""
        if not self.behind:
            return page
        from desire_tui.engine.graph.colors import GHOST

        ghost = self.ghost.curves if self.ghost is not None else []
        if self._pale[0] is not self.ghost or len(self._pale[1]) != len(
            ghost
        ):  # the same ones as long as may be
            self._pale = self.ghost, [replace(curve, color=GHOST) for curve in ghost]
        above = [curve for graph in (*self.under, page) for curve in graph.curves]
        if self.under and page.has_keys:
            from desire_tui.engine.graph.run_colors import in_run_colors

            above = in_run_colors(above)
        return replace(page, curves=[*self._pale[1], *above])

    @property
    def keys(self) -> tuple[Key, ...]:
        """The colour keys of everything that is drawn, but for a ghost."""
        if self.page is None:
            return ()
        return self.with_all_under(self.page).keys if self.under else self.page.keys

    @property
    def curves_behind(self) -> int:
        """How many curves of `with_all_under` are not the page's own."""
        return sum(len(graph.curves) for graph in self.behind)
