"""A segment's code as plain data: with it a later process writes none of the passes as text again.

Then nothing reads the segment's statements before its run (`lowered.deferred_segment`).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.pieces.piece_tables import PieceTables
from desire_tui.engine.codegen.pieces.segment_passes import passes_of
from desire_tui.engine.integration.rules import rule_numbered

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from desire_tui.engine.codegen.jit.cache import CodeCache, Compiled, Files
    from desire_tui.engine.codegen.jit.piece import Piece
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action

    Passes = Mapping[str, tuple[Action, ...]]


class NotedCode(NamedTuple):
    """Plain data."""

    rule: int
    vital: tuple[int, ...]
    """See `passes.vital_columns`."""
    passes: tuple[tuple[str, tuple[str, ...]], ...]
    """Each pass's pieces by name."""
    temps: int
    quick: Files
    fast: Files


def noted_code(store: CodeCache, rule: int, vital: Sequence[int], tables: PieceTables) -> NotedCode | None:
    """Return what is to be noted of a segment; None: later processes would not find all of its code.

    The segment is one that the rule integrates as it is, without switches. None of its pieces is called with
    data: whether one is depends on what else the process has run.
    """
    files = store.files(tuple(tables.pieces.values()))
    if files is None or any(data is not None for calls in tables.calls.values() for _, data in calls):
        return None
    names = tuple((kind, tuple(name for name, _ in calls)) for kind, calls in tables.calls.items())
    return NotedCode(rule, tuple(vital), names, tables.temps, *files)


def found_again(
    store: CodeCache, segment: Segment, rule: int
) -> tuple[Sequence[int], Passes, PieceTables] | None:
    """Return a segment's vital columns, passes and tables by what was noted of it.

    None: it was for another rule, or some code is not there, as on another machine.
    """
    if not isinstance(segment.noted, tuple) or len(segment.noted) != len(NotedCode._fields):
        return None
    known = NotedCode(*segment.noted)
    code = store.load(known.quick, fast=False) if known.rule == rule else None
    if code is None:
        return None
    variable = rule_numbered(rule).kind == "variable"
    kinds = tuple(kind for kind, _ in known.passes)
    passes = _DeferredPasses(kinds, lambda: passes_of(segment, variable=variable))
    return known.vital, passes, _NotedTables(store, known, code, passes)


class _DeferredPasses(Mapping[str, "tuple[Action, ...]"]):
    """Passes that are made when one of them is wanted."""

    def __init__(self, kinds: tuple[str, ...], make: Callable[[], Passes]) -> None:
        self._kinds, self._make = kinds, make
        self._made: Passes | None = None

    def __getitem__(self, kind: str) -> tuple[Action, ...]:
        if self._made is None:
            self._made = self._make()
        return self._made[kind]

    def __iter__(self) -> Iterator[str]:
        return iter(self._kinds)

    def __len__(self) -> int:
        return len(self._kinds)


class _NotedTables(PieceTables):
    """Tables of code whose pieces are written as text only where their fast code is not on disk."""

    def __init__(
        self, store: CodeCache, known: NotedCode, code: Mapping[str, Compiled], passes: Passes
    ) -> None:
        self._store, self._passes = store, passes
        self._files = {names[0]: ((file, names),) for file, names in known.fast}
        self._written: Mapping[str, Piece] | None = None
        self._code = code
        calls = {kind: [(name, None) for name in names] for kind, names in known.passes}
        self._lay_out(calls, known.temps, code)

    @property
    def pieces(self) -> Mapping[str, Piece]:
        if self._written is None:
            self._written = PieceTables(self._store, self._passes).pieces
        return self._written

    def _fast(self, name: str) -> Compiled:
        found = self._store.load(self._files[name], fast=True)
        if found is not None:
            return found[name]
        return (
            super()._fast(name) if name in self.pieces else self._code[name]
        )  # it would be called with data
