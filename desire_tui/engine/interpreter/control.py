"""Blocks, jumps, STOP: everything that moves the program counter."""

from __future__ import annotations

from math import floor
from typing import TYPE_CHECKING

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.interpreter.run_count import ROUNDING
from desire_tui.engine.library import rounded
from desire_tui.engine.nodes.control import For, GoTo, If, Until, While
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    import ast

    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.statement_context import Site


def if_then(site: Site, node: If) -> Operation:
    """`if C then`."""
    if node.condition is None:
        raise ScriptFault("if-without-then", node)
    condition = site.translator.condition(node.condition)
    return _choose(site, condition, site.next, _behind(site))


def while_loop(site: Site, node: While) -> Operation:
    """`while C`."""
    condition = site.translator.condition(node.condition)
    return _choose(site, condition, site.next, _behind(site))


def until(site: Site, node: Until) -> Operation:
    """`until C`."""
    again = site.partner + 1
    leave = py.when(site.translator.condition(node.condition), py.give(py.number(site.next)))
    check = py.carry_out(py.call("check"))
    return site.function([leave, check, py.give(py.number(again))])


def _behind(site: Site) -> int:
    """Where control goes when it does not enter the block that opens here."""
    return site.partner + 1


def _choose(site: Site, condition: ast.expr, yes: int, no: int) -> Operation:
    return site.function([py.give(py.choice(condition, py.number(yes), py.number(no)))])


def end_while(site: Site) -> Operation:
    """`end while`."""
    return _jump_back(site, site.partner)


def _jump_back(site: Site, address: int) -> Operation:
    check = site.machine.check

    def operation() -> int:
        check()
        return address

    return operation


def go_to(site: Site, node: GoTo) -> Operation:
    """`go to L`."""
    place = site.code.text.structure.place(node.target)
    if place is None:
        raise ScriptFault("no-such-label", node, name=node.target)
    address = site.code.base + place
    return _jump_back(site, address) if place <= site.place else site.jump(address)


def for_loop(site: Site, node: For) -> Operation:
    """`for v = a to b step s`: bounds are evaluated once; error 48 for a loop variable that is not real."""
    first, last = site.real(node.first), site.real(node.last)
    by = site.real(node.by) if node.by is not None else None
    slot_of, kind = site.slot(node.variable)
    if kind is Kind.COMPLEX:
        raise ScriptFault("loop-variable", node.variable, name=node.variable.name)
    # k, count, first value, step, slot; shared with `next`
    loop = site.code.loops.setdefault(site.place, [0, 0, 0.0, 1.0, 0])
    after, body, cells = _behind(site), site.next, site.values.cells

    def operation() -> int:
        a, b = first(), last()
        s = by() if by is not None else 1.0
        if s == 0.0:
            raise ScriptFault("step-is-zero", node.by)
        count = floor((b - a) / s + ROUNDING) + 1
        if count < 1:
            return after
        slot = slot_of()
        loop[:] = 0, count, a, s, slot
        cells[slot] = rounded(a) if kind is Kind.INTEGER else a
        return body

    return operation


def next_pass(site: Site) -> Operation:
    """`next`: the variable is computed from the number of passes, so that steps do not drift."""
    opening = site.code.text.structure.partner[site.place]
    node = site.code.text.placed[opening].node
    assert isinstance(node, For)
    loop = site.code.loops.setdefault(opening, [0, 0, 0.0, 1.0, 0])
    kind = site.slot_code(node.variable)[1]
    if isinstance(node.variable, Name):
        loop[4] = site.slot(node.variable)[0]()  # found anew: `clear` may have moved it
    cells, body, after, interrupted = site.values.cells, site.partner + 1, site.next, site.host.interrupted
    whole = kind is Kind.INTEGER

    def operation() -> int:
        k = loop[0] + 1
        if k >= loop[1]:
            return after
        if interrupted():
            raise Interrupted
        loop[0] = k
        value = loop[2] + k * loop[3]
        cells[int(loop[4])] = rounded(value) if whole else value
        return body

    return operation


def leave_block(site: Site) -> Operation:
    """`else` reached from above, a skipped PROCEDURE or SUBMODEL."""
    return site.jump(_behind(site))


def exit_block(site: Site) -> Operation:
    """`exit`: out of the innermost loop, or back from a PROCEDURE."""
    closer = site.code.text.structure.exits[site.place]
    return site.machine.leave if closer is None else site.jump(site.code.base + closer + 1)


def end_procedure(site: Site) -> Operation:
    """`end` of a PROCEDURE."""
    return site.machine.leave


def stop(site: Site) -> Operation:
    """`STOP`."""
    following = site.next
    return lambda: site.machine.stop(following)


def nothing(site: Site) -> Operation:
    """Labels, data lists, `proceed`, `repeat`, FUNCTION lines."""
    return site.jump(site.next)
