"""Values of lowered segments as C expressions: of a number, or of element `i` of an array."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.lowered.expressions import (
    Const,
    Load,
    MatVec,
    Op,
    Outer,
    PatternRow,
    ShiftedVec,
    Table1,
    Table2,
    Vec,
)
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.values import IROW
from desire_tui.export.c.functions import C_NAMES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.export.c.layout import Layout

_SIGNS = {"add": " + ", "sub": " - ", "mul": " * ", "div": " / "}
_OWN = {"max": "maximum", "min": "minimum"}


class Expressions:
    """Writes the values of one statement; a value that is met twice is computed once, in a variable.

    `lines` are the variables' definitions, to stand before the statement. `used` gathers what the library is
    asked for.
    """

    def __init__(self, layout: Layout, used: set[str], values: Sequence[Value]) -> None:
        self._layout, self._used = layout, used
        self._names: dict[int, str] = {}
        self._shared = _shared(values)
        self.lines: list[str] = []

    def value(self, node: Value) -> str:
        """Return the text of a value; of an array's element `i`."""
        key = id(node)
        if key not in self._shared:
            return self._text(node)
        if key not in self._names:
            text = self._text(node)
            name = self._names[key] = f"w{len(self._names) + 1}"
            self.lines.append(f"const double {name} = {bare(text)};")
        return self._names[key]

    def _text(self, node: Value) -> str:
        layout = self._layout
        match node:
            case Const():
                return number(node.value)
            case Load():
                return layout.place(node.slot)
            case Op():
                return self._operation(node)
            case Table1():
                self._used.add("table1")
                table = layout.pointer(node.slot, 2 * node.count)
                return f"table1({self.value(node.x)}, {table}, {node.count})"
            case Table2():
                self._used.add("table2")
                x, y = self.value(node.x), self.value(node.y)
                f = layout.pointer(node.f_slot, node.rows * node.cols)
                xs, ys = layout.pointer(node.x_slot, node.rows), layout.pointer(node.y_slot, node.cols)
                return f"table2({x}, {y}, {f}, {node.rows}, {node.cols}, {xs}, {ys})"
            case Vec():
                return f"{layout.pointer(node.slot, node.count)}[i]"
            case ShiftedVec():
                self._used.add("shifted")
                return f"shifted({layout.pointer(node.slot, node.count)}, {node.count}, i + ({node.by}))"
            case MatVec():
                return self._product(node)
            case PatternRow():
                self._used.add("pattern_row")
                row = f"pattern_row({layout.place(IROW)}, {node.rows})"
                return f"{layout.pointer(node.slot, node.rows * node.cols)}[{row} * {node.cols} + i]"
            case Outer():
                u = f"{layout.pointer(node.u_slot, node.u_count)}[i / {node.v_count}]"
                v = f"{layout.pointer(node.v_slot, node.v_count)}[i % {node.v_count}]"
                if node.op == "mul":
                    return f"({u} * {v})"
                self._used.add("min")
                return f"minimum({u}, {v})"
            case _:
                assert_never(node)

    def _product(self, node: MatVec) -> str:
        self._used.add("row_product")
        matrix = self._layout.pointer(node.slot, node.rows * node.cols)
        if node.transposed:
            x = self._layout.pointer(node.x_slot, node.rows)
            return f"row_product({matrix} + i, {node.cols}, {x}, {node.rows})"
        x = self._layout.pointer(node.x_slot, node.cols)
        return f"row_product({matrix} + i * {node.cols}, 1, {x}, {node.cols})"

    def _operation(self, node: Op) -> str:
        name = node.name
        if name in DRAWS:
            self._used.add(name)
            return f"{name}()"
        if name == "ipow":
            exponent = node.args[1]
            assert isinstance(exponent, Const)
            self._used.add("ipow")
            return f"whole_power({self.value(node.args[0])}, {int(exponent.value)})"
        args = [self.value(argument) for argument in node.args]
        if name in _SIGNS:
            return f"({_SIGNS[name].join(args)})"
        if name == "neg":
            return f"(-{args[0]})"
        self._used.add(name)
        return f"{C_NAMES.get(name) or _OWN.get(name, name)}({', '.join(map(bare, args))})"


def bare(text: str) -> str:
    """Return an expression without the brackets around all of it."""
    if not text.startswith("(") or not text.endswith(")"):
        return text
    depth = 0
    for at, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if depth == 0 and at < len(text) - 1:
            return text
    return text[1:-1]


def number(value: float) -> str:
    """Return a number in C, to its last bit."""
    if value != value:  # noqa: PLR0124 - nan
        return "NAN"
    if value in (float("inf"), float("-inf")):
        return "INFINITY" if value > 0 else "(-INFINITY)"
    return repr(value) if value >= 0 and str(value) != "-0.0" else f"({value!r})"


def _shared(values: Sequence[Value]) -> set[int]:
    """Return the ids of what has to be a variable: it stands at several places, or draws a random number."""
    seen, twice = set[int](), set[int]()

    def visit(node: Value) -> None:
        if isinstance(node, Const | Load):
            return
        if id(node) in seen:
            twice.add(id(node))
            return
        if isinstance(node, Op) and node.name in DRAWS:
            twice.add(id(node))  # C leaves the order open in which operands are computed
        seen.add(id(node))
        for part in _parts(node):
            visit(part)

    for value in values:
        visit(value)
    return twice


def _parts(node: Value) -> Sequence[Value]:
    match node:
        case Op():
            return node.args
        case Table1():
            return (node.x,)
        case Table2():
            return (node.x, node.y)
        case _:
            return ()
