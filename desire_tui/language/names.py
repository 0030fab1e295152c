"""Every name of a program where it stands: what it means there, and whether it is given a value or read.

language.md 3: one name space for all variables of script and segments. Arguments of FUNCTIONs, SUBMODELs and
PROCEDUREs are their own (4.2, 9.6, 5), those of SUBMODELs that are declared as arrays before excepted: the
declaration belongs to the argument.
"""

from __future__ import annotations

from bisect import bisect_right
from functools import cached_property
from typing import TYPE_CHECKING, Literal, NamedTuple

from desire_tui.engine.check.declared import DeclaredNames
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.graph.units import named_in
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.nodes.control import Label, Procedure
from desire_tui.engine.nodes.declarations import Declare, Function, Submodel
from desire_tui.engine.nodes.display import GraphText
from desire_tui.engine.nodes.names import assigned, declared, dummies, invocation
from desire_tui.engine.nodes.segment import Derivative, VectorDerivative
from desire_tui.engine.structure.structure import structure
from desire_tui.engine.syntax.statement_tokens import NAME, STRING
from desire_tui.engine.values import SYSTEM_VARIABLES
from desire_tui.language.read_statements import read_program

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.source import Source
    from desire_tui.engine.syntax.statement_tokens import StatementTokens
    from desire_tui.language.read_statements import ReadStatement

SymbolKind = Literal["variable", "function", "procedure", "submodel", "label", "system", "library"]
Use = Literal["declared", "derivative", "assigned", "read"]

_LABELLED = frozenset({"label", "go to", "restore", "drun", "drunr"})
_SECOND: dict[str, SymbolKind] = {
    "PROCEDURE": "procedure", "call": "procedure", "SUBMODEL": "submodel", "invoke": "submodel",
    "FUNCTION": "function",
}  # fmt: skip
"""What the name behind such a word is."""
_TABLED = frozenset({"tdelay", "delay", "func", "func2", "CLEARN"})
"""Statements with an array before a parenthesis: `tdelay y = D(x, tau`."""
_CLOSING = frozenset({")", "]"})


@dataclass(frozen=True, slots=True)
class Symbol:
    """What a name means. `scope` is the offset of the definition whose argument it is, else None."""

    name: str
    kind: SymbolKind
    scope: int | None = None

    @property
    def is_own(self) -> bool:
        """Whether it is the program's, not the language's."""
        return self.kind not in {"system", "library"}


class Occurrence(NamedTuple):
    """A name in the text, `start` … `end - 1`; `statement` is the offset of the statement it stands in."""

    start: int
    end: int
    symbol: Symbol
    use: Use
    statement: int


class _Scope(NamedTuple):
    """A definition's body in the text, and its arguments."""

    start: int
    end: int
    names: frozenset[str]


