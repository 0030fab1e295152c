"""Productions of the experiment-protocol script."""

# ruff: noqa: D102 - each method is named after its production in desire.lark

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Seed
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Declared, DeclaredGroup, Function, Submodel
from desire_tui.engine.nodes.display import Display, GraphText, Plot, Show, ShowArea
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
from desire_tui.engine.nodes.segment import Invoke
from desire_tui.engine.syntax.build.children import (
    Kids,
    Misuse,
    Token,
    channel_of,
    condition,
    halves,
    items_in,
    names_in,
    nodes_in,
    plain,
)

if TYPE_CHECKING:
    from desire_tui.engine.nodes.record import Node
    from desire_tui.engine.nodes.statements import Statement

DIMENSIONS_MAX = 10


class ScriptProductions:
    """Blocks, jumps, declarations, input and output, graphs."""

    def if_then(self, kids: Kids, first: int, last: int) -> Statement:
        return If(condition(kids[1]), None, first, last)

    def if_positive(self, kids: Kids, first: int, last: int) -> Statement:
        """`if x > 2` in a segment is `if (x > 2)`; in a script `structure` reports the missing `then`."""
        return If(None, plain(kids[1]), first, last)

    def for_(self, kids: Kids, first: int, last: int) -> Statement:
        by = plain(kids[7]) if len(kids) > 6 else None
        return For(kids[1], plain(kids[3]), plain(kids[5]), by, first, last)

    def while_(self, kids: Kids, first: int, last: int) -> Statement:
        return While(condition(kids[1]), first, last)

    def until(self, kids: Kids, first: int, last: int) -> Statement:
        return Until(condition(kids[1]), first, last)

    def label(self, kids: Kids, first: int, last: int) -> Statement:
        return Label(kids[1], first, last)

    def go_to(self, kids: Kids, first: int, last: int) -> Statement:
        return GoTo(kids[1], first, last)

    def restore(self, kids: Kids, first: int, last: int) -> Statement:
        return Restore(kids[1] if len(kids) > 1 else None, first, last)

    def call_procedure(self, kids: Kids, first: int, last: int) -> Statement:
        values, references = halves(kids[3:-1])
        return CallProcedure(
            kids[1], tuple(map(plain, nodes_in(values))), tuple(map(plain, nodes_in(references))), first, last
        )

    def invoke(self, kids: Kids, first: int, last: int) -> Statement:
        return Invoke(kids[1], tuple(map(plain, nodes_in(kids[3:-1]))), first, last)

    def drun(self, kids: Kids, first: int, last: int) -> Statement:
        star = len(kids) > 1 and kids[1].kind == "*"
        label = kids[1] if len(kids) > 1 and not star else None
        return Drun(label, kids[0].kind == "drunr", star, first, last)

    def declare(self, kids: Kids, first: int, last: int) -> Statement:
        groups = nodes_in(kids)
        for part in (part for group in groups for part in group.parts):
            if kids[0].kind == "ARRAY" and not part.dimensions:
                raise Misuse("dimensions-missing", part.start, part.end)
        return Declare(kids[0].kind, groups, first, last)

    def declared_group(self, kids: Kids, first: int, last: int) -> Node:
        whole = kids[-1] if isinstance(kids[-1], Token) else None
        if whole is None and len(nodes_in(kids)) > 1:
            raise Misuse("overlay-nameless", first, last)
        return DeclaredGroup(nodes_in(kids), whole, first, last)

    def declared(self, kids: Kids, first: int, last: int) -> Node:
        dimensions = tuple(map(plain, nodes_in(kids)))
        if len(dimensions) > DIMENSIONS_MAX:
            raise Misuse("dimensions-too-many", first, last, {"limit": DIMENSIONS_MAX})
        return Declared(kids[0], dimensions, first, last)

    def procedure(self, kids: Kids, first: int, last: int) -> Statement:
        values, references = halves(kids[2:])
        return Procedure(kids[1], names_in(values), names_in(references), first, last)

    def submodel(self, kids: Kids, first: int, last: int) -> Statement:
        return Submodel(kids[1], names_in(kids[2:]), first, last)

    def function(self, kids: Kids, first: int, last: int) -> Statement:
        return Function(kids[1], names_in(kids[2:]), plain(kids[-1]), first, last)

    def data(self, kids: Kids, first: int, last: int) -> Statement:
        return Data(tuple(map(plain, nodes_in(kids))), first, last)

    def load_data(self, kids: Kids, first: int, last: int) -> Statement:
        return LoadData(kids[1], first, last)

    def read(self, kids: Kids, first: int, last: int) -> Statement:
        return Read(nodes_in(kids), first, last)

    def input(self, kids: Kids, first: int, last: int) -> Statement:
        channel, rest = channel_of(kids)
        return Input(channel, nodes_in(rest), first, last)

    def write(self, kids: Kids, first: int, last: int) -> Statement:
        channel, rest = channel_of(kids)
        raw = channel is not None and kids[1].kind == "##"
        return Write(channel, raw, items_in(rest), first, last)

    def note(self, kids: Kids, first: int, last: int) -> Statement:
        return Note(items_in(kids[1:]), first, last)

    def item(self, kids: Kids, first: int, last: int) -> Node:
        form: Any = kids[0].kind if len(kids) > 1 else ""
        return WriteItem(plain(kids[-1]), form, "", first, last)

    def connect(self, kids: Kids, first: int, last: int) -> Statement:
        return Connect(kids[1], kids[3].kind, plain(kids[4]), first, last)

    def disconnect(self, kids: Kids, first: int, last: int) -> Statement:
        return Disconnect(tuple(map(plain, nodes_in(kids))), first, last)

    def dump(self, kids: Kids, first: int, last: int) -> Statement:
        if len(kids) > 1 and kids[1].kind == "run":
            return Dump(None, "run", first, last)
        return Dump(plain(kids[2]) if len(kids) > 2 else None, "all", first, last)

    def irule(self, kids: Kids, first: int, last: int) -> Statement:
        return Irule(plain(kids[1]) if len(kids) > 1 else None, first, last)

    def seed(self, kids: Kids, first: int, last: int) -> Statement:
        return Seed(plain(kids[1]), first, last)

    def fft(self, kids: Kids, first: int, last: int) -> Statement:
        args = tuple(map(plain, nodes_in(kids)))
        if len(args) != (5 if kids[1] == "R" else 3):
            raise Misuse("fft-form", first, last)
        return Fft(kids[1], args, first, last)

    def display(self, kids: Kids, first: int, last: int) -> Statement:
        mode, args = kids[1], tuple(map(plain, nodes_in(kids)))
        wanted = {"C": 1, "N": 1, "W": 2}.get(mode, 0)
        if len(args) != wanted:
            raise Misuse(
                "display-form",
                first,
                last,
                {"mode": str(mode), "wanted": ("no numbers", "one number", "two numbers")[wanted]},
            )
        return Display(mode, args, first, last)

    def graph_text(self, kids: Kids, first: int, last: int) -> Statement:
        return GraphText(kids[0].kind, kids[1], first, last)

    def plot(self, kids: Kids, first: int, last: int) -> Statement:
        args = tuple(map(plain, nodes_in(kids)))
        if len(args) > 3:
            raise Misuse("plot-form", first, last)
        return Plot(args, first, last)

    def show(self, kids: Kids, first: int, last: int) -> Statement:
        return Show(kids[1], plain(kids[3]) if len(kids) > 3 else None, first, last)

    def show_area(self, kids: Kids, first: int, last: int) -> Statement:
        return ShowArea(len(kids) > 1, first, last)

    def file_command(self, kids: Kids, first: int, last: int) -> Statement:
        return FileCommand(kids[0].kind, kids[1] if len(kids) > 1 else None, first, last)
