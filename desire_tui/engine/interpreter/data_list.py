"""The `data` items of a script, read one after the other."""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.nodes.files import Data
from desire_tui.engine.nodes.signs import literal

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.program import Placed

    Evaluator = Callable[[], complex]


class DataList:
    """All `data` items of a script, and the next one to be read.

    `places` are those of the data statements, `faults` says by its offset what is wrong with one. `make`
    makes the function that evaluates an expression in the statement at a place.
    """

    def __init__(
        self,
        script: Sequence[Placed],
        places: Sequence[int],
        faults: Mapping[int, Diagnostic],
        make: Callable[[int, Expr], Evaluator],
    ) -> None:
        self._script, self._places, self._faults, self._make = script, places, faults, make
        self._list = 0
        self._item = 0
        self._evaluators: dict[tuple[int, int], Evaluator] = {}

    def forget(self) -> None:
        """Forget how items are evaluated: all names were cleared."""
        self._evaluators.clear()

    def rewind(self, place: int = 0) -> None:
        """Go on with the first list at or behind this place of the script."""
        self._list, self._item = bisect_left(self._places, place), 0

    def next(self) -> complex:
        """Return the next item's value, evaluated now; error 51 if there is none."""
        while self._list < len(self._places):
            place = self._places[self._list]
            node = self._script[place].node
            if not isinstance(node, Data):  # a line that cannot be read
                raise DesireError(self._faults[self._script[place].at])
            if self._item < len(node.items):
                item, self._item = self._item, self._item + 1
                value = literal(node.items[item])
                return value if value is not None else self._evaluate(place, item, node.items[item])
            self._list, self._item = self._list + 1, 0
        raise ScriptFault("out-of-data")

    def _evaluate(self, place: int, item: int, node: Expr) -> complex:
        known = self._evaluators.get((place, item))
        if known is None:
            known = self._evaluators[place, item] = self._make(place, node)
        return known()
