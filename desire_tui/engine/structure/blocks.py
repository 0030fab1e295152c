"""One walk through a flat script: each opener finds its closer."""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Seed, Simple
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Function, Submodel
from desire_tui.engine.nodes.display import Display, GraphText, Plot, Show, ShowArea
from desire_tui.engine.nodes.expressions import Call, Element
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
from desire_tui.engine.nodes.names import dummies
from desire_tui.engine.nodes.statements import SegmentOnlyStatement
from desire_tui.engine.structure.outline import ProcedureText, Structure, SubmodelText
from desire_tui.engine.values import SYSTEM_VARIABLES

if TYPE_CHECKING:
    from desire_tui.engine.nodes.commands import Word
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.source import Source


CLOSERS = {
    "if": "proceed", "for": "next", "while": "end while", "repeat": "until", "PROCEDURE": "end",
    "SUBMODEL": "end",
}  # fmt: skip
"""The word that closes what another opens."""
ENDS = frozenset(CLOSERS.values())
MISMATCHES = frozenset({"stray-end", "stray-else", "stray-closer", "unclosed-block", "unclosed-definition"})
"""What is no second mistake of the user where another opener or closer cannot be read."""


@dataclass(slots=True)
class _Open:
    """An open block: its opener's place, the word that closes it, where its `else` stands."""

    place: int
    closer: str
    in_submodel: bool
    middle: int = -1

    @property
    def innermost(self) -> int:
        return self.place if self.middle < 0 else self.middle


