"""The DYNAMIC segment of a converted program."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expression_text import expression_text, number_text
from desire_tui.convert.expressions import (
    STEP,
    ZERO,
    Binary,
    Choice,
    Expression,
    Name,
    Relation,
    number,
    total,
)
from desire_tui.convert.layout import broken, comment_lines, joined
from desire_tui.convert.model import Network
from desire_tui.convert.network_part import network_segment

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from desire_tui.convert.model import MarkovProcess, Model, Quantity
    from desire_tui.convert.names import NameTable

SHOWN_MOST = 12
"""How many curves are drawn of a model that does not say which."""


def segment_lines(model: Model, names: NameTable, next_names: Mapping[str, str], ended: str) -> Iterator[str]:
    """Yield the lines behind DYNAMIC.

    `next_names`: what holds the next value of each state of a map; `ended`: what an event sets that ends the
    run, "" if there is none.
    """
    yield from joined(f"{names(state)} = {later}" for state, later in next_names.items())
    for noise in model.noises:
        yield from comment_lines(noise.comment)
        yield f"{names(noise.name)} = white({expression_text(noise.value, names)})"
    for variable in model.variables:
        yield from comment_lines(variable.comment)
        if isinstance(variable, Network):
            yield from network_segment(variable, names)
        else:
            yield from _assignment(variable, names)
    for state in model.states:
        yield from comment_lines(state.comment)
        target = next_names.get(state.name) or f"d/dt {names(state.name)}"
        yield from broken(f"{target} = {expression_text(state.rate, names)}")
    for shown in model.shown:
        yield from comment_lines(shown.comment)
        yield from _assignment(shown, names)
    yield from _display(model, names)
    yield from _ends(model, names, ended)
    if model.markov:
        yield "step"
        for process in model.markov:
            yield from _markov(process, names)
    yield from _events(model, names, ended)


def _assignment(quantity: Quantity, names: NameTable) -> Iterator[str]:
    return broken(f"{names(quantity.name)} = {expression_text(quantity.value, names)}")


def displayed(model: Model) -> list[str]:
    """Return the quantities that are drawn: those asked for, else states and what is shown beside them."""
    if model.settings.ordinates:
        return list(model.settings.ordinates)
    everything = [state.name for state in model.states] + [shown.name for shown in model.shown]
    return everything[:SHOWN_MOST] or [variable.name for variable in model.variables][:SHOWN_MOST]


def _display(model: Model, names: NameTable) -> Iterator[str]:
    curves = [names(name) for name in displayed(model)]
    if model.settings.abscissa is not None:
        yield f"dispxy {names(model.settings.abscissa)}, {', '.join(curves)}"
    elif curves:
        yield from broken(f"dispt {', '.join(curves)}")


def _ends(model: Model, names: NameTable, ended: str) -> Iterator[str]:
    if ended:
        yield f"term {ended}"
    bound = model.settings.bound
    if bound is not None:
        yield from joined(f"term abs({names(state.name)}) - {number_text(bound)}" for state in model.states)


def _markov(process: MarkovProcess, names: NameTable) -> Iterator[str]:
    """Yield the step of a chain: in DT it goes from i to k with the probability rate·DT."""
    draw = names.fresh(f"draw_{names(process.name)}")
    yield from comment_lines(process.comment)
    yield f"{draw} = (1 + ran())/2"
    yield from broken(f"{names(process.name)} = {expression_text(_next_state(process, draw), names)}")


def _next_state(process: MarkovProcess, draw: str) -> Expression:
    state: Expression = Name(process.name)
    result: Expression = state
    for i in reversed(range(len(process.rates))):
        ways = [k for k, rate in enumerate(process.rates[i]) if k != i and rate != ZERO]
        goes: Expression = number(i)
        for count in range(len(ways), 0, -1):
            rate = total([process.rates[i][k] for k in ways[:count]])
            threshold = Binary("*", rate, STEP)
            goes = Choice(Relation("<", Name(draw), threshold), number(ways[count - 1]), goes)
        result = Choice(Relation("=", state, number(i)), goes, result)
    return result


def _events(model: Model, names: NameTable, ended: str) -> Iterator[str]:
    for event in model.events:
        if event.condition is not None:
            yield from comment_lines(event.comment)
            yield from broken(f"event {expression_text(event.condition, names)}")
            block = [f"{names(one.name)} = {expression_text(one.value, names)}" for one in event.assignments]
            yield from joined([*block, f"{ended} = 1"] if event.ends_run else block)
