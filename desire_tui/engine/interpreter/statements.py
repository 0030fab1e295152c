"""Which statement is made into an operation by what, and which are not for scripts or commands."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

from desire_tui.engine.diagnostics import closest
from desire_tui.engine.interpreter import (
    control,
    data_and_input,
    host_statements,
    matrix_statements,
    procedures,
    writing,
)
from desire_tui.engine.interpreter.assignment import assign
from desire_tui.engine.interpreter.declarations import declare
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.fourier import fft
from desire_tui.engine.interpreter.statement_context import Site
from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Seed, Simple, Word
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Function, Submodel
from desire_tui.engine.nodes.display import Display, Plot, Show
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.nodes.files import (
    Connect,
    Data,
    Disconnect,
    Dump,
    Input,
    Note,
    Read,
    Restore,
    Write,
    WriteItem,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.interpreter.code_table import Operation, ScriptCode
    from desire_tui.engine.interpreter.machine import ScriptMachine
    from desire_tui.engine.nodes.record import Statement

    Maker = Callable[[Site], Operation]

_MAKERS: dict[type[Statement], Maker] = {
    Assign: assign,
    If: control.if_then,
    For: control.for_loop,
    While: control.while_loop,
    Until: control.until,
    GoTo: control.go_to,
    Label: control.nothing,
    Data: control.nothing,
    Function: control.nothing,
    Procedure: control.leave_block,
    Submodel: control.leave_block,
    CallProcedure: procedures.call,
    Declare: declare,
    Read: data_and_input.read,
    Restore: data_and_input.restore,
    Input: data_and_input.get_input,
    Write: writing.write,
    Note: writing.note,
    Dump: writing.dump,
    Connect: host_statements.connect,
    Disconnect: host_statements.disconnect,
    Irule: host_statements.irule,
    Seed: host_statements.seed,
    Drun: host_statements.drun,
    Fft: fft,
    Display: host_statements.display,
    Plot: host_statements.plot,
    Show: host_statements.show,
    MatrixAssign: matrix_statements.matrix,
    VectorAssign: matrix_statements.vector,
    Dot: matrix_statements.dot,
    FileCommand: host_statements.host_command,
}

_WORDS: dict[str, Maker] = {
    "else": control.leave_block,
    "proceed": control.nothing,
    "repeat": control.nothing,
    "next": control.next_pass,
    "end while": control.end_while,
    "end": control.end_procedure,
    "exit": control.exit_block,
    "STOP": control.stop,
    "go": host_statements.go,
    "reset": host_statements.reset,
    "clear": host_statements.clear,
    "time": host_statements.time,
    "trace": host_statements.trace,
}

_COMMANDS = [
    *_WORDS,
    *get_args(Word),
    "write",
    "drun",
    "snapshot",
    "notebook",
    "help",
    "load",
    "keep",
    "note",
]
_SEGMENT_WORDS = {"OUT", "step", "JACOBIAN", "end if", "DYNAMIC"}
_SCRIPT_ONLY = (Label, GoTo, Procedure, Submodel, Data)
_SCRIPT_ONLY_WORDS = {"STOP", "end"}


def make(machine: ScriptMachine, code: ScriptCode, place: int) -> Operation:
    """Make the operation of a statement."""
    site = Site(machine, code, place)
    node = site.node
    if isinstance(node, Simple):
        return _make_word(site, node)
    if code.is_command and isinstance(node, _SCRIPT_ONLY):
        raise ScriptFault("not-a-command", node, word=_first_word(node))
    if isinstance(node, Bare):
        return _bare(site, node)
    maker = _MAKERS.get(type(node))
    if maker is None:
        raise ScriptFault("not-in-script", node)
    return maker(site)


def _make_word(site: Site, node: Simple) -> Operation:
    if node.word in _SEGMENT_WORDS:
        raise ScriptFault("not-in-script", node)
    if site.code.is_command and node.word in _SCRIPT_ONLY_WORDS:
        raise ScriptFault("not-a-command", node, word=node.word)
    return _WORDS.get(node.word, host_statements.host_command)(site)


def _first_word(node: Statement) -> str:
    if isinstance(node, GoTo):
        return "go to"
    name = type(node).__name__
    return name.lower() if isinstance(node, Label | Data) else name.upper()


def _bare(site: Site, node: Bare) -> Operation:
    """Print an expression that stands alone as a command."""
    try:
        line = writing.line_of(site, (WriteItem(node.value, "", "", node.start, node.end),))
    except ScriptFault as fault:
        if fault.key == "undefined-variable" and isinstance(node.value, Name):
            fault.facts["close"] = fault.facts["close"] or closest(node.value.name, _COMMANDS)
        raise
    return site.then(lambda: site.host.write("".join(line())))
