"""Sums, and quantities told by their place in the file, written out.

`sum(0,9)of(shift(u0,i'))` is u0 and the nine quantities declared behind it. What is written out must be
known beforehand: bounds and places made of numbers, constants, or parameters at their present values.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import Call, Name, number, substituted, total, with_parts
from desire_tui.convert.xppaut.constants import constant
from desire_tui.convert.xppaut.expression_parser import INDEX, SUM
from desire_tui.convert.xppaut.vocabulary import NotConvertibleError
from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from desire_tui.convert.expressions import Expression

TERMS_MOST = 2_000
"""How many terms a sum may be written out to."""


@dataclass(frozen=True)
class Places:
    """What `shift` counts in: quantities in the order of their declarations, kind by kind; all lower case."""

    kinds: Sequence[Sequence[str]]
    constants: Mapping[str, float]

    def shifted(self, name: str, by: int) -> str:
        """Return the quantity `by` places behind another. NotConvertibleError."""
        for names in self.kinds:
            if name in names:
                place = names.index(name) + by
                if 0 <= place < len(names):
                    return names[place]
                raise NotConvertibleError(f"there is no quantity {by:+d} places from '{name}'")
        raise NotConvertibleError(f"'{name}' is not declared")


def written_out(expression: Expression, places: Places) -> Expression:
    """Return the expression without sums and shifts. NotConvertibleError."""
    if isinstance(expression, Call) and expression.function == SUM:
        low, high, term = expression.arguments
        first, last = (_whole(bound, places) for bound in (low, high))
        if last - first >= TERMS_MOST:
            raise NotConvertibleError(f"the sum has {last - first + 1} terms, more than {TERMS_MOST}")
        terms = [substituted(term, {INDEX: number(float(k))}) for k in range(first, last + 1)]
        return total([written_out(one, places) for one in terms])
    if isinstance(expression, Call) and expression.function in {"shift", "del_shft"}:
        return _shift(expression, places)
    return with_parts(expression, lambda part: written_out(part, places))


def _whole(expression: Expression, places: Places) -> int:
    return int(constant(expression, places.constants))


def _shift(call: Call, places: Places) -> Expression:
    count = 2 if call.function == "shift" else 3
    if len(call.arguments) != count or not isinstance(call.arguments[0], Name):
        raise NotConvertibleError(f"'{call.function}' wants a quantity and {count - 1} expression(s)")
    name = Name(places.shifted(call.arguments[0].name, _whole(call.arguments[1], places)))
    return name if count == 2 else Call("delay", (name, written_out(call.arguments[2], places)))
