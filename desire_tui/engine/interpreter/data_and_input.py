"""`data`, `read`, `restore`, `input`: values from lists in the script, from files, from the console."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.interpreter.assignment import storer
from desire_tui.engine.interpreter.entries import Entries
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.statement_context import StatementContext
from desire_tui.engine.interpreter.table_input import table_input
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.values import Kind, Quantity
from desire_tui.engine.whole_numbers import WHOLE_MOST

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.machine import ScriptMachine
    from desire_tui.engine.nodes.expressions import Expr, Target
    from desire_tui.engine.nodes.files import Input, Read, Restore

    Store = Callable[[complex], None]


def data_item(machine: ScriptMachine, place: int, node: Expr) -> Callable[[], complex]:
    """Return the function that evaluates an item of the `data` statement at a place of the script."""
    context = StatementContext(machine, machine.script, place)
    try:
        return context.value(node)[0]
    except ScriptFault as fault:
        if fault.placed is None:
            fault.placed, fault.source = context.placed, context.code.text.source
        raise


def read(context: StatementContext, node: Read) -> Operation:
    """`read a, B, c[2]`."""
    machine = context.machine
    fillers = [filler(context, target) for target in node.targets]

    def action() -> None:
        for fill in fillers:
            fill(machine.data.next)

    return context.then(action)


def restore(context: StatementContext, node: Restore) -> Operation:
    """`restore`, `restore label`, `restore 210`; error 68."""
    data, place = context.machine.data, 0
    if node.target is not None:
        found = context.machine.structure.place(node.target)
        if found is None:
            raise ScriptFault("no-such-label", node, name=node.target)
        place = found
    return context.then(lambda: data.rewind(place))


def filler(context: StatementContext, target: Target) -> Callable[[Callable[[], complex]], None]:
    """Return a function that fills a target, a whole array row by row, from a supply of values."""
    if isinstance(target, Name):
        meaning = context.scope.assigned(target)
        if isinstance(meaning, Quantity) and meaning.shape:
            return _array_filler(context, target, meaning)
    store = storer(context, target)
    return lambda supply: store(supply())


def _array_filler(
    context: StatementContext, target: Name, quantity: Quantity
) -> Callable[[Callable[[], complex]], None]:
    cells, slot, size, kind = context.values.cells, quantity.slot, quantity.size, quantity.kind
    helpers, check = context.machine.build.names, context.machine.check

    def fill(supply: Callable[[], complex]) -> None:
        for index in range(size):
            value = supply()
            if kind is Kind.COMPLEX:
                helpers["set_complex"](slot + 2 * index, complex(value))
            elif value.imag != 0.0:
                raise ScriptFault("complex-to-real", target, name=target.name)
            else:
                number = value.real
                cells[slot + index] = helpers["to_integer"](number) if kind is Kind.INTEGER else number
            if index % 1000 == 999:
                check()

    return fill


def get_input(context: StatementContext, node: Input) -> Operation:
    """`input x, A` from the console, `input #n, x` from a file."""
    if context.code.is_command and node.channel is None:
        raise ScriptFault("not-a-command", node, word="input")
    fillers = [filler(context, target) for target in node.targets]
    if node.channel is not None:
        number, channels = context.truncated(node.channel), context.machine.channels

        def from_file() -> None:
            channel = number()
            table = channels.table(channel, partial(_has_value, context))
            if table is not None:
                table_input(context, node, channel, table, fillers)
                return
            entries = Entries(context, lambda: channels.read_line(channel), f"channel {channel}")
            for fill in fillers:
                fill(entries.next)

        return context.then(from_file)

    kinds = [
        (context.scope.assigned(t) if isinstance(t, Name) else context.scope.array(t)).kind
        for t in node.targets
    ]

    def from_console() -> None:
        entries = Entries(context, lambda: "", "console")
        for target, kind, fill in zip(node.targets, kinds, fillers, strict=True):
            entries.ask(target.name, partial(_misfit, target.name, kind))
            fill(entries.next)

    return context.then(from_console)


def _has_value(context: StatementContext, name: str) -> bool:
    meaning = context.scope.find(name)
    return meaning is not None and not (isinstance(meaning, Quantity) and meaning.shape)


def _misfit(name: str, kind: Kind, value: complex) -> Diagnostic | None:
    """Return what keeps a target of this kind from taking a value: errors 84 and 20."""
    if kind is not Kind.COMPLEX and value.imag != 0.0:
        return Diagnostic("complex-to-real", facts={"name": name})
    if kind is Kind.INTEGER and abs(value.real) > WHOLE_MOST:
        return Diagnostic("integer-overflow", facts={"value": f"{value.real:g}"})
    return None
