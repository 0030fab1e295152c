"""Colour keys: what each colour of a graph stands for."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from desire_tui.engine.graph.curve import Curve
    from desire_tui.engine.graph.study import Study
    from desire_tui.engine.runtime.run_record import RunRecord

SIGNS = "■╍┉"
"""Of solid, dashed and dotted curves."""
MARK = "×"
"""Of measured points."""
KEYS_MOST = 8
"""Of more runs, only what varies between them is named, beside some of their colours."""
_NAMED_MOST = 3
"""So many runs that share a colour are named in one key."""


class Key(NamedTuple):
    """A colour key: a name and the colour numbers that it stands for."""

    name: str
    colors: tuple[int, ...]
    dash: int = 0
    """As `Curve.dash`."""
    measured: bool = False
    """As `Curve.measured`."""

    @property
    def sign(self) -> str:
        """What stands for each of the colours in text."""
        return MARK if self.measured else SIGNS[min(self.dash, len(SIGNS) - 1)]

    @property
    def color(self) -> int:
        """The first of the colours."""
        return self.colors[0]


def color_keys(curves: Sequence[Curve], study: Study) -> tuple[Key, ...]:
    """Return the keys of a page's curves and then of measured points, each name and colour once.

    Where runs share the page, keys say what was changed between them: `x, c = 0.3`, or for many of them
    `x, c = 0.3 … 1.5`. The name of the only variable goes without saying.
    """
    points = dict.fromkeys(Key(one.name, (one.color,), measured=True) for one in curves if one.measured)
    return (*_run_keys([one for one in curves if not one.measured], study), *points)


def _run_keys(curves: Sequence[Curve], study: Study) -> tuple[Key, ...]:
    groups: dict[tuple[str, int], dict[RunRecord, None]] = {}
    for curve in curves:
        if curve.name:  # marks and fields of charts have none
            groups.setdefault((curve.name, curve.color), {})[curve.record] = None
    names = dict.fromkeys(name for name, _ in groups)
    dashes = {curve.name: curve.dash for curve in curves}
    if len(study.records) < 2:
        return tuple(Key(name, (color,), dashes[name]) for name, color in groups)
    if len(groups) <= KEYS_MOST and all(len(runs) <= _NAMED_MOST for runs in groups.values()):
        alone = len(names) == 1
        return tuple(
            Key(_joined(name, _names(runs, study), alone=alone), (color,), dashes[name])
            for (name, color), runs in groups.items()
        )
    return tuple(
        Key(
            _joined(name, study.span or study.run_name, alone=len(names) == 1),
            _sample([color for known, color in groups if known == name]),
            dashes[name],
        )
        for name in names
    )


def short_names(keys: Iterable[Key]) -> list[str]:
    """Return the names of keys without what they share with the key before: `c = 0.3`, `0.6`, `0.9`."""
    found, before = [], ""
    for key in keys:
        head, joint, tail = key.name.rpartition(" = ")
        found.append(tail if joint and head == before else key.name)
        before = head
    return found


def _names(runs: Iterable[RunRecord], study: Study) -> str:
    return " and ".join(filter(None, (study.name(run) for run in runs)))


def _joined(name: str, runs: str, *, alone: bool) -> str:
    return runs if alone and runs else ", ".join(filter(None, (name, runs)))


def _sample(colors: Sequence[int]) -> tuple[int, ...]:
    """Return some of the colours, from the first to the last."""
    if len(colors) <= KEYS_MOST:
        return tuple(colors)
    step = (len(colors) - 1) / (KEYS_MOST - 1)
    return tuple(colors[round(number * step)] for number in range(KEYS_MOST))
