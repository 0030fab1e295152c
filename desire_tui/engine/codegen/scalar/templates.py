"""Statements that differ only in names and numbers are written from one template.

1,401 equations of a circuit have a handful of shapes. A shape is written once by the ordinary writer; every
further statement of that shape costs one walk over its nodes and one formatting.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.functions import apply, power
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.text import IrText, literal
from desire_tui.engine.lowered.expressions import Const, Load, Op
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.recently_used import RecentlyUsed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.codegen.ir.cells import Cells
    from desire_tui.engine.lowered.expressions import Value

_TEMPLATES_ROOM = 500
_templates: RecentlyUsed[tuple[object, ...], tuple[str, frozenset[str], str]] = RecentlyUsed(_TEMPLATES_ROOM)
"""Shape → lines with places for leaves and a prefix, what they need declared, the result."""
_NODES_MOST = 200
"""Larger ones are mostly FUNCTIONs of FUNCTIONs, whose shared arguments the ordinary writer writes once."""


class NotPlainError(Exception):
    """The value holds something that templates do not cover."""


def shape(node: Value, key: list[object], leaves: list[int | float]) -> None:
    """Append a value's shape to `key`, its slots (int) and numbers (float) to `leaves`, in order.

    NotPlainError: it holds more than scalars, numbers and operations, or very many of them.
    """
    kind = type(node)  # faster than isinstance by what counts here; mypy does not follow it
    if kind is Load:
        key.append(None)
        leaves.append(node.slot)  # type: ignore[union-attr]
    elif kind is Const:
        key.append(None)
        leaves.append(float(node.value))  # type: ignore[union-attr]
    elif kind is Op:
        name, args = node.name, node.args  # type: ignore[union-attr]
        key.append(name)
        if name == "ipow":
            shape(args[0], key, leaves)
            exponent = args[1]
            assert isinstance(exponent, Const)
            key.append(exponent.value)
        elif name in DRAWS or name == "delayed":
            raise NotPlainError
        else:
            for arg in args:  # most of them names, which are looked at here: a call takes as long again
                if type(arg) is Load:
                    key.append(None)
                    leaves.append(arg.slot)
                else:
                    shape(arg, key, leaves)
        if len(key) > _NODES_MOST:
            raise NotPlainError
    else:
        raise NotPlainError


def write(text: IrText, cells: Cells, node: Value) -> str | None:
    """Write a scalar value; return its name, or None if templates do not cover it."""
    key: list[object] = []
    leaves: list[int | float] = []
    try:
        shape(node, key, leaves)
    except NotPlainError:
        return None
    load = cells.load
    names = [load(leaf) if type(leaf) is int else literal(leaf) for leaf in leaves]
    if len(key) == 1:
        return names[0]
    template = _templates[tuple(key)]
    if template is None:
        template = _make_template(tuple(key), node)
    lines, declarations, result = template
    prefix = text.fresh()
    if declarations:
        text.declarations |= declarations
    text.lines.append(lines.format(prefix, *names))
    return result.format(prefix, *names)  # x^1 is its own leaf


def write_shape(lanes: Lanes, node: Value, leaves: Iterator[str]) -> str:
    """Write a plain value over given leaves, in the order of `shape`; return its name."""
    if not isinstance(node, Op):
        return next(leaves)
    if node.name == "ipow":
        exponent = node.args[1]
        assert isinstance(exponent, Const)
        return power(lanes, write_shape(lanes, node.args[0], leaves), int(exponent.value))
    return apply(lanes, node.name, [write_shape(lanes, a, leaves) for a in node.args])


def _make_template(key: tuple[object, ...], node: Value) -> tuple[str, frozenset[str], str]:
    text = IrText("!")
    lanes = Lanes(text)
    count = key.count(None)
    result = write_shape(lanes, node, iter([f"?{number}?" for number in range(1, count + 1)]))
    lines = "\n".join(text.lines).replace("{", "{{").replace("}", "}}")
    lines = _with_placeholders(lines, count)
    template = (lines, frozenset(text.declarations), _with_placeholders(result, count))
    _templates.keep(key, template)
    return template


def age() -> None:
    """Between two programs: forget templates that no program of late used."""
    _templates.age()


def _with_placeholders(lines: str, count: int) -> str:
    lines = lines.replace("%!", "%{0}.")
    for number in range(1, count + 1):
        lines = lines.replace(f"?{number}?", f"{{{number}}}")
    return lines
