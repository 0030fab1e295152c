"""The blocks, labels, definitions and data of a flat program, and every problem with them in one go.

A script is a flat list of statements; here each opener finds its closer, each `go to` its place.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from desire_tui.engine import nodes as n
from desire_tui.engine.diagnostics import Diagnostic, closest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.source import Source

CLOSERS: dict[type[n.Node], str] = {
    n.If: "proceed", n.For: "next", n.While: "end while", n.Procedure: "end", n.Submodel: "end",
}  # fmt: skip
"""The word that closes a block, by the class of its opener (`repeat`, a plain word, is closed by `until`)."""


@dataclass(frozen=True, slots=True)
class ProcedureText:
    """A PROCEDURE: its first line, and the places in the script of that line and of its `end`."""

    node: n.Procedure
    placed: n.Placed
    opens: int
    closes: int


@dataclass(frozen=True, slots=True)
class SubmodelText:
    """A SUBMODEL with its body's statements."""

    name: str
    dummies: tuple[str, ...]
    body: tuple[n.Placed, ...]
    placed: n.Placed


@dataclass(frozen=True)
class Structure:
    """What stands where. A *place* is an index into the script.

    `partner`: `if` → its `else`, or its `proceed` if it has none; `else` → its `proceed`; every other
    opener → its closer; every closer → its opener. `exits`: `exit` → the closer of the loop it leaves, or
    None for a PROCEDURE's return. `inside`: per statement the innermost open `if`, `else`, loop or
    definition, −1 outside of all. `data`: places of the data statements. `segment_partner`: per segment (by
    its label) the same as `partner` for `if`, `else` and `end if` in its body; an `if` without `end if` has
    none and rules the rest of the segment.
    """

    partner: dict[int, int] = field(default_factory=dict)
    exits: dict[int, int | None] = field(default_factory=dict)
    inside: list[int] = field(default_factory=list)
    labels: dict[str, int] = field(default_factory=dict)
    numbers: dict[int, int] = field(default_factory=dict)
    procedures: dict[str, ProcedureText] = field(default_factory=dict)
    submodels: dict[str, SubmodelText] = field(default_factory=dict)
    functions: dict[str, n.Placed] = field(default_factory=dict)
    data: list[int] = field(default_factory=list)
    segment_partner: dict[str | None, dict[int, int]] = field(default_factory=dict)
    problems: tuple[Diagnostic, ...] = ()

    def place(self, target: str) -> int | None:
        """Return where a label or a line number (digits) stands in the script."""
        return self.numbers.get(int(target[:9])) if target.isdigit() else self.labels.get(target)


def structure(program: n.Program) -> Structure:
    """Find the structure of a program. Never raises: the problems are in the result."""
    # Where an opener or closer could not be parsed, its partner is not the user's second mistake.
    broken = any(p.facts.get("word") in _BLOCK_WORDS for p in program.problems)
    survey = _Survey(program.script, program.source, broken)
    survey.script()
    known = {segment.label for segment in program.segments}
    survey.jumps(known)
    survey.segments(program.segments)
    return survey.finished()


def script_structure(script: Sequence[n.Placed], source: Source) -> Structure:
    """Return the structure of statements that stand alone, such as a command line."""
    survey = _Survey(tuple(script), source, broken=False)
    survey.script()
    survey.jumps(None)
    return survey.finished()


_BLOCK_WORDS = frozenset(
    "if else proceed for next while repeat until end PROCEDURE SUBMODEL".split()  # noqa: SIM905
) | {"end if", "end while"}


@dataclass(slots=True)
class _Open:
    """An open block: its opener's place, the word that closes it, where its `else` stands."""

    place: int
    closer: str
    middle: int = -1

    @property
    def innermost(self) -> int:
        return self.place if self.middle < 0 else self.middle


