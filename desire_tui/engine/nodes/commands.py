"""Commands to the desk, and statements that set up, start or work up a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.nodes.record import Node, node

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Expr


Word = Literal[
    "else", "proceed", "end if", "end event", "next", "end while", "repeat", "exit", "end", "STOP", "go",
    "reset", "clear", "time", "trace", "DYNAMIC", "OUT", "step", "JACOBIAN",
    "erun", "run", "bye", "new", "NEW", "list", "list+", "ed", "edit", "auto", "reload", "keep+",
]  # fmt: skip


@node
class Simple(Node):
    """A statement that is its keyword, aliases replaced (`zz` → `erun`, `rld` → `reload`, `quit` → `bye`)."""

    word: Word
    start: int = 0
    end: int = 0


@node
class FileCommand(Node):
    """`keep 'f'`, `load 'f'`, `snapshot 'f'`, `notebook 'f'|on|off`, `help x`, `sh …`, `compare …`.

    Also those that name lines of the program: `edit 210-240,260`, `list 300`, `note #210-230`.
    """

    word: Literal[
        "keep", "keep+", "load", "snapshot", "notebook", "help", "sh", "compare",
        "list", "list+", "ed", "edit", "auto", "note",
    ]  # fmt: skip
    argument: str | None
    start: int = 0
    end: int = 0


@node
class Irule(Node):
    """`irule n`; bare prints the current rule."""

    rule: Expr | None
    start: int = 0
    end: int = 0


@node
class Seed(Node):
    """`SEED n`."""

    value: Expr
    start: int = 0
    end: int = 0


@node
class Drun(Node):
    """`drun`, `drun L`, `drun *` (`star`), `drunr …` (`reset`)."""

    label: str | None
    reset: bool
    star: bool
    start: int = 0
    end: int = 0


@node
class Fft(Node):
    """`FFT F, n, x, y`."""

    kind: Literal["F", "I", "R", "C"]
    args: tuple[Expr, ...]
    start: int = 0
    end: int = 0
