"""CLEARN, PLEARN and INTP as calls of functions that pieces carry with them (`learning_rules`)."""

from __future__ import annotations

import functools
from importlib.resources import files
from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.codegen.vector import learning_rules, products

if TYPE_CHECKING:
    from desire_tui.engine.codegen.vector.operands import ArrayOperands
    from desire_tui.engine.lowered.statements import LearningStep

_TEXT = files(__package__).joinpath("learning_rules.py").read_bytes()
"""Read now, when the module is: files may change under a process that lives for days."""


def write_learning(statements: ArrayOperands, action: LearningStep) -> None:
    """Write one learning step as a call."""
    text = statements.text
    rows, cols = action.out_count, action.in_count
    rate = statements.scalars.value(action.rate)
    out, weights, x = (statements.at(s) for s in (action.out_slot, action.weights_slot, action.in_slot))
    arrays, sizes = f"ptr {out}, ptr {weights}, ptr {x}", f"i64 {rows}, i64 {cols}, double {rate}"
    text.declarations.add(_functions())
    match action.kind:
        case "CLEARN":
            criterion = "0.0" if action.criterion is None else statements.scalars.value(action.criterion)
            h = "ptr null, i64 0" if action.h_slot is None else f"ptr {statements.at(action.h_slot)}, i64 1"
            rest = f"{sizes}, double {criterion}, i64 {int(action.fast)}"
            found = text.op(f"call double @learning_compete({arrays}, {h}, {rest})")
            if action.full_slot is not None:
                text.do(f"store double {found}, ptr {statements.at(action.full_slot)}")
        case "INTP":
            text.do(f"call void @learning_match_templates({arrays}, {sizes})")
        case "PLEARN":
            text.declarations.add(products.matrix_times_vector())
            text.do(f"call void @matvec(ptr {weights}, ptr {x}, ptr {out}, i64 {rows}, i64 {cols})")
            rest = f"ptr {statements.temp(cols)}"
            text.do(f"call void @learning_learn_components({arrays}, {rest}, {sizes})")
        case _:
            assert_never(action.kind)


@functools.cache
def _functions() -> str:
    # imported here: few programs learn
    from desire_tui.engine.codegen.plain_python.program import Module, write_program
    from desire_tui.engine.codegen.plain_python.surroundings import Outside

    module = Module(_TEXT, vars(learning_rules))
    return write_program([module], Outside({}), "learning_", frozenset())
