"""What a run of a model begins with, from the arguments of a call."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.api.arguments import refuse_name
from desire_tui.api.settings import name_problems, numbers, slot_of, way_of
from desire_tui.engine.diagnostics import DesireError, Diagnostic, closest
from desire_tui.engine.session.prepared_run import RunStart

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from desire_tui.api.instance import Instance, Way
    from desire_tui.engine.source import Source

    Number = float | ArrayLike
    Initial = Mapping[str, Number] | NDArray[np.float64] | Sequence[float]

_STATES_SHOWN = 8
RUN_ARGUMENTS = ("set", "initial", "t", "record", "check", "timeout", "on_block")


class RunStarts:
    """Of one model, whose parameters and states are known by name."""

    def __init__(self, source: Source, parameters: Mapping[str, float], states: Mapping[str, float]) -> None:
        self._source, self._parameters, self._states = source, parameters, states

    def start(
        self,
        instance: Instance,
        settings: Mapping[str, float],
        initial: Initial | None,
        t: tuple[float, float] | None,
        keywords: Mapping[str, Any],
    ) -> RunStart:
        """Return what a run begins with. DesireError, TypeError, ValueError: the arguments are wrong."""
        way = self.way(instance, tuple(settings), keywords)
        if way.slots is None:
            instance.override(settings)
            assignments: list[tuple[int, float]] = []
        else:
            instance.override({})
            assignments = list(zip(way.slots, settings.values(), strict=True))
        t0, t1 = (None, None) if t is None else _span(t)
        follow = way.follow if way.slots is not None else None
        return RunStart(assignments, follow, self._initial(instance, initial), t0, t1)

    def numbers(
        self, values: Mapping[str, Any], keywords: Mapping[str, Any], instance: Instance
    ) -> dict[str, float]:
        """Return parameters by names of scalars and elements. TypeError, ValueError: they are none."""
        try:
            return numbers({**values, **keywords})
        except (TypeError, ValueError):  # of an argument that is misspelt: the name is what is wrong
            self.refuse_unknown(keywords, instance)
            raise

    def way(self, instance: Instance, names: tuple[str, ...], keywords: Mapping[str, Any]) -> Way:
        """Return how parameters of these names take effect. DesireError, TypeError: they cannot."""
        way = instance.ways.get(names)
        if way is None:
            instance.override({})
            self.refuse_unknown(keywords, instance)
            way = way_of(names, instance)
            instance.ways[names] = way
        return way

    def refuse_unknown(
        self,
        keywords: Mapping[str, object],
        instance: Instance,
        function: str = "run",
        arguments: tuple[str, ...] = RUN_ARGUMENTS,
    ) -> None:
        """TypeError: keywords that are neither arguments of a function nor names of the program."""
        for problem in name_problems(keywords, instance):
            if problem.key == "set-unknown":
                known = [*arguments, *self._parameters, *self._states]
                refuse_name(function, "parameter or setting", str(problem.facts["name"]), known)

    def _initial(self, instance: Instance, initial: Initial | None) -> list[tuple[int, float]]:
        if initial is None:
            return []
        if not isinstance(initial, Mapping):
            array = np.asarray(initial, dtype=np.float64)
            if array.shape != (len(self._states),):
                raise ValueError(
                    f"initial has shape {array.shape}, but the model has {len(self._states)} states"
                )
            return list(zip(instance.prepared.state_slots().tolist(), array.tolist(), strict=True))
        found = []
        for name, value in numbers(initial).items():
            slot = slot_of(name, instance) if name in self._states else None
            if slot is None:
                shown = [*self._states][:_STATES_SHOWN] + ["…"] * (len(self._states) > _STATES_SHOWN)
                facts = {"name": name, "close": closest(name, self._states), "states": ", ".join(shown)}
                raise DesireError(Diagnostic("initial-unknown", None, facts, self._source))
            found.append((slot, value))
        return found


def _span(t: tuple[float, float]) -> tuple[float, float]:
    try:
        first, last = map(float, t)
    except (TypeError, ValueError):
        raise TypeError(f"t is a pair of times, (0, 10), not {t!r}") from None
    return first, last
