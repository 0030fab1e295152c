"""What a run that ended by an inf or nan says: the smallest part of the model that made it, underlined."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.lowered.expressions import Op
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Set, SetVec
from desire_tui.engine.lowered.walk import walk_values
from desire_tui.engine.lowering.operators import OPERATIONS
from desire_tui.engine.nodes.expressions import Binary, Call, Unary
from desire_tui.engine.source import Source, Span
from desire_tui.engine.syntax.parse import parse_command

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.reference.culprit import Culprit
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.runtime.simulator import Simulator
    from desire_tui.engine.values import Values

KEYS = {
    "not-finite": "not-finite-part",
    "solver-corrector": "solver-corrector-part",
    "solver-error-test": "solver-derivative-part",
    "solver-gave-up": "solver-derivative-part",
    "solver-derivative": "solver-derivative-part",
}
"""Messages about runs that may have met an inf or nan, each with the one that says of what."""
_SHOWN_MOST = 40
_ARC = "the argument of {name} must stay within -1 … 1"
_POSITIVE = "keep the argument above 0, by {name}(max(x, 1E-30)) or a `term`"


def with_part(
    error: DesireError, simulator: Simulator, segment: Segment, plan: RunPlan, model: Model, values: Values
) -> DesireError:
    """Return an error that names the part of an expression; the error itself where none can be found."""
    problem, start = error.diagnostics[0], simulator.block_start
    if problem.key not in KEYS or start is None:
        return error
    from desire_tui.engine.reference.culprit import find_culprit

    try:
        found = find_culprit(start, segment, plan.rule, model, values)
    except DesireError:
        return error
    if found is None:
        return error
    span = _span(found, segment, values)
    text = " ".join(segment.source.text[span.start : span.end].split())
    what, advice = described(found.part.name, found.numbers)
    facts = {
        **problem.facts,
        "part": text if len(text) <= _SHOWN_MOST else f"{text[: _SHOWN_MOST - 1]}…",
        "cause": what, "advice": advice, "t": -found.t if plan.backward else found.t,
    }  # fmt: skip
    return DesireError(replace(problem, key=KEYS[problem.key], span=span, source=segment.source, facts=facts))


def described(name: str, numbers: tuple[float, ...]) -> tuple[str, str]:
    """Return what an operation was asked for, and what helps."""
    x = numbers[0] if numbers else 0.0
    shown = f"{x:.6g}"
    if name in {"div", "recip"} and numbers[-1] == 0.0:
        return f"{'1' if name == 'recip' else shown} divided by 0", "see that the divisor cannot be 0"
    if name in {"ln", "log"} and x <= 0.0:
        return f"the logarithm of {shown}", _POSITIVE.format(name=name)
    if name == "sqrt" and x < 0.0:
        return f"the root of {shown}", "keep the argument at 0 or above, by sqrt(lim(x)) or a `term`"
    if name in {"asin", "acos"}:
        return f"{name} of {shown}", _ARC.format(name=name)
    if name in {"pow", "ipow"} and x <= 0.0:
        return f"a power {numbers[1]:g} of {shown}", "keep the base above 0"
    if any(map(isnan, numbers)):
        return "undefined", "look at what it is computed from"
    return (
        "too large for a number",
        "where the solution grows without bound, stop the run with term; else take a smaller DT",
    )


def _span(found: Culprit, segment: Segment, values: Values) -> Span:
    """Return the place of the part in the source, of its statement where the two differ in form."""
    action = found.action
    whole: Span = action.where.span
    named = isinstance(action, Deriv | DerivVec) or (
        isinstance(action, Set | SetVec) and any(q.slot == action.slot for q in values)
    )
    placed, problems = parse_command(Source(segment.source.text[whole.start : whole.end]))
    value: Expr | None = getattr(placed[0].node, "value", None) if len(placed) == 1 else None
    if problems or value is None or not named:
        return whole
    part = _part(value, found.whole, found.part)
    return Span(whole.start + part.start, whole.start + part.end)


def _part(node: Expr, value: Value, part: Op) -> Expr:
    """Return the smallest part of an expression's text that holds an operation."""
    if value is not part:
        for inner, of_it in _pairs(node, value):
            if any(one is part for one in walk_values(of_it)):
                return _part(inner, of_it, part)
    return node


def _pairs(node: Expr, value: Value) -> list[tuple[Expr, Value]]:
    if isinstance(node, Unary) and node.op == "+":
        return [(node.operand, value)]
    if not isinstance(value, Op):
        return []
    if isinstance(node, Unary) and value.name == "neg":
        return [(node.operand, value.args[0])]
    if isinstance(node, Binary) and value.name in {OPERATIONS.get(node.op, "pow"), "ipow"}:
        return list(zip((node.left, node.right), value.args, strict=False))
    if isinstance(node, Call) and value.name == node.name:
        return list(zip(node.args, value.args, strict=False))
    return []
