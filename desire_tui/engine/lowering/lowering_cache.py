"""Lowered scalar expressions, cached by the node they came from: a one-line edit lowers one line anew.

The parser returns the same node for the same text. What an expression of names, numbers and library functions
becomes depends on nothing but the slots its names stand for: if all of them can be read without more ado
(`Flow.ready`) and have the slots they had, the value of the last time holds again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.lowering.scope import LiveScope
from desire_tui.engine.recently_used import RecentlyUsed

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
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
    context.reads.clear()
    before = len(context.problems)
    value = context.lower(node)
    if len(context.problems) == before:
        loads = [(name, ready.get(name)) for name in context.reads]
        reads = tuple([(name, load.slot) for name, load in loads if load is not None])
        if len(reads) == len(loads):
            cache.keep(id(node), _Cached(node, reads, value))
    return value


def age() -> None:
    """Between two segments: forget expressions that no program of late had."""
    _live.age()
    _checked.age()


def forget() -> None:
    """Empty the caches."""
    _live.forget()
    _checked.forget()
