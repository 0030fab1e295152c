"""Statements that draw, and requests for samples of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.nodes.record import Node, node

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Expr, Target


@node
class Display(Node):
    """`display 2`, `display N14`, `display logy`. `mode` is `0 1 2`, a letter or a word."""

    mode: Literal[
        "0", "1", "2", "A", "B", "C", "F", "N", "Q", "R", "W", "Y",
        "fit", "logx", "logy", "loglog", "linear", "equal",
    ]  # fmt: skip
    args: tuple[Expr, ...]
    start: int = 0
    end: int = 0


@node
class GraphText(Node):
    """`title 'x'`, `xlabel 'x'`, `ylabel 'x'`, `units 'x m, t s'`."""

    part: Literal["title", "xlabel", "ylabel", "units"]
    text: str
    start: int = 0
    end: int = 0


@node
class Plot(Node):
    """`plot x, y [, c]`, `plot z [, c]`."""

    args: tuple[Expr, ...]
    start: int = 0
    end: int = 0


@node
class Show(Node):
    """`SHOW A, ncol`."""

    name: str
    columns: Expr | None
    start: int = 0
    end: int = 0


@node
class ShowArea(Node):
    """`SHOW` and `SHOW *`, which start the original's picture area; the second shows size, not colour."""

    by_size: bool
    start: int = 0
    end: int = 0


@node
class Request(Node):
    """`dispt`, `dispxy`, `DISPXY`, `type [#n,]`, `stash`, `recover`."""

    kind: Literal["dispt", "dispxy", "DISPXY", "type", "stash", "recover"]
    channel: Expr | None
    items: tuple[Target, ...]
    start: int = 0
    end: int = 0
