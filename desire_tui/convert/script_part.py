"""The script of a converted program: functions, parameters, tables, initial values, presets, the run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expression_text import condition_text, expression_text, number_text
from desire_tui.convert.expressions import Binary, Name
from desire_tui.convert.layout import broken, comment_lines, joined
from desire_tui.convert.model import Network, Quantity, Table
from desire_tui.convert.network_part import network_script
from desire_tui.convert.ordering import in_order, needed_by

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from desire_tui.convert.model import Function, Model, Preset
    from desire_tui.convert.names import NameTable

NEWTON_STEPS = 50
_BEYOND = 1e6
"""How far a table's outer lines are drawn out, in its widths: `func1` is constant beyond its ends."""


def script_lines(model: Model, names: NameTable, next_names: Mapping[str, str]) -> Iterator[str]:
    """Yield the script's lines. CircularError.

    `next_names`: what holds the next value of each state of a map.
    """
    for function in model.functions:
        yield from comment_lines(function.comment)
        yield from broken(_function(function, names))
    for preset in model.presets:
        yield from comment_lines(preset.comment)
        yield f"PROCEDURE {names(preset.name)} -- call {names(preset.name)}"
        yield from (f"  {line}" for line in joined(_assignments(preset, names)))
        yield "end"
    yield from _beginnings(model, names)
    for root in model.roots:
        step = Binary("-", Name(root.name), Binary("/", root.residual, root.slope))
        count = names.fresh("i")
        yield f"for {count} = 1 to {NEWTON_STEPS}"
        yield from broken(f"  {names(root.name)} = {expression_text(step, names)}")
        yield "next"
    tables = {table.name: table for table in model.tables}
    for variable in model.variables:
        if isinstance(variable, Network):
            yield from network_script(variable, tables, names)
    for event in model.events:
        if event.at_start is not None:
            yield f"if {condition_text(event.at_start, names)} then"
            yield from joined(
                f"{names(one.name)} = {expression_text(one.value, names)}" for one in event.assignments
            )
            yield "proceed"
    yield from joined(f"{later} = {names(state)}" for state, later in next_names.items())


def _function(function: Function, names: NameTable) -> str:
    dummies = {dummy: f"{dummy.strip('_') or 'x'}$" for dummy in function.dummies}
    body = expression_text(function.body, lambda name: dummies.get(name) or names(name))
    return f"FUNCTION {names(function.name)}({', '.join(dummies.values())}) = {body}"


def _assignments(preset: Preset, names: NameTable) -> Iterator[str]:
    for one in preset.values:
        yield f"{names(one.name)} = {expression_text(one.value, names)}"


def beginnings(model: Model) -> list[Quantity | Table]:
    """Return what has a value before the run, each behind what it is computed from. CircularError.

    Those are parameters, tables and starts of states; variables only where one of these needs them.
    """
    starts = [Quantity(state.name, state.initial) for state in model.states]
    processes = [Quantity(one.name, one.initial, one.comment) for one in model.markov]
    always: list[Quantity | Table] = [*model.parameters, *model.held, *model.tables, *processes, *starts]
    functions = {function.name: function for function in model.functions}
    known: dict[str, Quantity | Table] = {one.name: one for one in [*always, *model.variables]}
    needs: dict[str, set[str]] = {}
    rest = [one.name for one in always]
    for event in model.events:
        if event.at_start is not None:
            for formula in (event.at_start, *(one.value for one in event.assignments)):
                rest.extend(needed_by(formula, functions))
    while rest:
        name = rest.pop()
        if name in needs or name not in known:
            continue
        one = known[name]
        value = one.formula if isinstance(one, Table) else one.value
        needs[name] = set() if value is None else needed_by(value, functions)
        rest.extend(needs[name])
    placed = {one.name: needs[one.name] for one in [*always, *model.variables] if one.name in needs}
    return [known[name] for name in in_order(placed)]


def _beginnings(model: Model, names: NameTable) -> Iterator[str]:
    waiting: list[str] = []
    states = {state.name for state in model.states}
    group = False
    for one in beginnings(model):
        is_state = one.name in states
        if isinstance(one, Table) or one.comment or is_state != group:
            yield from joined(waiting)
            waiting = []
            yield from comment_lines(one.comment)
        group = is_state
        if isinstance(one, Table):
            yield from _table(one, names)
        else:
            waiting.append(f"{names(one.name)} = {expression_text(one.value, names)}")
    yield from joined(waiting)


def _table(table: Table, names: NameTable) -> Iterator[str]:
    """Yield lines that fill an array with breakpoints and values, one more at each end far outside."""
    name, count = names(table.name), len(table.xs)
    size = count + 2
    far = _BEYOND * (table.xs[-1] - table.xs[0])
    yield f"ARRAY {name}[{2 * size}]"
    if table.formula is None:
        numbers = [*table.xs, *table.ys]
        xs, ys = [number_text(x) for x in numbers[:count]], [number_text(y) for y in numbers[count:]]
        for offset, values in ((1, xs), (size + 1, ys)):
            yield from broken("data " + ", ".join(values))
            yield f"for i_{name} = 1 to {count} | read {name}[{offset} + i_{name}] | next"
    else:
        variable = f"x_{name}"
        step = (table.xs[-1] - table.xs[0]) / (count - 1)
        value = expression_text(table.formula, lambda one: variable if one == table.variable else names(one))
        yield f"for i_{name} = 1 to {count}"
        yield f"  {variable} = {number_text(table.xs[0])} + {number_text(step)}*(i_{name} - 1)"
        yield f"  {name}[1 + i_{name}] = {variable}"
        yield from broken(f"  {name}[{size + 1} + i_{name}] = {value}")
        yield "next"
    for end, inner, next_, x in ((1, 2, 3, -far), (size, size - 1, size - 2, far)):
        # the straight line through the two outer points, to a point far outside
        slope = f"({name}[{size + inner}] - {name}[{size + next_}])/({name}[{inner}] - {name}[{next_}])"
        yield f"{name}[{end}] = {name}[{inner}] {'+' if x > 0 else '-'} {number_text(far)}"
        yield from broken(
            f"{name}[{size + end}] = {name}[{size + inner}] + ({name}[{end}] - {name}[{inner}])*{slope}"
        )
