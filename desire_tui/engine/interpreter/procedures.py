"""`call p(e1, e2; r1, r2)`: arguments before the `;` by value, behind it by reference (book, section 5.2.4).

A PROCEDURE's body is made into operations once for each combination of argument kinds and whole arrays. Its
value dummies have slots of their own; a reference to a scalar or element goes through a box that calls fill.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import closest
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.name_resolution import Meaning, Reference
from desire_tui.engine.nodes.expressions import Element, Name
from desire_tui.engine.values import SCALAR_SLOTS, SYSTEM_SLOTS, Kind, Quantity

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.interpreter.code_table import Operation, ScriptCode
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.control import CallProcedure
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.structure.structure import ProcedureText

Box = list[int]


def call(context: StatementContext, node: CallProcedure) -> Operation:
    """Make the operation of a call; errors 201 and 56."""
    procedures = context.machine.structure.procedures
    found = procedures.get(node.name)
    if found is None:
        raise ScriptFault("undefined-procedure", node, name=node.name, close=closest(node.name, procedures))
    wanted = found.node
    for given, needed, where in (
        (node.values, wanted.values, " before the ;"),
        (node.references, wanted.references, " behind the ;"),
    ):
        if len(given) != len(needed):
            facts = {"given": len(given), "needed": len(needed), "where": where}
            raise ScriptFault("arguments-do-not-match", node, name=node.name, **facts)
    values = [context.value(value) for value in node.values]
    references = [_Bound(context, reference) for reference in node.references]
    code = _body(context, found, [kind for _, kind in values], references)
    dummies = code.scope.dummies
    slots = [meaning.slot for name in wanted.values if isinstance(meaning := dummies[name], Quantity)]
    boxes = [m.box if isinstance(m := dummies[name], Reference) else None for name in wanted.references]
    entry, back, machine = code.base + found.opens + 1, context.next, context.machine
    store_complex = machine.build.names["set_complex"]
    cells = context.values.cells
    stores = [
        (evaluate, slot, kind is Kind.COMPLEX) for (evaluate, kind), slot in zip(values, slots, strict=True)
    ]
    fills = [
        (bound.fill, box)
        for bound, box in zip(references, boxes, strict=True)
        if bound.fill is not None and box is not None
    ]

    def operation() -> int:
        for evaluate, slot, is_complex in stores:
            if is_complex:
                store_complex(slot, evaluate())
            else:
                cells[slot] = evaluate().real
        for fill, box in fills:
            fill(box)
        machine.call(node.name, back)
        return entry

    return operation


class _Bound:
    """An argument by reference: a whole array, or a scalar or element whose slot each call finds."""

    def __init__(self, context: StatementContext, node: Expr) -> None:
        self.array: Quantity | None = None
        self.kind = Kind.REAL
        self.fill: Callable[[Box], None] | None = None
        if isinstance(node, Element):
            slot_of, self.kind = context.slot(node)
            self.fill = _fill_element(slot_of)
        elif isinstance(node, Name):
            self._name(context, node)
        else:
            raise ScriptFault("reference-expected", node)

    def _name(self, context: StatementContext, node: Name) -> None:
        meaning = context.scope.assigned(node)
        self.kind = meaning.kind
        if isinstance(meaning, Reference):
            self.fill = _fill_again(meaning.box)
        elif meaning.shape:
            self.array = meaning
        else:
            self.fill = _fill_scalar(meaning.slot, context.values.defined)


def _fill_element(slot_of: Callable[[], int]) -> Callable[[Box], None]:
    def fill(box: Box) -> None:
        box[:] = slot_of(), 1

    return fill


def _fill_again(outer: Box) -> Callable[[Box], None]:
    def fill(box: Box) -> None:
        box[:] = outer

    return fill


def _fill_scalar(slot: int, defined: bytearray) -> Callable[[Box], None]:
    def fill(box: Box) -> None:
        box[:] = slot, 1 if slot < SYSTEM_SLOTS or slot >= SCALAR_SLOTS else defined[slot]

    return fill


def _body(
    context: StatementContext, found: ProcedureText, kinds: list[Kind], references: list[_Bound]
) -> ScriptCode:
    """Return the body's code for these kinds of arguments."""
    machine = context.machine
    wanted = found.node
    key = (wanted.name, *kinds, *((b.kind, b.array) for b in references))
    known = machine.procedures.get(key)
    if known is not None:
        return known
    dummies: dict[str, Meaning] = {}
    for name, kind in zip(wanted.values, kinds, strict=True):
        slot = machine.values.unnamed(2 if kind is Kind.COMPLEX else 1)
        dummies[name] = Quantity(name, slot, (), kind)
        machine.values.defined[slot] = 1
    for name, bound in zip(wanted.references, references, strict=True):
        if bound.array is not None:
            dummies[name] = bound.array
            continue
        box = [0, 0]
        dummies[name] = Reference(machine.build.share("r", box), bound.kind, box)
    scope = machine.scope.inner(dummies)
    code = machine.link(machine.script.text, scope, found.opens + 1, found.closes + 1)
    machine.procedures[key] = code
    return code
