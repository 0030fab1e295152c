"""The run loops as compiled functions: one for all array models of a rule, one for each small model."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.jit.piece import Piece
from desire_tui.engine.codegen.loop.array_storage import ArrayStorage
from desire_tui.engine.codegen.loop.run_loop import Driver
from desire_tui.engine.codegen.loop.switched_steps import NOTHING, Watched
from desire_tui.engine.digest import blake2b
from desire_tui.engine.integration.tableaus import TABLEAUS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.codegen.loop.looks import Looks
    from desire_tui.engine.lowered.statements import Action


@functools.cache
def array_loop(rule: int, *, contiguous: bool, watched: Watched = NOTHING, share: int = 0) -> Piece:
    """Write the loop over arrays: the same for all models of a rule that watch the same.

    `share`: address of `pool.share` (`codegen.threads`), for many contiguous states.
    """
    text = IrText()
    tableau = TABLEAUS.get(rule)
    stages = tableau.stages if tableau is not None else 1
    width = machine().width
    storage = ArrayStorage(text, stages, width, contiguous=contiguous)
    if share:
        from desire_tui.engine.codegen.loop.shared_storage import SharedStorage  # few models are so large

        storage = SharedStorage(text, stages, width, share)
    Driver(text, storage, tableau, watched=watched).write()
    return named(text)


def register_loop(
    passes: Mapping[str, tuple[Action, ...]],
    rule: int,
    states: list[int],
    columns: list[int],
    vital: list[int],
    *,
    watched: Watched = NOTHING,
    looks: Looks | None = None,
) -> Piece:
    """Write the loop of a small model, its passes in line; all are slots, `vital` some of the columns'."""
    from desire_tui.engine.codegen.loop.looks import no_looks  # short runs are over before that: 1 ms
    from desire_tui.engine.codegen.loop.register_storage import RegisterStorage

    text = IrText()
    tableau = TABLEAUS.get(rule)
    stages = tableau.stages if tableau is not None else 1
    storage = RegisterStorage(text, passes, states, columns, vital, stages, looks or no_looks())
    Driver(text, storage, tableau, watched=watched).write()
    return named(text)


def named(text: IrText) -> Piece:
    """Make the loop's body a function, named by its content."""
    body = text.body()
    name = "r" + blake2b(body.encode(), digest_size=10).hexdigest()
    function = f"define i32 @{name}(ptr %m, ptr %c) #0 {{\n{body}\n}}"
    return Piece(name, function, frozenset(text.declarations))
