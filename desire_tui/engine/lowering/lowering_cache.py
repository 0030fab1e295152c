"""Lowered scalar expressions, cached by the node they came from: a one-line edit lowers one line anew.

The parser returns the same node for the same text. What an expression of names, numbers and library functions
becomes depends on nothing but the slots its names stand for: if all of them can be read without more ado
(`Flow.ready`) and have the slots they had, the value of the last time holds again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.lowering.lowering_context import UNKNOWN_SLOT
from desire_tui.engine.lowering.scope import LiveScope
from desire_tui.engine.recently_used import RecentlyUsed

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.lowered.expressions import Load, Value
    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.nodes.expressions import Expr

ROOM = 5_000
"""Expressions of earlier programs in a cache: some 2 KB each."""


class _Cached(NamedTuple):
    """`node` is held so that its id stays taken."""

    node: Expr
    reads: tuple[tuple[str, int], ...]
    value: Value


_live: RecentlyUsed[int, _Cached] = RecentlyUsed(ROOM)
_checked: RecentlyUsed[int, _Cached] = RecentlyUsed(ROOM)
"""Checks number the slots in their own way."""


def lower_cached(context: LoweringContext, node: Expr) -> Value:
    """Return `context.lower(node)`, from the cache if it must be the same."""
    if not context.plain or context.redefines_library:
        return context.lower(node)
    cache = _live if isinstance(context.scope, LiveScope) else _checked
    ready = context.flow.ready
    known = cache[id(node)]
    if known is not None:
        for name, slot in known.reads:
            load = ready.get(name)
            if load is None or load.slot != slot:
                break
        else:
            return known.value
    reads = context.reads
    reads.clear()
    before = len(context.problems)
    value = context.lower(node)
    if len(context.problems) == before:
        if UNKNOWN_SLOT in reads.values():
            _read_by_now(reads, ready)
        cache.keep(id(node), _Cached(node, tuple(reads.items()), value))
    return value


def _read_by_now(reads: dict[str, int], ready: Mapping[str, Load]) -> None:
    """Find the slots of names that became ready when they were read; the others are never found again."""
    for name, slot in reads.items():
        if slot == UNKNOWN_SLOT and (load := ready.get(name)) is not None:
            reads[name] = load.slot


def age() -> None:
    """Between two segments: forget expressions that no program of late had."""
    _live.age()
    _checked.age()


def forget() -> None:
    """Empty the caches."""
    _live.forget()
    _checked.forget()
