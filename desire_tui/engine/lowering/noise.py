"""`white(s)`: white noise, held for a step."""

from __future__ import annotations

from math import prod
from typing import TYPE_CHECKING

from desire_tui.engine.integration.rules import RULES
from desire_tui.engine.lowered.expressions import Load, Op, Vec
from desire_tui.engine.lowered.statements import Guard, Set, SetVec
from desire_tui.engine.lowering.lowering_context import UNKNOWN_SLOT
from desire_tui.engine.lowering.scope import UNKNOWN
from desire_tui.engine.values import DT

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.lowering.lowering_context import Extent, LoweringContext
    from desire_tui.engine.nodes.expressions import Call


def white(context: LoweringContext, node: Call, extent: Extent) -> Value:
    """Lower `white(s)`: s times a number of variance 1/DT, drawn at each step's start for each element."""
    context.reads[""] = UNKNOWN_SLOT  # every place has a number of its own
    size = context.lower(node.args[0], extent)
    rule = context.rule
    if rule is not None and rule in RULES and (rule == 0 or RULES[rule].controls_error):
        return context.report("white-under-rule" if rule else "white-without-states", node, rule=rule)
    count = 1 if UNKNOWN in extent else prod(extent)
    slot = context.scope.hidden(count)
    value = Op("div", (Op("gauss", ()), Op("sqrt", (Load(DT),))))
    where = context.where(node)
    drawn: Action = (
        SetVec(slot, count, value, where, persistent=True) if extent else Set(slot, value, where, True)
    )
    context.computed_first.append(Guard("step", (drawn,), where))
    return Op("mul", (size, Vec(slot, count) if extent else Load(slot)))
