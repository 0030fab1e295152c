"""Which statement is made into an operation by what, and which are not for scripts or commands."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never, get_args

from desire_tui.engine.diagnostics import DesireError, closest
from desire_tui.engine.interpreter import (
    control,
    data_and_input,
    host_statements,
    procedures,
    writing,
)
from desire_tui.engine.interpreter.assignment import assign
from desire_tui.engine.interpreter.declarations import declare
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.statement_context import StatementContext
from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Seed, Simple, Word
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Function, Submodel
from desire_tui.engine.nodes.display import Display, GraphText, Plot, Show, ShowArea
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.nodes.faulty import Faulty
from desire_tui.engine.nodes.files import (
    Connect,
    Data,
    Disconnect,
    Dump,
    Input,
    LoadData,
    Note,
    Read,
    Restore,
    Write,
    WriteItem,
)
from desire_tui.engine.nodes.statements import SegmentOnlyStatement

if TYPE_CHECKING:
    from desire_tui.engine.interpreter.code_table import Operation, ScriptCode
    from desire_tui.engine.interpreter.machine import ScriptMachine
    from desire_tui.engine.nodes.statements import Statement

_COMMANDS = [
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


def make(machine: ScriptMachine, code: ScriptCode, place: int) -> Operation:
    """Make the operation of a statement."""
    context = StatementContext(machine, code, place)
    node = context.node
    if code.is_command:
        _must_be_command(node)
    elif (fault := code.text.structure.faults.get(context.placed.at)) is not None:
        others = (other for other in code.text.structure.faults.values() if other is not fault)
        raise DesireError(fault, *others)  # the others are known as well: all may be mended at once
    match node:
        case Assign():
            return assign(context, node)
        case Simple():
            return _make_word(context, node)
        case Bare():
            return _bare(context, node)
        case If():
            return control.if_then(context, node)
        case For():
            return control.for_loop(context, node)
        case While():
            return control.while_loop(context, node)
        case Until():
            return control.until(context, node)
        case GoTo():
            return control.go_to(context, node)
        case Label() | Data() | Function():
            return control.nothing(context)
        case Procedure() | Submodel():
            return control.leave_block(context)
        case CallProcedure():
            return procedures.call(context, node)
        case Declare():
            return declare(context, node)
        case LoadData():
            from desire_tui.engine.interpreter.data_tables import load_data  # few programs read files: 2 ms

            return load_data(context, node)
        case Read():
            return data_and_input.read(context, node)
        case Restore():
            return data_and_input.restore(context, node)
        case Input():
            return data_and_input.get_input(context, node)
        case Write():
            return writing.write(context, node)
        case Note():
            return writing.note(context, node)
        case Dump():
            return writing.dump(context, node)
        case Connect():
            return host_statements.connect(context, node)
        case Disconnect():
            return host_statements.disconnect(context, node)
        case Irule():
            return host_statements.irule(context, node)
        case Seed():
            return host_statements.seed(context, node)
        case Drun():
            return host_statements.drun(context, node)
        case Fft():
            from desire_tui.engine.interpreter.fourier import fft

            return fft(context, node)
        case Display():
            return host_statements.display(context, node)
        case GraphText():
            return context.then(lambda: context.host.name_graph(node.part, node.text))
        case Plot():
            return host_statements.plot(context, node)
        case ShowArea():
            return context.then(lambda: context.host.show_area(by_size=node.by_size))
        case Show():
            return host_statements.show(context, node)
        case MatrixAssign() | VectorAssign() | Dot():
            from desire_tui.engine.interpreter import matrix_statements  # few scripts compute arrays: 2 ms

            return matrix_statements.computed(context, node)
        case FileCommand():
            return host_statements.host_command(context, node)
    if isinstance(node, SegmentOnlyStatement):
        raise ScriptFault("not-in-script", node)
    assert not isinstance(node, Faulty)  # it has a fault
    assert_never(node)


def _make_word(context: StatementContext, node: Simple) -> Operation:
    """Make the operation of a statement that is a word."""
    match node.word:
        case "else":
            return control.leave_block(context)
        case "proceed" | "repeat":
            return control.nothing(context)
        case "next":
            return control.next_pass(context)
        case "end while":
            return control.end_while(context)
        case "end":
            return control.end_procedure(context)
        case "exit":
            return control.exit_block(context)
        case "STOP":
            return control.stop(context)
        case "go":
            return host_statements.go(context)
        case "reset":
            return host_statements.reset(context)
        case "clear":
            return host_statements.clear(context)
        case "time":
            return host_statements.time(context)
        case "trace":
            return host_statements.trace(context)
        case "OUT" | "step" | "JACOBIAN" | "end if" | "end event" | "DYNAMIC":
            raise ScriptFault("not-in-script", node)
        case "erun" | "run" | "bye" | "new" | "NEW" | "list" | "list+" | "reload" | "keep+":
            return host_statements.host_command(context, node)
        case "ed" | "edit" | "auto":
            return host_statements.host_command(context, node)
    assert_never(node.word)


def _must_be_command(node: Statement) -> None:
    """Refuse what only a script may hold."""
    word = None
    match node:
        case GoTo():
            word = "go to"
        case Label() | Data():
            word = type(node).__name__.lower()
        case Procedure() | Submodel():
            word = type(node).__name__.upper()
        case Simple("STOP" | "end"):
            word = node.word
    if word is not None:
        raise ScriptFault("not-a-command", node, word=word)


def _bare(context: StatementContext, node: Bare) -> Operation:
    """Print an expression that stands alone as a command."""
    try:
        line = writing.line_of(context, (WriteItem(node.value, "", "", node.start, node.end),))
    except ScriptFault as fault:
        if fault.key == "undefined-variable" and isinstance(node.value, Name):
            fault.facts["close"] = fault.facts["close"] or closest(node.value.name, _COMMANDS)
        raise
    return context.then(lambda: context.host.write("".join(line())))
