"""The run loops as compiled functions: one for all array models of a rule, one for each small model."""

from __future__ import annotations

from hashlib import blake2b
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.arrays import ArrayStorage
from desire_tui.engine.codegen.compiler import machine
from desire_tui.engine.codegen.driver import Driver
from desire_tui.engine.codegen.pieces import Piece
from desire_tui.engine.codegen.registers import RegisterStorage
from desire_tui.engine.codegen.text import Text
from desire_tui.engine.integration import TABLEAUS

if TYPE_CHECKING:
    from desire_tui.engine.codegen.store import Compiled, Store
    from desire_tui.engine.lowered import Action


class Loops:
    """Run loops over arrays, compiled when a rule is first used."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._texts: dict[tuple[int, bool], Piece] = {}

    def get(self, rule: int, *, contiguous: bool) -> Compiled:
        """Return the loop of a rule, well compiled: it is the same for all models."""
        key = (rule, contiguous)
        piece = self._texts.get(key)
        if piece is None:
            piece = self._texts[key] = array_loop(rule, contiguous=contiguous)
        return self._store.fast(piece)

    def stiff(self) -> Compiled:
        """Return the loop of rules 9 … 16."""
        from desire_tui.engine.codegen.stiff_loop import stiff_loop

        return self._store.fast(stiff_loop())


def array_loop(rule: int, *, contiguous: bool) -> Piece:
    """Write the loop over arrays."""
    text = Text()
    tableau = TABLEAUS.get(rule)
    stages = tableau.stages if tableau is not None else 1
    storage = ArrayStorage(text, stages, machine().width, contiguous=contiguous)
    Driver(text, storage, tableau, can_hurry=False).write()
    return named(text)


def register_loop(
    passes: dict[str, tuple[Action, ...]], rule: int, states: list[int], columns: list[int]
) -> Piece:
    """Write the loop of a small model, its passes in line."""
    text = Text()
    tableau = TABLEAUS.get(rule)
    stages = tableau.stages if tableau is not None else 1
    storage = RegisterStorage(text, passes, states, columns, stages)
    Driver(text, storage, tableau, can_hurry=True).write()
    return named(text)


def named(text: Text) -> Piece:
    """Make the loop's body a function, named by its content."""
    body = text.body()
    name = "r" + blake2b(body.encode(), digest_size=10).hexdigest()
    function = f"define i32 @{name}(ptr %m, ptr %c) #0 {{\n{body}\n}}"
    return Piece(name, function, frozenset(text.needs))
