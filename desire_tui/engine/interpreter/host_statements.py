"""Statements that are about runs, graph, files and the machine: most only pass on to the host."""

from __future__ import annotations

import time as clock
from typing import TYPE_CHECKING, NoReturn

from desire_tui.engine.integration.rules import RULES
from desire_tui.engine.interpreter.code_table import Finished
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.nodes.commands import Drun, FileCommand, Irule, Seed, Simple
from desire_tui.engine.nodes.expressions import Name, Text
from desire_tui.engine.random_sequence import seeded
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.host import Host
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.display import Display, Plot, Show
    from desire_tui.engine.nodes.files import Connect, Disconnect


def drun(context: StatementContext, node: Drun) -> Operation:
    """`drun L`, `drunr L`."""

    def action() -> None:
        context.machine.channels.flush()
        context.machine.run_at = context.code, context.place
        context.host.drun(node.label, context.placed, star=node.star)
        if node.reset:
            context.host.reset()

    return context.then(action)


def reset(context: StatementContext) -> Operation:
    """`reset`."""
    return context.then(context.host.reset)


def clear(context: StatementContext) -> Operation:
    """`clear`: all names are forgotten, so every operation is made anew."""

    def action() -> None:
        machine = context.machine
        if machine.returns:
            raise ScriptFault("clear-in-procedure", context.node)
        context.values.clear()
        machine.refresh()

    return context.then(action)


def irule(context: StatementContext, node: Irule) -> Operation:
    """`irule n`, or the current rule; error 86."""
    host = context.host
    if node.rule is None:
        return context.then(lambda: host.write(f"irule {host.rule}\n"))
    rule, argument = context.truncated(node.rule), node.rule

    def action() -> None:
        number = rule()
        if number not in RULES:
            raise ScriptFault("no-such-rule", argument, rule=number)
        host.rule = number

    return context.then(action)


def seed(context: StatementContext, node: Seed) -> Operation:
    """`SEED n`."""
    number, values = context.truncated(node.value), context.values

    def action() -> None:
        state = seeded(number())
        values.random[0] = state if values.seeding is None else values.seeding(state)

    return context.then(action)


def display(context: StatementContext, node: Display) -> Operation:
    """`display …`; `display 2` is for scripts only."""
    host = context.host
    if context.code.is_command and node.mode == "2":
        raise ScriptFault("not-a-command", node, word="display 2")
    number = context.truncated if node.mode in {"C", "N"} else context.real
    args: list[Callable[[], float]] = [number(arg) for arg in node.args]
    return context.then(lambda: host.display(node.mode, [arg() for arg in args]))


def plot(context: StatementContext, node: Plot) -> Operation:
    """`plot x, y [, c]`, `plot z [, c]`."""
    host = context.host
    first, kind = context.value(node.args[0])
    is_complex = kind is Kind.COMPLEX
    rest = [context.real(arg) for arg in node.args[1:]]
    colors = [context.truncated(arg) for arg in node.args[1 if is_complex else 2 :]]
    if len(colors) > 1 or not (rest or is_complex):
        raise ScriptFault("plot-arguments", node)

    def action() -> None:
        z = first()
        y = z.imag if is_complex else rest[0]()
        host.plot(z.real, y, colors[0]() if colors else None)

    return context.then(action)


def show(context: StatementContext, node: Show) -> Operation:
    """`SHOW A, ncol`; error 112. Without ncol a matrix keeps its columns, a vector becomes about square."""
    quantity = context.array(Name(node.name, node.start, node.end))
    square = max(1, round(quantity.size**0.5))
    usual = quantity.shape[-1] if len(quantity.shape) > 1 else square
    given = context.truncated(node.columns) if node.columns is not None else None

    def action() -> None:
        count = given() if given is not None else usual
        if not 1 <= count <= quantity.size:
            raise ScriptFault("script-show-columns", node, columns=count, size=quantity.size)
        context.host.show(quantity, count)

    return context.then(action)


def connect(context: StatementContext, node: Connect) -> Operation:
    """`connect 'f' as input n`."""
    if not isinstance(node.file, Text):
        raise ScriptFault("file-name-missing", node.file)
    name, number, channels = node.file.value, context.truncated(node.channel), context.machine.channels
    return context.then(lambda: channels.connect(name, node.mode, number()))


def disconnect(context: StatementContext, node: Disconnect) -> Operation:
    """`disconnect n, m`."""
    numbers, channels = [context.truncated(channel) for channel in node.channels], context.machine.channels

    def action() -> None:
        for number in numbers:
            channels.disconnect(number())

    return context.then(action)


def time(context: StatementContext) -> Operation:
    """`time`: date, time of day, CPU seconds so far."""

    def action() -> None:
        now = clock.strftime("%Y-%m-%d %H:%M:%S")
        context.host.write(f"{now}   CPU {clock.process_time():.2f} s\n")

    return context.then(action)


def trace(context: StatementContext) -> Operation:
    """`trace`: single-step from here on; again: run freely."""
    following = context.next
    return lambda: context.machine.toggle_tracing(following)


_IN_SCRIPTS = {
    "snapshot", "notebook", "help", "sh", "list", "list+", "compare", "bye", "ed", "edit", "auto", "note",
}  # fmt: skip
_LOOKS = {"ed", "edit", "auto"}


def host_command(context: StatementContext, node: FileCommand | Simple) -> Operation:
    """Commands about editors, files, programs; error 199 for those that a script may not give."""
    host = context.host
    argument = node.argument if isinstance(node, FileCommand) else None
    if not context.code.is_command and node.word not in _IN_SCRIPTS:
        raise ScriptFault("command-only", node, word=node.word)
    if node.word in _LOOKS and argument is None and not context.code.is_command:
        return context.then(lambda: None)  # the original asks its user for lines: here they are on the screen
    if node.word == "sh":
        return context.then(lambda: host.shell(argument or ""))
    if node.word == "bye" and not context.code.is_command:
        return lambda: _leave(host)
    return context.then(lambda: host.command(node.word, argument))


def _leave(host: Host) -> NoReturn:
    """`bye` in a script ends the script too, whether or not there is a desktop to leave."""
    host.command("bye", None)
    raise Finished


def go(context: StatementContext) -> Operation:
    """`go` as a command."""
    if not context.code.is_command:
        raise ScriptFault("command-only", context.node, word="go")
    return context.then(context.machine.resume)
