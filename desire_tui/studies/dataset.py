"""The result of a study as an xarray Dataset: dimensions are what varies, variables what is kept."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from desire_tui.studies.design import RUN
from desire_tui.studies.texts import whole

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from desire_tui.studies.keep import Kept
    from desire_tui.studies.plan import Plan
    from desire_tui.studies.task import Failures

ERROR = "error"
"""Of each run the number of the error it ended with; 0: none; NOT_MADE: it was not made."""
NOT_MADE = -2
_TIME = "t"
ERROR_NOTE = "number of the error that a run ended with; 0: none, -2: not made"


class Layout(NamedTuple):
    """A variable of the result: what is kept, its name, its dimensions, their sizes."""

    item: Kept
    name: str
    dimensions: tuple[str, ...]
    shape: tuple[int, ...]


def layouts(plan: Plan) -> list[Layout]:
    """Return the variables of a study; those over times have a dimension more."""
    own = tuple(axis.name for axis in plan.design.axes)
    names = time_names(plan)
    return [
        Layout(item, item.label, (*own, names[item.times]), (*plan.design.shape, len(item.times)))
        if item.kind == "at" and not item.single
        else Layout(item, item.label, own, plan.design.shape)
        for item in plan.kept.items
    ]


def check_names(plan: Plan) -> None:
    """DesireError 510: two things of the result would have one name."""
    own = [axis.name for axis in plan.design.axes if axis.values is None]
    for name in plan.design.names:
        if name in (ERROR, *own):
            raise whole(name, "what varies").wrong(
                f"'{name}' is what the results call something else", "call it otherwise in the program"
            )
    for item in plan.kept.items:
        if item.label in (ERROR, *own, *plan.design.names):
            told = "varies" if item.label in plan.design.names else "is what the results call something else"
            place = whole(plan.kept.text, "--keep")
            raise place._replace(text=item.label, at=plan.kept.text.find(item.label)).wrong(
                f"'{item.label}' {told}", f"another name for what is kept: {item.label}_kept = …"
            )


def time_names(plan: Plan) -> dict[tuple[float, ...], str]:
    """Return the dimensions over times: `t`, `t_2`, … for different lists of times."""
    found: dict[tuple[float, ...], str] = {}
    taken = {axis.name for axis in plan.design.axes} | set(plan.design.names)
    taken |= {item.label for item in plan.kept.items}
    for item in plan.kept.items:
        if item.kind == "at" and not item.single and item.times not in found:
            number = len(found) + 1
            name = _TIME if number == 1 else f"{_TIME}_{number}"
            while name in taken:
                number += 1
                name = f"{_TIME}_{number}"
            taken.add(name)
            found[item.times] = name
    return found


def scales(plan: Plan) -> dict[str, NDArray[np.float64]]:
    """Return the numbers along those dimensions that have some, by their names."""
    found = {axis.name: axis.values for axis in plan.design.axes if axis.values is not None}
    return found | {name: np.array(times) for times, name in time_names(plan).items()}


def attributes(plan: Plan, failures: Failures) -> dict[str, Any]:
    """Return what the result says of itself, in plain texts and numbers."""
    from desire_tui.version import __version__

    told = {
        "program": plan.task.name,
        "source": f"desire-tui {__version__}",
        "keep": plan.task.keep,
        "design": plan.design.method,
        "runs": plan.runs,
        "failed": failures.count,
        "failures": "\n".join(failures.lines()),
    }
    if plan.task.seed is not None:
        told["seed"] = plan.task.seed
    told |= {f"set {name}": value for name, value in plan.task.fixed}
    return told


def dataset(
    plan: Plan, numbers: Mapping[str, NDArray[np.float64]], errors: NDArray[np.int16], failures: Failures
) -> Any:
    """Return a Dataset over arrays that hold what is kept, by the variables' names."""
    import xarray as xr

    variables: dict[str, Any] = {
        layout.name: (layout.dimensions, numbers[layout.name]) for layout in layouts(plan)
    }
    dimensions = tuple(axis.name for axis in plan.design.axes)
    variables[ERROR] = (dimensions, errors.reshape(plan.design.shape), {"long_name": ERROR_NOTE})
    along = {name: (name, numbers) for name, numbers in scales(plan).items()}
    drawn = {name: (RUN, numbers) for name, numbers in plan.design.drawn().items()}
    return xr.Dataset(variables, along | drawn, attributes(plan, failures))


def by_variable(plan: Plan, numbers: NDArray[np.float64]) -> Iterator[tuple[Layout, NDArray[np.float64]]]:
    """Yield the variables with their part of some runs' numbers, (runs, …)."""
    begin = 0
    for layout in layouts(plan):
        part = numbers[:, begin : begin + layout.item.size]
        begin += layout.item.size
        yield layout, part if len(layout.shape) > len(plan.design.shape) else part[:, 0]
