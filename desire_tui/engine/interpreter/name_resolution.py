"""What a name means at some place in the script: a quantity, or a dummy of a PROCEDURE or FUNCTION."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.diagnostics import closest
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.values import PI, Kind, Quantity

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.nodes.expressions import Element, Name
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.values import Values


@dataclass(slots=True, eq=False)
class Reference:
    """A dummy behind the `;` of a PROCEDURE that stands for a scalar or an element.

    `box` is `[slot, defined]` of what it stands for in the present call; generated code calls it `variable`.
    """

    variable: str
    kind: Kind
    box: list[int]


@dataclass(frozen=True, slots=True)
class Local:
    """A dummy of a FUNCTION: a Python variable of the generated code."""

    variable: str
    kind: Kind


Meaning = Quantity | Reference | Local


@dataclass(slots=True, eq=False)
class NameScope:
    """Names in force: dummies first, then the program's quantities.

    `functions` and `procedures` are the program's; a quantity may not have such a name (error 73).
    """

    values: Values
    functions: dict[str, Placed]
    procedures: Mapping[str, object]
    dummies: dict[str, Meaning] = field(default_factory=dict)

    def inner(self, dummies: dict[str, Meaning]) -> NameScope:
        """Return the scope of a body with these dummies."""
        return NameScope(self.values, self.functions, self.procedures, dummies)

    def find(self, name: str) -> Meaning | None:
        """Return what `name` stands for, None if nothing with a value."""
        meaning = self.dummies.get(name)
        if meaning is not None:
            return meaning
        quantity = self.values.find(name)
        return quantity if quantity is not None and self.values.is_readable(quantity) else None

    def read(self, node: Name | Element) -> Meaning:
        """Return what a name that is read stands for; error 200 if nothing."""
        meaning = self.find(node.name)
        if meaning is None:
            raise self.undefined(node)
        return meaning

    def assigned(self, node: Name | Element) -> Quantity | Reference:
        """Return what a target stands for, making a new scalar if the name is new."""
        meaning = self.dummies.get(node.name)
        if isinstance(meaning, Quantity | Reference):
            return meaning
        if node.name in self.functions or node.name in self.procedures:
            what = "FUNCTION" if node.name in self.functions else "PROCEDURE"
            raise ScriptFault("name-of-something-else", node, name=node.name, what=f"a {what}")
        quantity = self.values.scalar(node.name)
        if quantity.slot == PI:
            raise ScriptFault("constant-assigned", node, name=node.name)
        return quantity

    def array(self, node: Name | Element) -> Quantity:
        """Return a declared array; error 19 if there is none of that name."""
        meaning = self.dummies.get(node.name) or self.values.find(node.name)
        if isinstance(meaning, Quantity) and meaning.shape:
            return meaning
        arrays = [q.name for q in self.values if q.shape]
        raise ScriptFault("not-an-array", node, name=node.name, close=closest(node.name, arrays))

    def whole_array(self, node: Name, quantity: Quantity) -> ScriptFault:
        """Return error 53: an array's name stands where one number is needed."""
        example = f"{node.name}[{','.join('1' * len(quantity.shape))}]"
        return ScriptFault("array-without-subscripts", node, name=node.name, example=example)

    def undefined(self, node: Name | Element) -> ScriptFault:
        """Return error 200 with the nearest name that has a value."""
        known = [q.name for q in self.values if self.values.is_defined(q)]
        known += [*self.dummies, *self.functions]
        if node.name in LIBRARY or node.name in self.functions:
            return ScriptFault("function-without-arguments", node, name=node.name)
        return ScriptFault("undefined-variable", node, name=node.name, close=closest(node.name, known))