class ProgramNames:
    """The names of one text. Never raises: what cannot be read has no names."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.program, self.statements = read_program(source)
        self.structure = structure(self.program)
        self.declared = DeclaredNames(self.program, self.structure)
        self._variables = self.declared.everything
        self._complex = any(
            isinstance(p.node, Declare) and p.node.kind == "COMPLEX" for p in self.program.script
        )
        self._scopes = _scopes(self)
        self.occurrences = [found for read in self.statements for found in self._of(read)]
        self._starts = [found.start for found in self.occurrences]

    @property
    def dynamic(self) -> int:
        """Offset of the line DYNAMIC; the text's length if there is none."""
        segments = self.program.segments
        return segments[0].at if segments else len(self.source.text)

    def at(self, offset: int) -> Occurrence | None:
        """Return the name that stands at an offset, or ends there."""
        place = bisect_right(self._starts, offset) - 1
        for found in self.occurrences[max(place, 0) : place + 1]:
            if found.start <= offset <= found.end:
                return found
        return None

    def of(self, symbol: Symbol) -> tuple[Occurrence, ...]:
        """Return all places of a symbol, in the order of the text."""
        return self._by_symbol.get(symbol, ())

    def definition(self, symbol: Symbol) -> Occurrence | None:
        """Return where a symbol gets its meaning: declared, else `d/dt`, a segment's, the script's first."""
        places = self.of(symbol)
        for use in ("declared", "derivative"):
            found = next((place for place in places if place.use == use), None)
            if found is not None:
                return found
        given = [place for place in places if place.use == "assigned"]
        return next((place for place in given if place.start > self.dynamic), given[0] if given else None)

    def first_value(self, symbol: Symbol) -> Occurrence | None:
        """Return where the script first gives a symbol a value, or declares it."""
        given = (place for place in self.of(symbol) if place.use != "read")
        return next((place for place in given if place.start < self.dynamic), None)

    def statement(self, at: int) -> ReadStatement | None:
        """Return the statement that begins at an offset."""
        return self._by_offset.get(at)

    @cached_property
    def symbols(self) -> tuple[Symbol, ...]:
        """All symbols in the order of their first places."""
        return tuple(self._by_symbol)

    @cached_property
    def _by_symbol(self) -> dict[Symbol, tuple[Occurrence, ...]]:
        found: dict[Symbol, list[Occurrence]] = {}
        for occurrence in self.occurrences:
            found.setdefault(occurrence.symbol, []).append(occurrence)
        return {symbol: tuple(places) for symbol, places in found.items()}

    @cached_property
    def _by_offset(self) -> dict[int, ReadStatement]:
        return {read.at: read for read in self.statements}

    # ---------------------------------------------------------------------------------------- one statement

    def _of(self, read: ReadStatement) -> Iterator[Occurrence]:
        node, tokens, at = read
        given = _given(node, tokens)
        scope = self._scope_at(at, node)
        for place, kind in enumerate(tokens.kinds):
            start = at + tokens.starts[place]
            if kind == NAME:
                symbol = self._symbol(read, place, scope)
                yield Occurrence(start, at + tokens.ends[place], symbol, given.get(place, "read"), at)
            elif kind == STRING and isinstance(node, GraphText) and node.part == "units":
                for offset, name in named_in(node.text):
                    begins = start + 1 + offset
                    if self.source.text[begins : begins + len(name)] == name:  # else `_` joins rows in it
                        yield Occurrence(begins, begins + len(name), self._variable(name), "read", at)

    def _scope_at(self, at: int, node: Statement) -> _Scope | None:
        if isinstance(node, Function):
            return _Scope(at, at, frozenset(node.dummies))
        return next((scope for scope in self._scopes if scope.start <= at < scope.end), None)

    def _symbol(self, read: ReadStatement, place: int, scope: _Scope | None) -> Symbol:
        node, tokens, _ = read
        kinds, name = tokens.kinds, tokens.texts[place]
        if kinds[0] in _LABELLED:
            return Symbol(name, "label")
        if place == 1 and kinds[0] in _SECOND:
            return Symbol(name, _SECOND[kinds[0]])
        if scope is not None and name in scope.names:
            return Symbol(name, "variable", scope.start)
        if place == 0 and invocation(node) is not None:
            return Symbol(name, "submodel")
        tabled = kinds[0] in _TABLED and kinds[place - 1] == "="
        if kinds[place + 1 : place + 2] == ["("] and not tabled:
            return self._called(name)
        return self._variable(name)

    def _called(self, name: str) -> Symbol:
        if name in self.structure.functions:
            return Symbol(name, "function")
        if name in LIBRARY:
            return Symbol(name, "library")
        return Symbol(name, "variable" if name in self._variables else "function")

    def _variable(self, name: str) -> Symbol:
        system = name in SYSTEM_VARIABLES or (name == "j" and self._complex)
        return Symbol(name, "system" if system else "variable")


def _scopes(names: ProgramNames) -> list[_Scope]:
    """Return where arguments of PROCEDUREs and SUBMODELs hold; definitions do not nest."""
    script = names.program.script
    arrays = {name for placed in script if isinstance(placed.node, Declare) for name in declared(placed.node)}
    found = []
    for place, placed in enumerate(script):
        node = placed.node
        if isinstance(node, Procedure | Submodel):
            closes = names.structure.partner.get(place)
            own = frozenset(dummies(node))
            own -= arrays if isinstance(node, Submodel) else frozenset()
            end = names.dynamic if closes is None else script[closes].at
            found.append(_Scope(placed.at, end, own))
    return found


def _given(node: Statement, tokens: StatementTokens) -> dict[int, Use]:
    """Return which tokens of a statement are names that it declares or gives a value."""
    kinds, texts = tokens.kinds, tokens.texts
    if isinstance(node, Procedure | Submodel | Function):
        last = next((i for i, kind in enumerate(kinds) if kind in _CLOSING), len(kinds))
        return {i: "declared" for i in range(1, last) if kinds[i] == NAME}
    if isinstance(node, Label):
        return {1: "declared"}
    if isinstance(node, Declare):
        starts = {part.start for group in node.groups for part in group.parts}
        return {
            i: "declared" for i, kind in enumerate(kinds)
            if kind == NAME and (tokens.starts[i] in starts or kinds[i - 1] == "=")
        }  # fmt: skip
    use: Use = "derivative" if isinstance(node, Derivative | VectorDerivative) else "assigned"
    targets, arrays = assigned(node)
    starts = {target.start for target in targets}
    found = {i: use for i, kind in enumerate(kinds) if kind == NAME and tokens.starts[i] in starts}
    for name in arrays:
        if name in texts:
            found[texts.index(name)] = use
    if not found and kinds[:2] == [NAME, "="]:
        found[0] = "assigned"  # of a statement whose rest cannot be read
    return found
