"""Operations whose operands are made when somebody asks for them.

Of a thousand equations of one shape, native code needs the shape and the numbers and slots in it, which are
known before any operation is made (`lowering.written_lines`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    Leaves = Sequence[int | float]
    """Slots (int) and numbers (float) of a scalar expression, from left to right."""


class Outline(Protocol):
    """What expressions of one shape have in common: `key` as `codegen.scalar.templates.shape` has it."""

    key: tuple[object, ...]

    def filled(self, leaves: Leaves) -> LazyOperands:
        """Return the operation with its operands."""
        ...


class LazyOperands:
    """An operation that may have come from an `Outline`: then its operands are made at their first use.

    `outline` is None for all others. `facts` are what `lowered.effects` found out about it, None before that.
    """

    __slots__ = ("facts", "leaves", "outline")
    facts: tuple[Any, ...] | None
    outline: Outline | None
    leaves: Leaves

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Make what is not there."""
            if name in {"outline", "facts"}:
                setattr(self, name, None)
                return None
            if name in {"name", "args"} and self.outline is not None:
                made = self.outline.filled(self.leaves)
                self.name, self.args = made.name, made.args
                return getattr(self, name)
            raise AttributeError(name)


new_record: Callable[..., Any] = object.__new__
"""Makes a record without its fields."""
