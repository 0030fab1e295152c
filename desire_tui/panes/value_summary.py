"""A quantity in a few words: what kind of thing it is, and its value."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.values import Quantity, Values

ELEMENTS_SHOWN = 4


def shape_text(quantity: Quantity) -> str:
    """Return what kind of thing a quantity is, in a word."""
    from desire_tui.engine.values import Kind

    kind = {Kind.REAL: "", Kind.INTEGER: "INTEGER ", Kind.COMPLEX: "COMPLEX "}[quantity.kind]
    shape = f"[{','.join(map(str, quantity.shape))}]" if quantity.shape else ""
    state = "state" if quantity.is_state else ""
    return f"{kind}{shape}{' ' if shape and state else ''}{state}".strip()


def value_text(values: Values, quantity: Quantity) -> str:
    """Return a quantity's value, arrays by their first elements."""
    from desire_tui.engine.values import Kind

    if not values.is_defined(quantity):
        return "undefined"
    if quantity.kind is Kind.COMPLEX and not quantity.shape:
        real, imaginary = values.cells[quantity.slot], values.cells[quantity.slot + 1]
        return f"{real:g} + j*({imaginary:g})"
    if not quantity.shape:
        return f"{values.cells[quantity.slot]:g}"
    flat = values.view(quantity).reshape(-1)[:ELEMENTS_SHOWN]
    more = " …" if quantity.size > ELEMENTS_SHOWN else ""
    return " ".join(f"{value:.4g}" for value in flat.tolist()) + more
