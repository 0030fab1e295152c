"""Blocks, jumps, STOP: everything that moves the program counter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.interpreter.run_count import loop_count
from desire_tui.engine.nodes.control import For, GoTo, If, Until, While
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    import ast

    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.statement_context import StatementContext


def if_then(context: StatementContext, node: If) -> Operation:
    """`if C then`."""
    if node.condition is None:
        raise ScriptFault("if-without-then", node)
    condition = context.translator.condition(node.condition)
    return _choose(context, condition, context.next, _behind(context))


def while_loop(context: StatementContext, node: While) -> Operation:
    """`while C`."""
    condition = context.translator.condition(node.condition)
    return _choose(context, condition, context.next, _behind(context))


def until(context: StatementContext, node: Until) -> Operation:
    """`until C`."""
    again = context.partner + 1
    leave = py.if_statement(
        context.translator.condition(node.condition), py.return_value(py.number(context.next))
    )
    check = py.expression_statement(py.call("check"))
    return _loop(context, context.function([leave, check, py.return_value(py.number(again))]), again)


def _loop(context: StatementContext, operation: Operation, body: int) -> Operation:
    """Make an operation that closes a loop quicker once it was carried out often."""
    from desire_tui.engine.interpreter.hot_loops import warm  # many scripts have no loops: 1 ms

    return warm(context, operation, body)


def _behind(context: StatementContext) -> int:
    """Where control goes when it does not enter the block that opens here."""
    return context.partner + 1


def _choose(context: StatementContext, condition: ast.expr, yes: int, no: int) -> Operation:
    return context.function([py.return_value(py.if_else(condition, py.number(yes), py.number(no)))])


def end_while(context: StatementContext) -> Operation:
    """`end while`."""
    return _loop(context, _jump_back(context, context.partner), context.partner)


def _jump_back(context: StatementContext, address: int) -> Operation:
    check = context.machine.check

    def operation() -> int:
        check()
        return address

    return operation


def go_to(context: StatementContext, node: GoTo) -> Operation:
    """`go to L`."""
    place = context.code.text.structure.place(node.target)
    if place is None:
        raise ScriptFault("no-such-label", node, name=node.target)
    address = context.code.base + place
    return _jump_back(context, address) if place <= context.place else context.jump(address)


def for_loop(context: StatementContext, node: For) -> Operation:
    """`for v = a to b step s`: bounds are evaluated once; error 48 for a loop variable that is not real.

    A loop that makes no turn leaves its variable at the start value.
    """
    first, last = context.real(node.first), context.real(node.last)
    by = context.real(node.by) if node.by is not None else None
    slot_of, kind = context.slot(node.variable)
    if kind is Kind.COMPLEX:
        raise ScriptFault("loop-variable", node.variable, name=node.variable.name)
    # k, count, first value, step, slot; shared with `next`
    loop = context.code.loops.setdefault(context.place, [0, 0, 0.0, 1.0, 0])
    after, body, cells = _behind(context), context.next, context.values.cells
    to_integer = context.machine.build.names["to_integer"]

    def operation() -> int:
        a, b = first(), last()
        s = by() if by is not None else 1.0
        if s == 0.0:
            raise ScriptFault("step-is-zero", node.by)
        count = loop_count(a, b, s)
        slot = slot_of()
        loop[:] = 0, count, a, s, slot
        cells[slot] = to_integer(a) if kind is Kind.INTEGER else a
        return body if count > 0 else after

    return operation


def next_pass(context: StatementContext) -> Operation:
    """`next`: the variable is computed from the number of passes, so that steps do not drift."""
    opening = context.code.text.structure.partner[context.place]
    node = context.code.text.placed[opening].node
    assert isinstance(node, For)
    loop = context.code.loops.setdefault(opening, [0, 0, 0.0, 1.0, 0])
    kind = context.slot_code(node.variable)[1]
    if isinstance(node.variable, Name):
        loop[4] = context.slot(node.variable)[0]()  # found anew: `clear` may have moved it
    cells, body, after, interrupted = (
        context.values.cells,
        context.partner + 1,
        context.next,
        context.host.interrupted,
    )
    whole = kind is Kind.INTEGER
    to_integer = context.machine.build.names["to_integer"]

    def operation() -> int:
        k = loop[0] + 1
        if k >= loop[1]:
            return after
        if interrupted():
            raise Interrupted
        loop[0] = k
        value = loop[2] + k * loop[3]
        cells[int(loop[4])] = to_integer(value) if whole else value
        return body

    return _loop(context, operation, body)


def leave_block(context: StatementContext) -> Operation:
    """`else` reached from above, a skipped PROCEDURE or SUBMODEL."""
    return context.jump(_behind(context))


def exit_block(context: StatementContext) -> Operation:
    """`exit`: out of the innermost loop, or back from a PROCEDURE."""
    closer = context.code.text.structure.exits[context.place]
    return context.machine.leave if closer is None else context.jump(context.code.base + closer + 1)


def end_procedure(context: StatementContext) -> Operation:
    """`end` of a PROCEDURE."""
    return context.machine.leave


def stop(context: StatementContext) -> Operation:
    """`STOP`."""
    following = context.next
    return lambda: context.machine.stop(following)


def nothing(context: StatementContext) -> Operation:
    """Labels, data lists, `proceed`, `repeat`, FUNCTION lines."""
    return context.jump(context.next)
