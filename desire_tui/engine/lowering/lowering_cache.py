"""Lowered scalar expressions, kept by the node they came from: a one-line edit lowers one line anew.

The parser returns the same node for the same text. What an expression of names, numbers and library functions
becomes depends on nothing but the slots its names stand for: if all of them can be read without more ado
(`Flow.ready`) and have the slots they had, the value of the last time holds again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.lowering.expressions import lower
from desire_tui.engine.lowering.scope import LiveScope

if TYPE_CHECKING:
    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowering.lowering_context import LoweringContext
    from desire_tui.engine.nodes.expressions import Expr

KEPT_MOST = 100_000
"""Expressions kept before the store is emptied."""


class _Kept(NamedTuple):
    """`node` is held so that its id stays taken."""

    node: Expr
    reads: tuple[tuple[str, int], ...]
    value: Value


_live: dict[int, _Kept] = {}
_looking: dict[int, _Kept] = {}
"""Checks number the slots in their own way."""


def lower_kept(context: LoweringContext, node: Expr) -> Value:
    """Return `expressions.lower(context, node)`, from the store if it must be the same."""
    if not context.plain or context.redefines_library:
        return lower(context, node)
    store = _live if isinstance(context.scope, LiveScope) else _looking
    ready = context.flow.ready
    known = store.get(id(node))
    if known is not None:
        for name, slot in known.reads:
            load = ready.get(name)
            if load is None or load.slot != slot:
                break
        else:
            return known.value
    context.reads.clear()
    before = len(context.problems)
    value = lower(context, node)
    if len(context.problems) == before:
        loads = [(name, ready.get(name)) for name in context.reads]
        reads = tuple([(name, load.slot) for name, load in loads if load is not None])
        if len(reads) == len(loads):
            if len(store) >= KEPT_MOST:
                store.clear()
            store[id(node)] = _Kept(node, reads, value)
    return value


def forget() -> None:
    """Empty the stores."""
    _live.clear()
    _looking.clear()
