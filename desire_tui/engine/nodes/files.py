"""Statements that read and write: `data` lines, the console, files, the notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.nodes.record import Node, node

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Expr, Target


@node
class Data(Node):
    """`data 1, 2*3; 4`."""

    items: tuple[Expr, ...]
    start: int = 0
    end: int = 0


@node
class LoadData(Node):
    """`data 'measured.csv'` [X]: each column of a file becomes a table for `func1`, by its name."""

    file: str
    start: int = 0
    end: int = 0


@node
class Read(Node):
    """`read a, B, c[2]`."""

    targets: tuple[Target, ...]
    start: int = 0
    end: int = 0


@node
class Restore(Node):
    """`restore`, `restore label`, `restore 210`."""

    target: str | None
    start: int = 0
    end: int = 0


@node
class Input(Node):
    """`input x, A` (channel None: the console) or `input #n, x`."""

    channel: Expr | None
    targets: tuple[Target, ...]
    start: int = 0
    end: int = 0


@node
class WriteItem(Node):
    """An item of `write` with the separator behind it: `,` (tab), `;` (nothing) or `` (the end).

    `form`: `` plain, `$` one character, `%` octal, `%%` hexadecimal. Strings are `Text`.
    """

    value: Expr
    form: Literal["", "$", "%", "%%"]
    separator: Literal["", ",", ";"]
    start: int = 0
    end: int = 0


@node
class Write(Node):
    """`write …`, `write #n, …`, `write ##n, …` (`raw`)."""

    channel: Expr | None
    raw: bool
    items: tuple[WriteItem, ...]
    start: int = 0
    end: int = 0


@node
class Connect(Node):
    """`connect 'f' as input n`."""

    file: Expr
    mode: Literal["input", "output"]
    channel: Expr
    start: int = 0
    end: int = 0


@node
class Disconnect(Node):
    """`disconnect n, m`."""

    channels: tuple[Expr, ...]
    start: int = 0
    end: int = 0


@node
class Dump(Node):
    """`dump`, `dump #n`, `dump run` [X]."""

    channel: Expr | None
    what: Literal["all", "run"]
    start: int = 0
    end: int = 0


@node
class Note(Node):
    """`note 'text'; x`: into the notebook, items as in `write`."""

    items: tuple[WriteItem, ...]
    start: int = 0
    end: int = 0
