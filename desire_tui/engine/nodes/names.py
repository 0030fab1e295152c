"""Which names a statement gives a value or a meaning: the one place that knows it for every statement."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, assert_never

from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Seed, Simple
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Function, Submodel
from desire_tui.engine.nodes.display import Display, GraphText, Plot, Request, Show, ShowArea
from desire_tui.engine.nodes.expressions import Call, Element, Name
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
)
from desire_tui.engine.nodes.segment import (
    Delay,
    Derivative,
    Event,
    Every,
    Fast,
    FunctionTable,
    Get,
    Invoke,
    Learn,
    Sample,
    Store,
    Term,
    TrackHold,
    VectorDerivative,
)

if TYPE_CHECKING:
    from desire_tui.engine.nodes.expressions import Expr, Target
    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.nodes.statements import Statement


class Assigned(NamedTuple):
    """What a statement could give a value: scalars and elements, and arrays as a whole.

    `read`, `input` and `call` may name whole arrays among their `targets`.
    """

    targets: tuple[Target, ...] = ()
    arrays: tuple[str, ...] = ()


_NOTHING = Assigned()


def assigned(node: Statement) -> Assigned:
    """Return what a statement could give a value. What a submodel assigns, the statements of its body do."""
    match node:
        case Assign(target) | Derivative(target) | Dot(target) | FunctionTable(target):
            return Assigned((target,))
        case VectorAssign(name) | MatrixAssign(name) | VectorDerivative(name):
            return Assigned((), (name,))
        case For(variable) | Get(variable):
            return Assigned((variable,))
        case Store(array):
            return Assigned((), (array,))
        case Delay(variable, buffer):
            return Assigned((variable,), (buffer,))
        case TrackHold(held, tracked):
            return Assigned((held, tracked))
        case Learn(_, output, weights):
            return Assigned((), (output, weights))
        case Request(kind, _, items):
            return Assigned(items) if kind == "recover" else _NOTHING
        case Read(targets) | Input(_, targets):
            return Assigned(targets)
        case CallProcedure(_, _, references):
            return Assigned(tuple(part for part in references if isinstance(part, Name | Element)))
        case Fft(_, args):
            return Assigned((), tuple(part.name for part in args[1:] if isinstance(part, Name)))
        case If() | While() | Until() | Label() | GoTo() | Simple() | Procedure():
            return _NOTHING
        case Declare() | Function() | Submodel() | Bare() | Invoke() | Faulty():
            return _NOTHING
        case (
            Term()
            | Sample()
            | Event()
            | Every()
            | Fast()
            | Show()
            | ShowArea()
            | Plot()
            | Display()
            | GraphText()
            | Drun()
            | Irule()
            | Seed()
        ):
            return _NOTHING
        case Data() | Restore() | Write() | Note() | Dump() | Connect() | Disconnect() | FileCommand():
            return _NOTHING
        case LoadData():
            return _NOTHING  # which tables it makes, the file says
    assert_never(node)


def segment_targets(program: Program) -> set[str]:
    """Return the scalars and elements that statements of DYNAMIC segments give values."""
    return {
        target.name
        for segment in program.segments
        for placed in segment.body
        for target in assigned(placed.node).targets
    }


def declared(node: Declare) -> tuple[str, ...]:
    """Return the names that a declaration gives memory, those of wholes included."""
    names: list[str] = []
    for group in node.groups:
        names += (part.name for part in group.parts)
        if group.whole is not None:
            names.append(group.whole)
    return tuple(names)


def dummies(node: Procedure | Function | Submodel) -> tuple[str, ...]:
    """Return the names that stand for arguments in the body of a definition."""
    return (*node.values, *node.references) if isinstance(node, Procedure) else node.dummies


def invocation(node: Statement) -> tuple[str, tuple[Expr, ...]] | None:
    """Return name and arguments of the submodel that a statement invokes: `invoke s(a)`, `s(a)`, `s[a]`."""
    if isinstance(node, Invoke):
        return node.name, node.args
    if isinstance(node, Bare) and isinstance(node.value, Call):
        return node.value.name, node.value.args
    if isinstance(node, Bare) and isinstance(node.value, Element):
        return node.value.name, node.value.subscripts
    return None
