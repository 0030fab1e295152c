"""Lowered scalar expressions, cached by the node they came from: a one-line edit lowers one line anew.

The parser returns the same node for the same text. What an expression of names, numbers and library functions
becomes depends on nothing but the slots its names stand for: if all of them can be read without more ado
(`Flow.ready`) and have the slots they had, the value of the last time holds again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.lowered.expressions import Load
from desire_tui.engine.lowering.lowering_context import UNKNOWN_SLOT
from desire_tui.engine.lowering.scope import LiveScope
from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.nodes.assignments import Assign
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.segment import Derivative

ROOM = 5_000
"""Expressions of earlier programs in a cache: some 2 KB each."""


class Cached(NamedTuple):
    """What an expression became, and the slots of its names; `node` is held so that its id stays taken.

    By statements that have forms (`written_lines`), what theirs became.
    """

    node: Expr | Derivative | Assign
    reads: tuple[tuple[str, int], ...]
    value: Value


class Stretch(NamedTuple):
    """What neighbouring statements with forms became, and the slots of all their names."""

    nodes: Sequence[Derivative | Assign]
    reads: tuple[tuple[str, int], ...]
    values: list[Value]


_live: RecentlyUsed[int, Cached] = RecentlyUsed(ROOM)
_checked: RecentlyUsed[int, Cached] = RecentlyUsed(ROOM)
"""Checks number the slots in their own way."""


_live_stretches: RecentlyUsed[tuple[int, ...], Stretch] = RecentlyUsed(ROOM, cost=len)
_checked_stretches: RecentlyUsed[tuple[int, ...], Stretch] = RecentlyUsed(ROOM, cost=len)
"""By the ids of their nodes: names are looked up once for all of them."""


def stretches_of(context: LoweringContext) -> RecentlyUsed[tuple[int, ...], Stretch]:
    """Return the stretches of statements lowered in scopes of this kind."""
    return _live_stretches if isinstance(context.scope, LiveScope) else _checked_stretches


def cache_of(context: LoweringContext) -> RecentlyUsed[int, Cached]:
    """Return the expressions lowered in scopes of this kind, by the ids of their nodes."""
    return _live if isinstance(context.scope, LiveScope) else _checked


def known_value(context: LoweringContext, node: Expr, cache: RecentlyUsed[int, Cached]) -> Value | None:
    """Return what an expression became an earlier time, if it must become the same."""
    known = cache[id(node)]
    return known.value if known is not None and can_read(context, known.reads) else None


def can_read(context: LoweringContext, reads: Iterable[tuple[str, int]]) -> bool:
    """Whether names can be read without more ado, in the slots where they were."""
    ready = context.flow.ready.get
    for name, slot in reads:
        load = ready(name) or parameter(context, name)
        if load is None or load.slot != slot:
            return False
    return True


def parameter(context: LoweringContext, name: str) -> Load | None:
    """Return what reads a number that the segment does not set; from now on it is among those ready."""
    quantity = context.scope.names.get(name)
    if (
        quantity is None
        or name in context.assigned
        or quantity.shape
        or quantity.kind is Kind.COMPLEX
        or not context.scope.is_defined(quantity)
    ):
        return None
    load = context.flow.ready[name] = Load(quantity.slot)
    return load


def lower_cached(context: LoweringContext, node: Expr) -> Value:
    """Return `context.lower(node)`, from the cache if it must be the same."""
    if not context.plain or context.redefines_library:
        return context.lower(node)
    cache = cache_of(context)
    known = known_value(context, node, cache)
    if known is not None:
        return known
    reads = context.reads
    reads.clear()
    before = len(context.problems)
    value = context.lower(node)
    if len(context.problems) == before:
        if UNKNOWN_SLOT in reads.values():
            _read_by_now(reads, context.flow.ready)
        cache.keep(id(node), Cached(node, tuple(reads.items()), value))
    return value


def _read_by_now(reads: dict[str, int], ready: Mapping[str, Load]) -> None:
    """Find the slots of names that became ready when they were read; the others are never found again."""
    for name, slot in reads.items():
        if slot == UNKNOWN_SLOT and (load := ready.get(name)) is not None:
            reads[name] = load.slot


def age() -> None:
    """Between two segments: forget expressions that no program of late had."""
    for store in (_live, _checked, _live_stretches, _checked_stretches):
        store.age()


def forget() -> None:
    """Empty the caches."""
    for store in (_live, _checked, _live_stretches, _checked_stretches):
        store.forget()
