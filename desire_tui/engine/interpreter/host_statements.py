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
    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.host import Host
    from desire_tui.engine.interpreter.statement_context import Site
    from desire_tui.engine.nodes.display import Display, Plot, Show
    from desire_tui.engine.nodes.files import Connect, Disconnect


def drun(site: Site, node: Drun) -> Operation:
    """`drun L`, `drunr L`."""

    def action() -> None:
        site.machine.channels.flush()
        site.machine.run_at = site.code, site.place
        site.host.drun(node.label, site.placed, star=node.star)
        if node.reset:
            site.host.reset()

    return site.then(action)


def reset(site: Site) -> Operation:
    """`reset`."""
    return site.then(site.host.reset)


def clear(site: Site) -> Operation:
    """`clear`: all names are forgotten, so every operation is made anew."""

    def action() -> None:
        machine = site.machine
        if machine.returns:
            raise ScriptFault("clear-in-procedure", site.node)
        site.values.clear()
        machine.refresh()

    return site.then(action)


def irule(site: Site, node: Irule) -> Operation:
    """`irule n`, or the current rule; error 86."""
    host = site.host
    if node.rule is None:
        return site.then(lambda: host.write(f"irule {host.rule}\n"))
    rule, argument = site.whole(node.rule), node.rule

    def action() -> None:
        number = rule()
        if number not in RULES:
            raise ScriptFault("no-such-rule", argument, rule=number)
        host.rule = number

    return site.then(action)


def seed(site: Site, node: Seed) -> Operation:
    """`SEED n`."""
    number, random = site.whole(node.value), site.values.random

    def action() -> None:
        random[0] = seeded(number())

    return site.then(action)


def display(site: Site, node: Display) -> Operation:
    """`display …`; `display 2` is for scripts only."""
    host = site.host
    if site.code.is_command and node.mode == "2":
        raise ScriptFault("not-a-command", node, word="display 2")
    args = [site.real(arg) for arg in node.args]
    return site.then(lambda: host.display(node.mode, [arg() for arg in args]))


def plot(site: Site, node: Plot) -> Operation:
    """`plot x, y [, c]`, `plot z [, c]`."""
    host = site.host
    first, kind = site.value(node.args[0])
    is_complex = kind is Kind.COMPLEX
    rest = [site.real(arg) for arg in node.args[1:]]
    colors = rest if is_complex else rest[1:]
    if len(colors) > 1 or not (rest or is_complex):
        raise ScriptFault("plot-arguments", node)

    def action() -> None:
        z = first()
        y = z.imag if is_complex else rest[0]()
        host.plot(z.real, y, int(colors[0]()) if colors else None)

    return site.then(action)


def show(site: Site, node: Show) -> Operation:
    """`SHOW A, ncol`; error 112. Without ncol a matrix keeps its columns, a vector becomes about square."""
    quantity = site.array(Name(node.name, node.start, node.end))
    square = max(1, round(quantity.size**0.5))
    usual = quantity.shape[-1] if len(quantity.shape) > 1 else square
    given = site.whole(node.columns) if node.columns is not None else None

    def action() -> None:
        count = given() if given is not None else usual
        if not 1 <= count <= quantity.size:
            raise ScriptFault("script-show-columns", node, columns=count, size=quantity.size)
        site.host.show(quantity, count)

    return site.then(action)


def connect(site: Site, node: Connect) -> Operation:
    """`connect 'f' as input n`."""
    if not isinstance(node.file, Text):
        raise ScriptFault("file-name-missing", node.file)
    name, number, channels = node.file.value, site.whole(node.channel), site.machine.channels
    return site.then(lambda: channels.connect(name, node.mode, number()))


def disconnect(site: Site, node: Disconnect) -> Operation:
    """`disconnect n, m`."""
    numbers, channels = [site.whole(channel) for channel in node.channels], site.machine.channels

    def action() -> None:
        for number in numbers:
            channels.disconnect(number())

    return site.then(action)


def time(site: Site) -> Operation:
    """`time`: date, time of day, CPU seconds so far."""

    def action() -> None:
        now = clock.strftime("%Y-%m-%d %H:%M:%S")
        site.host.write(f"{now}   CPU {clock.process_time():.2f} s\n")

    return site.then(action)


def trace(site: Site) -> Operation:
    """`trace`: single-step from here on; again: run freely."""
    following = site.next
    return lambda: site.machine.turn_tracing(following)


_IN_SCRIPTS = {"snapshot", "notebook", "help", "sh", "list", "list+", "compare", "bye"}


def host_command(site: Site, node: FileCommand | Simple) -> Operation:
    """Commands about editors, files, programs; error 199 for those that a script may not give."""
    host = site.host
    argument = node.argument if isinstance(node, FileCommand) else None
    if not site.code.is_command and node.word not in _IN_SCRIPTS:
        raise ScriptFault("command-only", node, word=node.word)
    if node.word == "sh":
        return site.then(lambda: host.shell(argument or ""))
    if node.word == "bye" and not site.code.is_command:
        return lambda: _leave(host)
    return site.then(lambda: host.command(node.word, argument))


def _leave(host: Host) -> NoReturn:
    """`bye` in a script ends the script too, whether or not there is a desktop to leave."""
    host.command("bye", None)
    raise Finished


def go(site: Site) -> Operation:
    """`go` as a command."""
    if not site.code.is_command:
        raise ScriptFault("command-only", site.node, word="go")
    return site.then(site.machine.resume)
