"""The session's quantities as rows for people: what a pane, `dump` and completion show."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.interpreter.number_text import scalar_text
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    from desire_tui.engine.values import Quantity, Values

_SHOWN_ELEMENTS = 4


@dataclass(frozen=True, slots=True)
class QuantityRow:
    """One quantity: its name, with dimensions, its kind in words, its value (an array's first elements)."""

    name: str
    title: str
    kind: str
    text: str
    quantity: Quantity


def names(values: Values) -> list[QuantityRow]:
    """Return all quantities with a value in the order they were made; large arrays cost no more."""
    return [
        QuantityRow(q.name, title(q), kind_word(q), value_text(values, q), q)
        for q in values
        if values.is_defined(q)
    ]


def title(quantity: Quantity) -> str:
    """Return a name with its dimensions: `x`, `A[2,3]`."""
    size = ",".join(map(str, quantity.shape))
    return f"{quantity.name}[{size}]" if size else quantity.name


def kind_word(quantity: Quantity) -> str:
    """Return what a quantity is: `real`, `STATE`, `INTEGER`, `COMPLEX`, with `array` behind."""
    word = "STATE" if quantity.is_state else "real" if quantity.kind is Kind.REAL else quantity.kind.name
    return f"{word} array" if quantity.shape else word


def value_text(values: Values, quantity: Quantity) -> str:
    """Return a scalar's value as `write` shows it, or an array's first elements."""
    width = 2 if quantity.kind is Kind.COMPLEX else 1
    shown = min(quantity.size, _SHOWN_ELEMENTS)
    parts = [_number(values, quantity.slot + width * k, quantity.kind) for k in range(shown)]
    return "  ".join(parts) + ("  …" if quantity.size > shown else "")


def _number(values: Values, slot: int, kind: Kind) -> str:
    cells = values.cells
    return scalar_text(complex(cells[slot], cells[slot + 1]) if kind is Kind.COMPLEX else cells[slot], kind)
