"""Tables of a segment's parameters and initial values, with the numbers that its first run begins with."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from desire_tui.engine.nodes.expressions import Call, Element, Name
from desire_tui.engine.nodes.names import assigned, invocation
from desire_tui.engine.nodes.segment import Derivative, VectorDerivative
from desire_tui.engine.nodes.walk import parts_read, walk
from desire_tui.engine.values import SYSTEM_VARIABLES
from desire_tui.export.latex.symbols import COMMA, escaped, number

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from desire_tui.engine.nodes.declarations import Function
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.structure.structure import SubmodelText
    from desire_tui.engine.values import Values
    from desire_tui.export.latex.expressions import Expressions

SHOWN_MAX = 6
"""Elements of an array that are shown; of a longer one, how many there are."""
ROWS_MAX = 40
"""A longer table goes over pages."""


class UsedNames(NamedTuple):
    """The names of a segment, its submodels and FUNCTIONs, in the order of the text."""

    parameters: tuple[str, ...]
    """What it reads and does not assign."""
    begins: tuple[str, ...]
    """States, and variables whose old values count."""


def used_names(
    statements: Iterable[Placed], submodels: Mapping[str, SubmodelText], functions: Mapping[str, Function]
) -> UsedNames:
    """Return what the statements of a segment read and assign."""
    names = _Names(submodels, functions)
    names.add(statements, {})
    parameters = [name for name in names.read if name not in names.given and name not in SYSTEM_VARIABLES]
    begins = [*names.states, *(name for name in names.early if name in names.given)]
    return UsedNames(tuple(parameters), tuple(dict.fromkeys(begins)))


class _Names:
    def __init__(self, submodels: Mapping[str, SubmodelText], functions: Mapping[str, Function]) -> None:
        self._submodels, self._functions = submodels, functions
        self.read: dict[str, None] = {}
        self.given: dict[str, None] = {}
        self.states: dict[str, None] = {}
        self.early: dict[str, None] = {}
        """Read before they are assigned."""

    def add(self, statements: Iterable[Placed], meaning: Mapping[str, str]) -> None:
        """Add statements of a segment, or a submodel's body in which dummies mean the names of `meaning`."""
        for placed in statements:
            node = placed.node
            targets, arrays = assigned(node)
            written = [meaning.get(name, name) for name in (*(one.name for one in targets), *arrays)]
            invoked = invocation(node)
            submodel = self._submodels.get(invoked[0]) if invoked is not None else None
            if invoked is not None and submodel is not None:
                args = [_argument(one, meaning) for one in invoked[1]]
                self.add(submodel.body, dict(zip(submodel.dummies, args, strict=False)))
                continue
            target_places = {one.start for one in targets}
            for part in parts_read(node):
                if part.start not in target_places:
                    self._read(part, meaning)
            for name in written:
                (self.states if isinstance(node, Derivative | VectorDerivative) else self.given)[name] = None
                self.given[name] = None

    def _read(self, part: Name | Element | Call, meaning: Mapping[str, str]) -> None:
        if isinstance(part, Call):
            function = self._functions.get(part.name)
            if function is not None:
                own = (one for one in walk(function.body) if isinstance(one, Name | Element))
                for one in own:
                    if one.name not in function.dummies:
                        self._note(one.name)
            return
        self._note(meaning.get(part.name, part.name))

    def _note(self, name: str) -> None:
        self.read.setdefault(name)
        if name not in self.given:
            self.early.setdefault(name)


def _argument(node: Expr, meaning: Mapping[str, str]) -> str:
    return meaning.get(node.name, node.name) if isinstance(node, Name | Element) else ""


def table(
    title: str,
    names: Sequence[str],
    values: Values,
    writer: Expressions,
    units: Mapping[str, str],
    *,
    start: bool,
) -> str:
    """Return a table of names with values, empty if there are none; `start`: with `(0)` behind the names."""
    rows = []
    for name in names:
        value = _value(name, values) or ("$0$" if start else None)  # a state that nobody sets starts at 0
        if value is not None:
            symbol = f"${writer.name(name)}{'(0)' if start else ''}$"
            rows.append(f"{symbol} & {value} & {escaped(units.get(name, ''))} \\\\")
    if not rows:
        return ""
    has_units = any(name in units for name in names)
    if not has_units:
        rows = [row.replace(r" &  \\", r" \\") for row in rows]
    kind = "longtable" if len(rows) > ROWS_MAX else "tabular"
    heading = f"{title} & value & unit" if has_units else f"{title} & value"
    columns = "lll" if has_units else "ll"
    body = "\n".join(rows)
    begin, end = rf"\begin{{{kind}}}{{{columns}}}", rf"\end{{{kind}}}"
    whole = "\n".join((begin, r"\hline", f"{heading} \\\\", r"\hline", body, r"\hline", end))
    return whole if kind == "longtable" else f"\\begin{{center}}\n{whole}\n\\end{{center}}"


def _value(name: str, values: Values) -> str | None:
    """Return what a quantity is at the start; None: it has no value then."""
    quantity = values.find(name)
    if quantity is None or not values.is_defined(quantity):
        return None
    if not quantity.shape:
        return f"${number(values.cells[quantity.slot])}$"
    numbers = values.view(quantity).real
    if numbers.size and np.all(numbers == numbers.flat[0]):
        return f"all ${number(float(numbers.flat[0]))}$"
    if numbers.ndim == 1 and numbers.size <= SHOWN_MAX:
        shown = COMMA.join(number(float(one)) for one in numbers)
        return rf"$\left({shown}\right)$"
    if numbers.ndim == 2 and max(numbers.shape) <= SHOWN_MAX:
        rows = r" \\ ".join(" & ".join(number(float(one)) for one in row) for row in numbers)
        return rf"$\begin{{pmatrix}} {rows} \end{{pmatrix}}$"
    sizes = r" \times ".join(map(str, numbers.shape))
    low, high = number(float(numbers.min())), number(float(numbers.max()))
    return f"${sizes}$ numbers from ${low}$ to ${high}$"
