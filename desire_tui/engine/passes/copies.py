"""Copies of lowered statements and expressions in which some parts are others."""

from __future__ import annotations

from typing import Any

from desire_tui.engine.lowered.expressions import Const


class Copies:
    """What stands at several places stays one; what holds nothing new stays what it is.

    `made` says what stands in place of a part whose own parts are already new ones, `items` what stands in
    place of one in a row of several.
    """

    def __init__(self) -> None:
        self._known: dict[int, tuple[object, Any]] = {}

    def of(self, part: Any) -> Any:
        """Return a statement, an expression or a tuple of them, copied."""
        if isinstance(part, tuple):
            if type(part) is not tuple:
                return part  # a place
            items = [item for given in part for item in self.items(given)]
            if len(items) == len(part) and all(one is other for one, other in zip(items, part, strict=True)):
                return part
            return tuple(items)
        names: tuple[str, ...] | None = getattr(type(part), "__slots__", None)
        if names is None or isinstance(part, str | float | int | Const):
            return part
        known = self._known.get(id(part))
        if known is None:
            fields = [getattr(part, name) for name in names]
            copied = [self.of(field) for field in fields]
            same = all(one is other for one, other in zip(copied, fields, strict=True))
            known = self._known[id(part)] = part, self.made(part, part if same else type(part)(*copied))
        return known[1]

    def items(self, item: Any) -> tuple[Any, ...]:
        """Return what stands in place of one of several."""
        return (self.of(item),)

    def made(self, part: Any, copy: Any) -> Any:  # noqa: ARG002 - others ask what it was
        """Return what stands in place of `part`; `copy`: the same with parts replaced, or itself."""
        return copy
