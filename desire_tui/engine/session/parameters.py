"""The quantities of a program that are worth varying, and the statements that give them their values."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.commands import Drun
from desire_tui.engine.nodes.control import For
from desire_tui.engine.nodes.declarations import Declare
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.nodes.names import assigned
from desire_tui.engine.nodes.signs import literal, whole_literal
from desire_tui.engine.source import Span
from desire_tui.engine.values import SYSTEM_VARIABLES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.nodes.expressions import Expr, Target
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.runtime.start_values import StartValues
    from desire_tui.engine.values import Values

ParameterKind = Literal["number", "computed", "initial"]


class Parameter(NamedTuple):
    """A quantity by its name in a setting (`c`, `q[2]`), and its value when the last run began.

    `number`: the script gives it a number; `computed`: from others; `initial`: it is a state.
    """

    name: str
    value: float
    kind: ParameterKind

    @property
    def label(self) -> str:
        """Its name, of a state's start with (0)."""
        return f"{self.name}(0)" if self.kind == "initial" else self.name


def parameters(program: Program, values: Values, start: StartValues | None) -> list[Parameter]:
    """Return what may be varied: numbers of the script, what else a run read, starts of its states."""
    read = start.parameters if start is not None else {}
    initial = start.initial if start is not None else {}
    found: dict[str, Parameter] = {}
    counting = [placed.node.variable.name for placed in program.script if isinstance(placed.node, For)]
    for placed in program.script:
        node = placed.node
        if isinstance(node, Assign) and literal(node.value) is not None:
            name = setting_name(node.target)
            value = None if name is None else read.get(name, _value(values, name))
            if name is not None and value is not None and name not in initial:
                found[name] = Parameter(name, value, "number")
    for name, value in read.items():
        found.setdefault(name, Parameter(name, value, "computed"))
    for name in (*SYSTEM_VARIABLES, *counting):
        found.pop(name, None)
    return [*found.values(), *(Parameter(name, value, "initial") for name, value in initial.items())]


def _value(values: Values, name: str) -> float | None:
    quantity = values.find(name)
    if quantity is None or quantity.shape or not values.is_defined(quantity):
        return None
    return values.cells[quantity.slot]


def setting_name(target: Target) -> str | None:
    """Return what a setting calls an assignment's target; None for elements chosen by expressions."""
    if isinstance(target, Name):
        return target.name
    subscripts = [whole_literal(subscript) for subscript in target.subscripts]
    if None in subscripts:
        return None
    return f"{target.name}[{','.join(map(str, subscripts))}]"


class Written(NamedTuple):
    """What is to be done to a program's text, from the last place to the first, and what is not."""

    edits: list[tuple[Span, str]]
    refused: list[str]
    """Names whose value is given in several places, or by no statement that can be changed."""


def written_into(program: Program, values: Mapping[str, float]) -> Written:
    """Return the edits that make a program give these quantities these values.

    The one statement that assigns a quantity gets the number; one that is never assigned gets a line of its
    own before the first run.
    """
    places: dict[str, list[tuple[Placed, Expr]]] = {}
    others: set[str] = set()
    for placed in program.script:
        node = placed.node
        if isinstance(node, Assign):
            name = setting_name(node.target)
            if name is not None:
                places.setdefault(name, []).append((placed, node.value))
            else:
                others.add(node.target.name)
        elif not isinstance(node, Declare):
            targets = assigned(node)
            others.update(target.name for target in targets.targets)
            others.update(targets.arrays)
    edits, refused, new = [], [], []
    for name, value in values.items():
        given, text = places.get(name, []), f"{value:.15g}"
        if len(given) > 1 or name.partition("[")[0] in others:
            refused.append(name)
        elif given:
            placed, expression = given[0]
            edits.append((placed.span(expression), text))
        else:
            new.append(f"{name} = {text}")
    if new:
        edits.append((_line_before_runs(program), " | ".join(new) + "\n"))
    return Written(sorted(edits, key=lambda edit: edit[0].start, reverse=True), refused)


def _line_before_runs(program: Program) -> Span:
    """Return the beginning of a line where a statement is carried out before each run, once.

    That of the first statement of the script, or the first behind its last declaration before a run.
    """
    first = 0
    for number, placed in enumerate(program.script):
        if isinstance(placed.node, Drun):
            break
        if isinstance(placed.node, Declare):
            first = number + 1
    rest = program.script[first:]
    at = rest[0].at if rest else len(program.source.text)
    start = program.source.text.rfind("\n", 0, at) + 1
    return Span(start, start)