class BlockSurvey:
    """One walk through a script: finds partners, labels, definitions, and what is wrong with them."""

    def __init__(self, script: tuple[Placed, ...], source: Source, broken: bool) -> None:
        self.statements, self.source, self.broken = script, source, broken
        self.found = Structure()
        self.problems: list[Diagnostic] = []
        self.open: list[_Open] = []
        self.parents: dict[int, int] = {}
        self.defined: dict[str, int] = {}

    def finished(self) -> Structure:
        """Return what was found, problems in the order of their places."""
        self.problems.sort(key=lambda p: p.span or (0, 0))
        return replace(self.found, problems=tuple(self.problems))

    def report(self, key: str, placed: Placed, *related: Diagnostic, **facts: object) -> None:
        """Note an error of a statement: a program that gets there is stopped by its first one."""
        if isinstance(placed.node, Faulty):
            return  # that it cannot be read has been said
        problem = Diagnostic(key, placed.span(), facts, self.source, related=related)
        if key not in MISMATCHES or not self.broken:
            self.problems.append(problem)
        self.found.faults.setdefault(placed.at, problem)

    def warn(self, key: str, placed: Placed, **facts: object) -> None:
        """Note what is legal but hardly meant."""
        self.problems.append(Diagnostic(key, placed.span(), facts, self.source, "warning"))

    def also(self, key: str, place: int) -> Diagnostic:
        """Point at a second place."""
        return Diagnostic(key, self.statements[place].span(), {}, self.source)

    # ------------------------------------------------------------------------------------- the script

    def script(self) -> None:
        """Walk the script once."""
        found = self.found
        for place, placed in enumerate(self.statements):
            cancellation_point()
            found.inside.append(self.open[-1].innermost if self.open else -1)
            if placed.number is not None:
                found.numbers.setdefault(placed.number, place)
            self._statement(place, placed)
        for block in reversed(self.open):
            self._unclosed(block)

    def find_line_numbers(self, lines: tuple[tuple[int, int], ...]) -> None:
        """Give lines without statements, or all of a program without numbers, the places that jumps need."""
        offsets = [placed.at for placed in self.statements]
        for number, start in lines:
            place = bisect_left(offsets, start)
            if place < len(offsets):
                self.found.numbers.setdefault(number, place)

    def _statement(self, place: int, placed: Placed) -> None:
        """Note what a statement opens, closes or defines; segments' own statements do nothing of it."""
        node = placed.node
        match node:
            case Assign() | Dot() | MatrixAssign() | VectorAssign() | Declare():
                return None
            case Bare():
                if not self._in_submodel():
                    self._alone(placed, node)
                return None
            case If():
                return self._if(place, placed, node)
            case For():
                return self.opens(place, "next")
            case While():
                return self.opens(place, "end while")
            case Until():
                return self.closes(place, placed, "until")
            case Procedure() | Submodel():
                return self._definition(place, placed, node)
            case Faulty(word):
                return self._faulty(place, placed, word)
            case Function(name):
                self._not_in_definition(placed, name)
                self._new_name(place, placed, node)
                if placed.at not in self.found.faults:
                    self.found.functions.setdefault(name, placed)
                return None
            case Label(name):
                return self._label(place, placed, name)
            case Data():
                self.found.data.append(place)
                return None
            case Simple(word):
                return self._word(place, placed, word)
            case GoTo() | CallProcedure() | Drun() | Restore():
                return None  # where they lead is checked when all is known
            case Read() | Input() | Write() | Connect() | Disconnect() | Dump() | Note() | FileCommand():
                return None
            case LoadData():
                return None
            case Irule() | Seed() | Fft() | Display() | GraphText() | Plot() | Show() | ShowArea():
                return None
        if isinstance(node, SegmentOnlyStatement):
            return None
        assert_never(node)

    def _alone(self, placed: Placed, node: Bare) -> None:
        """Only a submodel's body has calls and, in either bracket, invocations that stand alone."""
        if isinstance(node.value, Call):
            self.report("call-missing", placed, name=node.value.name)
        elif isinstance(node.value, Element):
            self.report("expression-alone", placed)

    def _faulty(self, place: int, placed: Placed, word: str) -> None:
        """Let a statement that cannot be read open and close what its word does."""
        if word in CLOSERS:
            self.opens(place, CLOSERS[word])
        elif word == "else":
            self._else(place, placed)
        elif word in ENDS:
            self.closes(place, placed, word)
        elif word == "end if" and self._in_submodel():
            self.closes(place, placed, "proceed")
        elif word == "data":
            self.found.data.append(place)

    def _word(self, place: int, placed: Placed, word: Word) -> None:
        match word:
            case "repeat":
                self.opens(place, "until")
            case "else":
                self._else(place, placed)
            case "exit":
                self._exit(place, placed)
            case "proceed" | "next" | "end while" | "end":
                self.closes(place, placed, word)
            case "end if":
                if self._in_submodel():
                    self.closes(place, placed, "proceed")
                else:
                    self.report("end-if-in-script", placed)
            case _:
                return  # commands

    def _in_submodel(self) -> bool:
        return bool(self.open) and self.open[-1].in_submodel

    def opens(self, place: int, closer: str) -> None:
        """Begin a block."""
        self.parents[place] = self.found.inside[place]
        node = self.statements[place].node
        is_submodel = isinstance(node, Submodel) or (isinstance(node, Faulty) and node.word == "SUBMODEL")
        self.open.append(_Open(place, closer, is_submodel or self._in_submodel()))

    def closes(self, place: int, placed: Placed, word: str) -> None:
        """End the innermost block that `word` can end; blocks left open inside are reported."""
        at = next((i for i in reversed(range(len(self.open))) if self.open[i].closer == word), None)
        if at is None:
            key = {"end": "stray-end", "proceed": "stray-else"}.get(word, "stray-closer")
            self.report(key, placed, word=word)
            return
        for block in reversed(self.open[at + 1 :]):
            self._unclosed(block)
        block = self.open[at]
        del self.open[at:]
        partner = self.found.partner
        partner[block.place] = place
        if block.middle >= 0:
            partner[block.place], partner[block.middle] = block.middle, place
        partner[place] = block.place
        opener = self.statements[block.place]
        if opener.at in self.found.faults:
            return  # a definition that is wrong cannot be used
        if isinstance(opener.node, Procedure):
            text = ProcedureText(opener.node, opener, block.place, place)
            self.found.procedures.setdefault(opener.node.name, text)
        elif isinstance(opener.node, Submodel):
            self._submodel(opener, opener.node, block.place, place)

    def _unclosed(self, block: _Open) -> None:
        """Report an open block, unless it is one that may stay open: `if` in a submodel rules its rest."""
        opener = self.statements[block.place]
        if isinstance(opener.node, If) and opener.node.condition is None:
            return
        key = "unclosed-definition" if block.closer == "end" else "unclosed-block"
        word = self.source.word(opener.at)
        self.report(key, opener, word=word, closer=block.closer)

    def _if(self, place: int, placed: Placed, node: If) -> None:
        if node.condition is None and not self._in_submodel():
            self.report("if-without-then", placed)
        elif node.condition is not None and self._in_submodel():
            self.report("then-in-segment", placed)
        self.opens(place, "proceed")

    def _else(self, place: int, placed: Placed) -> None:
        if not self.open or self.open[-1].closer != "proceed":
            self.report("stray-else", placed, word="else")
            return
        block = self.open[-1]
        if block.middle >= 0:
            self.report("second-else", placed, self.also("first-else", block.middle))
            return
        block.middle = place
        self.parents[place] = self.parents[block.place]
        self.found.partner[block.place] = place

    def _exit(self, place: int, placed: Placed) -> None:
        for block in reversed(self.open):
            if block.closer != "proceed":
                self.found.exits[place] = block.place  # its closer, once it is known: see `jumps`
                return
        self.report("exit-nowhere", placed)

    def _definition(self, place: int, placed: Placed, node: Procedure | Submodel) -> None:
        if self.open:
            self.report(
                "nested-definition", placed, self.also("block-begins", self.open[-1].place), name=node.name
            )
        self._new_name(place, placed, node)
        self.opens(place, "end")

    def _not_in_definition(self, placed: Placed, name: str) -> None:
        """Report a FUNCTION in a PROCEDURE or SUBMODEL, whose dummies it could not see."""
        for block in self.open:
            if isinstance(self.statements[block.place].node, Procedure | Submodel):
                self.report("nested-definition", placed, self.also("block-begins", block.place), name=name)

    def _new_name(self, place: int, placed: Placed, node: Procedure | Function | Submodel) -> None:
        name, own = node.name, dummies(node)
        twice = next((dummy for dummy in own if own.count(dummy) > 1), None)
        if twice is not None:
            self.report("dummy-twice", placed, name=twice)
        if name in SYSTEM_VARIABLES or name == "PI":
            self.report("system-variable-declared", placed, name=name)
        first = self.defined.setdefault(name, place)
        if first != place:
            self.report("defined-twice", placed, self.also("first-definition", first), name=name)

    def _submodel(self, opener: Placed, node: Submodel, opens: int, closes: int) -> None:
        body = self.statements[opens + 1 : closes]
        self.found.submodels.setdefault(node.name, SubmodelText(node.name, node.dummies, body, opener))

    def _label(self, place: int, placed: Placed, name: str) -> None:
        if name in self.found.labels:
            self.report("label-twice", placed, self.also("first-label", self.found.labels[name]), name=name)
        self.found.labels.setdefault(name, place)
