"""Which statement is made into an operation by what, and which are not for scripts or commands."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

from desire_tui.engine import nodes as n
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

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.interpreter.code_table import Operation, ScriptCode
    from desire_tui.engine.interpreter.machine import ScriptMachine

    Maker = Callable[[Site], Operation]

_MAKERS: dict[type[n.Statement], Maker] = {
    n.Assign: assign,
    n.If: control.if_then,
    n.For: control.for_loop,
    n.While: control.while_loop,
    n.Until: control.until,
    n.GoTo: control.go_to,
    n.Label: control.nothing,
    n.Data: control.nothing,
    n.Function: control.nothing,
    n.Procedure: control.leave_block,
    n.Submodel: control.leave_block,
    n.CallProcedure: procedures.call,
    n.Declare: declare,
    n.Read: data_and_input.read,
    n.Restore: data_and_input.restore,
    n.Input: data_and_input.get_input,
    n.Write: writing.write,
    n.Note: writing.note,
    n.Dump: writing.dump,
    n.Connect: host_statements.connect,
    n.Disconnect: host_statements.disconnect,
    n.Irule: host_statements.irule,
    n.Seed: host_statements.seed,
    n.Drun: host_statements.drun,
    n.Fft: fft,
    n.Display: host_statements.display,
    n.Plot: host_statements.plot,
    n.Show: host_statements.show,
    n.MatrixAssign: matrix_statements.matrix,
    n.VectorAssign: matrix_statements.vector,
    n.Dot: matrix_statements.dot,
    n.FileCommand: host_statements.host_command,
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
    *get_args(n.Word),
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
_SCRIPT_ONLY = (n.Label, n.GoTo, n.Procedure, n.Submodel, n.Data)
_SCRIPT_ONLY_WORDS = {"STOP", "end"}


def make(machine: ScriptMachine, code: ScriptCode, place: int) -> Operation:
    """Make the operation of a statement."""
    site = Site(machine, code, place)
    node = site.node
    if isinstance(node, n.Simple):
        return _make_word(site, node)
    if code.is_command and isinstance(node, _SCRIPT_ONLY):
        raise ScriptFault("not-a-command", node, word=_first_word(node))
    if isinstance(node, n.Bare):
        return _bare(site, node)
    maker = _MAKERS.get(type(node))
    if maker is None:
        raise ScriptFault("not-in-script", node)
    return maker(site)


def _make_word(site: Site, node: n.Simple) -> Operation:
    if node.word in _SEGMENT_WORDS:
        raise ScriptFault("not-in-script", node)
    if site.code.is_command and node.word in _SCRIPT_ONLY_WORDS:
        raise ScriptFault("not-a-command", node, word=node.word)
    return _WORDS.get(node.word, host_statements.host_command)(site)


def _first_word(node: n.Statement) -> str:
    if isinstance(node, n.GoTo):
        return "go to"
    name = type(node).__name__
    return name.lower() if isinstance(node, n.Label | n.Data) else name.upper()


def _bare(site: Site, node: n.Bare) -> Operation:
    """Print an expression that stands alone as a command."""
    try:
        line = writing.line_of(site, (n.WriteItem(node.value, "", "", node.start, node.end),))
    except ScriptFault as fault:
        if fault.key == "undefined-variable" and isinstance(node.value, n.Name):
            fault.facts["close"] = fault.facts["close"] or closest(node.value.name, _COMMANDS)
        raise
    return site.then(lambda: site.host.write("".join(line())))
