"""What the numbers that a run begins with are as functions of parameters, which the script computes.

`b = 2*a`, `x = x0`: where the script's assignments can be made again they are, else the script runs again.
The derivatives are differences of order 6: the assignments are few and smooth, and in doubles about twelve
digits of such a difference are right.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.api.settings import slot_of
from desire_tui.engine.diagnostics import DesireError

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping, Sequence

    from numpy.typing import NDArray

    from desire_tui.api.instance import Instance, Way
    from desire_tui.engine.session.prepared_run import RunStart

_STENCIL = ((1.0, 45.0 / 60.0), (2.0, -9.0 / 60.0), (3.0, 1.0 / 60.0))
_STEPS = (1e-3, 1e-5, 1e-7)
"""Relative steps: the next is taken where the script cannot be run that far away."""


class Start(NamedTuple):
    """Where a run begins: values of the parameters, and derivatives by each of them: of slots, not 0."""

    values: dict[str, float]
    derivatives: list[dict[int, float]]


def start_derivatives(
    parameters: Sequence[str],
    given: Mapping[str, float],
    instance: Instance,
    states: Collection[str],
    begin: Callable[[Mapping[str, float]], RunStart],
    way: Callable[[tuple[str, ...]], Way],
) -> Start:
    """Return derivatives of what a run begins with by `parameters`; the others are as `given`.

    `begin(values)` gives the start of a run with other values, `way(names)` how they take effect.
    DesireError: the script fails there.
    """

    def numbers(values: Mapping[str, float]) -> NDArray[np.float64]:
        start = begin(values)
        instance.prepared.begin(start)
        return instance.prepared.values.data[instance.prepared.start_slots].copy()

    known: dict[str, dict[int, float]] = {}
    computed = []
    for name in parameters:
        if name in states:
            slot = slot_of(name, instance)
            assert slot is not None
            known[name] = {slot: 1.0}
            continue
        names = tuple(n for n in dict.fromkeys((*given, name)) if n not in states)
        found_way = way(names)
        if found_way.slots is not None and found_way.follow is None:
            known[name] = {found_way.slots[names.index(name)]: 1.0}
        else:
            computed.append(name)
    if computed or not all(name in given for name in parameters):
        numbers(given)
    here = {name: _value(name, given, instance) for name in parameters}
    for name in computed:
        found = _difference(lambda value, n=name: numbers({**given, n: value}), here[name])  # type: ignore[misc]
        slots = instance.prepared.start_slots
        known[name] = {int(slots[k]): float(found[k]) for k in np.flatnonzero(found)}
    if computed:
        numbers(given)
    return Start(here, [known[name] for name in parameters])


def _value(name: str, given: Mapping[str, float], instance: Instance) -> float:
    if name in given:
        return given[name]
    slot = slot_of(name, instance)
    return 0.0 if slot is None else float(instance.prepared.values.data[slot])


def _difference(at: Callable[[float], NDArray[np.float64]], value: float) -> NDArray[np.float64]:
    for relative in _STEPS:
        h = relative * (abs(value) or 1.0)
        try:
            return sum(
                (weight / h * (at(value + k * h) - at(value - k * h)) for k, weight in _STENCIL),
                start=np.zeros(1),
            )
        except DesireError:
            if relative == _STEPS[-1]:
                raise
    raise AssertionError
