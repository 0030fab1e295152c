"""Cuts a pass into compiled pieces of a few dozen statements.

Code shape matters more than the optimiser's level: one function with 1,401 equations costs LLVM ten times as
much as fourteen with 100. A piece is kept by its text, so a one-line edit compiles one piece.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.cells import MemoryCells
from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.jit.piece import Piece
from desire_tui.engine.codegen.scalar.rerolling import Rolled
from desire_tui.engine.codegen.vector.array_statements import ArrayStatements
from desire_tui.engine.digest import blake2b
from desire_tui.engine.lowered.walk import walk_actions

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from desire_tui.engine.lowered.statements import Action

STATEMENTS_MOST = 64
_ROLLED_WEIGHT = 8  # a loop and its rest cost about as much to compile


def cut(
    actions: Iterable[Action | Rolled], alone: Callable[[Rolled], bool] = lambda _: False
) -> Iterator[list[Action | Rolled]]:
    """Group statements that stand one after the other; an `if` with its body is never cut.

    `alone` says which rolled-up ones are a group of their own.
    """
    group: list[Action | Rolled] = []
    size = 0
    for action in actions:
        weight = STATEMENTS_MOST if isinstance(action, Rolled) and alone(action) else _weight(action)
        if group and size + weight > STATEMENTS_MOST:
            yield group
            group, size = [], 0
        group.append(action)
        size += weight
    if group:
        yield group


def _weight(action: Action | Rolled) -> int:
    if isinstance(action, Rolled):
        return _ROLLED_WEIGHT
    return sum(1 for _ in walk_actions((action,)))


def write(actions: Sequence[Action | Rolled]) -> Piece:
    """Write one piece."""
    text = IrText()
    statements = ArrayStatements(text, MemoryCells(text), machine().width, _share)
    statements.write(actions)
    return finished(text, statements.temps)


def finished(text: IrText, temps: int = 0) -> Piece:
    """Return a piece with this text, `void NAME(ptr %v, ptr %dx, ptr %c, ptr %d)`; `temps` as in `Piece`.

    These are the values, the derivatives, the context, the piece's data. The text may use `%m` and `%random`.
    """
    body = "\n".join(text.lines)
    start = ["entry:", *text.allocas]
    if "ptr %m," in body or "ptr %random" in body:
        start.append("%m = load ptr, ptr %c")
    if "ptr %random" in body:
        start.append(f"%random.at = getelementptr i8, ptr %m, i64 {_RANDOM_OFFSET}")
        start.append("%random = load ptr, ptr %random.at")
    whole = "\n".join((*start, body, "ret void"))
    name = "p" + blake2b(whole.encode(), digest_size=10).hexdigest()
    arguments = "ptr noalias %v, ptr noalias %dx, ptr noalias %c, ptr noalias %d"
    function = f"define void @{name}({arguments}) #0 {{\n{whole}\n}}"
    return Piece(name, function, frozenset(text.declarations), temps)


def _share() -> int:
    from desire_tui.engine.codegen.threads.pool import thread_pool  # few models are so large

    return thread_pool().share


def _random_offset() -> int:
    from desire_tui.engine.runtime.run_memory import RunMemory

    return int(RunMemory.random.offset)


_RANDOM_OFFSET = _random_offset()
