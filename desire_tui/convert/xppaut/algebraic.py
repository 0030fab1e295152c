"""An algebraic equation (`0=…` with `solve y=…`) as a differential one.

Where g(x, y, t) = 0 holds at the start and dg/dt = 0 afterwards, it goes on to hold: y' is then minus the
derivative of g along the other equations, over that by y. The start is found by Newton's method from the
guess that `solve` names.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.derivative import NotDifferentiableError, derivative, negative, plus, times
from desire_tui.convert.expressions import Binary, Call, Expression, Name, substituted, with_parts
from desire_tui.convert.model import Root, State
from desire_tui.convert.xppaut.declarations import pairs

if TYPE_CHECKING:
    from desire_tui.convert.xppaut.building import Building


def algebraic(building: Building) -> None:
    """Add the equation to the model; several are refused by the caller, as XPPAUT's other equations are."""
    conditions, unknowns = building.of("algebraic"), building.of("solve")
    if len(conditions) != 1 or len(unknowns) != 1:
        return
    condition, unknown = conditions[0], unknowns[0]
    listed = pairs(unknown.right)
    if listed is None or len(listed) != 1 or building.options.is_map:
        return
    name, guess = listed[0]
    residual = _inlined(building.formula(condition.right, condition.line), building)
    y = building.spelling[name.lower()]
    try:
        slope = derivative(residual, y)
        along = derivative(residual, "t")
        for state in building.model.states:
            along = plus(along, times(derivative(residual, state.name), state.rate))
    except NotDifferentiableError as function:
        building.refuse(condition.line, f"'{function}' has no derivative here")
        building.used.extend((condition, unknown))
        return
    start = building.formula(guess or "0", unknown.line)
    rate = Binary("/", negative(along), slope)
    building.model.states.append(State(y, rate, start, condition.line.comment))
    building.model.roots.append(Root(y, residual, slope))
    building.used.extend((condition, unknown))
    building.note(
        condition.line,
        condition.line.text,
        "it is differentiated and integrated with the others; a run ends where its unknown would jump",
    )


def _inlined(expression: Expression, building: Building) -> Expression:
    """Return it without the model's functions and variables: parameters, states, t and Desire's functions."""
    functions = {function.name: function for function in building.model.functions}
    variables = {variable.name: variable.value for variable in building.model.variables}

    def inline(part: Expression) -> Expression:
        if isinstance(part, Name) and part.name in variables:
            return inline(variables[part.name])
        if isinstance(part, Call) and part.function in functions:
            function = functions[part.function]
            arguments = dict(zip(function.dummies, map(inline, part.arguments), strict=True))
            # a dummy stands for its argument, which is inlined already: other names are the model's
            marked = substituted(function.body, {dummy: Name(f"<{dummy}>") for dummy in arguments})
            return substituted(inline(marked), {f"<{dummy}>": value for dummy, value in arguments.items()})
        return with_parts(part, inline)

    return inline(expression)