class _Survey:
    def __init__(self, script: tuple[n.Placed, ...], source: Source, broken: bool) -> None:
        self.statements, self.source, self.broken = script, source, broken
        self.found = Structure()
        self.problems: list[Diagnostic] = []
        self.open: list[_Open] = []
        self.parents: dict[int, int] = {}
        self.defined: dict[str, int] = {}

    def finished(self) -> Structure:
        self.problems.sort(key=lambda p: p.span or (0, 0))
        found = self.found
        return Structure(
            found.partner, found.exits, found.inside, found.labels, found.numbers, found.procedures,
            found.submodels, found.functions, found.data, found.segment_partner, tuple(self.problems),
        )  # fmt: skip

    def report(self, key: str, placed: n.Placed, *related: Diagnostic, **facts: object) -> None:
        self.problems.append(Diagnostic(key, placed.span(), facts, self.source, related=related))

    def also(self, key: str, place: int) -> Diagnostic:
        """Point at a second place."""
        return Diagnostic(key, self.statements[place].span(), {}, self.source)

    # ------------------------------------------------------------------------------------- the script

    def script(self) -> None:
        """Walk the script once."""
        found = self.found
        for place, placed in enumerate(self.statements):
            found.inside.append(self.open[-1].innermost if self.open else -1)
            if placed.number is not None:
                found.numbers.setdefault(placed.number, place)
            node = placed.node
            match node:
                case n.Assign():
                    pass
                case n.Bare(n.Call(name)) if not self._in_submodel():
                    self.report("call-missing", placed, name=name)
                case n.If():
                    self._if(place, placed, node)
                case n.For() | n.While():
                    self.opens(place, CLOSERS[type(node)])
                case n.Procedure() | n.Submodel():
                    self._definition(place, placed, node.name)
                case n.Function(name):
                    self._new_name(place, placed, name)
                    found.functions.setdefault(name, placed)
                case n.Until():
                    self.closes(place, placed, "until")
                case n.Label(name):
                    self._label(place, placed, name)
                case n.Data():
                    found.data.append(place)
                case n.Simple(word):
                    self._word(place, placed, word)
        for block in reversed(self.open):
            self._unclosed(block)

    def _word(self, place: int, placed: n.Placed, word: str) -> None:
        if word == "repeat":
            self.opens(place, "until")
        elif word == "else":
            self._else(place, placed)
        elif word == "exit":
            self._exit(place, placed)
        elif word in ("proceed", "next", "end while", "end"):
            self.closes(place, placed, word)
        elif word == "end if":
            if self._in_submodel():
                self.closes(place, placed, "proceed")
            else:
                self.report("end-if-in-script", placed)

    def _in_submodel(self) -> bool:
        return any(isinstance(self.statements[block.place].node, n.Submodel) for block in self.open)

    def opens(self, place: int, closer: str) -> None:
        """Begin a block."""
        self.parents[place] = self.found.inside[place]
        self.open.append(_Open(place, closer))

    def closes(self, place: int, placed: n.Placed, word: str) -> None:
        """End the innermost block that `word` can end; blocks left open inside are reported."""
        at = next((i for i in reversed(range(len(self.open))) if self.open[i].closer == word), None)
        if at is None:
            if not self.broken:
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
        if isinstance(opener.node, n.Procedure):
            text = ProcedureText(opener.node, opener, block.place, place)
            self.found.procedures.setdefault(opener.node.name, text)
        elif isinstance(opener.node, n.Submodel):
            self._submodel(opener, opener.node, block.place, place)

    def _unclosed(self, block: _Open) -> None:
        """Report an open block, unless it is one that may stay open: `if` in a submodel rules its rest."""
        opener = self.statements[block.place]
        if self.broken or (isinstance(opener.node, n.If) and opener.node.condition is None):
            return
        key = "unclosed-definition" if block.closer == "end" else "unclosed-block"
        word = self.source.text[opener.at : opener.at + 30].split()[0]
        self.report(key, opener, word=word, closer=block.closer)

    def _if(self, place: int, placed: n.Placed, node: n.If) -> None:
        if node.condition is None and not self._in_submodel():
            self.report("if-without-then", placed)
        elif node.condition is not None and self._in_submodel():
            self.report("then-in-segment", placed)
        self.opens(place, "proceed")

    def _else(self, place: int, placed: n.Placed) -> None:
        if not self.open or self.open[-1].closer != "proceed":
            if not self.broken:
                self.report("stray-else", placed, word="else")
            return
        block = self.open[-1]
        if block.middle >= 0:
            self.report("second-else", placed, self.also("first-else", block.middle))
            return
        block.middle = place
        self.parents[place] = self.parents[block.place]
        self.found.partner[block.place] = place

    def _exit(self, place: int, placed: n.Placed) -> None:
        for block in reversed(self.open):
            if block.closer != "proceed":
                self.found.exits[place] = block.place  # its closer, once it is known: see `jumps`
                return
        self.report("exit-nowhere", placed)

    def _definition(self, place: int, placed: n.Placed, name: str) -> None:
        if self.open:
            self.report(
                "nested-definition", placed, self.also("block-begins", self.open[-1].place), name=name
            )
        self._new_name(place, placed, name)
        self.opens(place, "end")

    def _new_name(self, place: int, placed: n.Placed, name: str) -> None:
        node = placed.node
        dummies = [*node.values, *node.references] if isinstance(node, n.Procedure) else list(node.dummies)  # type: ignore[attr-defined]
        twice = next((d for d in dummies if dummies.count(d) > 1), None)
        if twice is not None:
            self.report("dummy-twice", placed, name=twice)
        first = self.defined.setdefault(name, place)
        if first != place:
            self.report("defined-twice", placed, self.also("first-definition", first), name=name)

    def _submodel(self, opener: n.Placed, node: n.Submodel, opens: int, closes: int) -> None:
        body = self.statements[opens + 1 : closes]
        self.found.submodels.setdefault(node.name, SubmodelText(node.name, node.dummies, body, opener))

    def _label(self, place: int, placed: n.Placed, name: str) -> None:
        if name in self.found.labels:
            self.report("label-twice", placed, self.also("first-label", self.found.labels[name]), name=name)
        self.found.labels.setdefault(name, place)

    # ------------------------------------------------------------------------------------- jumps

    def jumps(self, segments: set[str | None] | None) -> None:
        """Check where every `go to` and `restore` leads, and give every `exit` its loop's end."""
        found = self.found
        for place, opener in found.exits.items():
            assert opener is not None
            is_loop = not isinstance(self.statements[opener].node, (n.Procedure, n.Submodel))
            found.exits[place] = found.partner.get(opener) if is_loop else None
        if segments is None:
            return  # a command line may name what the program has
        for place, placed in enumerate(self.statements):
            node = placed.node
            if isinstance(node, n.GoTo):
                self._jump(place, placed, node.target, segments)
            elif isinstance(node, n.Restore) and node.target and found.place(node.target) is None:
                self._unknown(placed, node.target)

    def _unknown(self, placed: n.Placed, target: str) -> None:
        known = map(str, self.found.numbers) if target.isdigit() else self.found.labels
        self.report("no-such-label", placed, name=target, close=closest(target, known))

    def _jump(self, place: int, placed: n.Placed, target: str, segments: set[str | None]) -> None:
        to = self.found.place(target)
        if to is None:
            if target in segments:
                self.report("jump-to-segment", placed, name=target)
            else:
                self._unknown(placed, target)
            return
        block = self.found.inside[to]
        if block >= 0 and block not in self._around(place):
            self.report("jump-inside", placed, self.also("block-begins", block), name=target)

    def _around(self, place: int) -> set[int]:
        """All blocks around a statement."""
        around = set()
        block = self.found.inside[place]
        while block >= 0:
            around.add(block)
            block = self.parents[block]
        return around

    # ------------------------------------------------------------------------------------- segments

    def segments(self, segments: Sequence[n.SegmentText]) -> None:
        """Match `if`, `else`, `end if` in the segments; a label may name one segment only."""
        seen: dict[str | None, n.SegmentText] = {}
        for segment in segments:
            if segment.label is not None and (segment.label in seen or segment.label in self.found.labels):
                start = n.Placed(n.Label(segment.label, 0, len("label ") + len(segment.label)), segment.at)
                self.report("label-twice", start, name=segment.label)
            seen.setdefault(segment.label, segment)
            partner = self.found.segment_partner.setdefault(segment.label, {})
            if seen[segment.label] is segment:
                self._segment(segment.body, partner)

    def _segment(self, body: Sequence[n.Placed], partner: dict[int, int]) -> None:
        opened: list[int] = []
        for place, placed in enumerate(body):
            node = placed.node
            if isinstance(node, n.If):
                if node.condition is not None:
                    self.report("then-in-segment", placed)
                opened.append(place)
            elif isinstance(node, n.Simple) and node.word in ("else", "end if", "proceed"):
                if not opened:
                    if not self.broken:
                        self.report("stray-else", placed, word=node.word)
                    continue
                last = opened.pop()
                if node.word == "else" and isinstance(body[last].node, n.Simple):
                    self.report("second-else", placed)
                partner[last] = place
                if node.word == "else":
                    opened.append(place)
                else:
                    partner[place] = last
