"""Colour keys: what each colour of a graph stands for."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from desire_tui.engine.integration.rules import RULES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from desire_tui.engine.runtime.run_record import RunRecord

_NAMED_MOST = 3
"""So many runs that share a colour are named in one key."""


class Key(NamedTuple):
    """A colour key: a curve's name and its colour number."""

    name: str
    color: int


class Colored(Protocol):
    """What is asked of a curve."""

    @property
    def name(self) -> str: ...  # noqa: D102
    @property
    def color(self) -> int: ...  # noqa: D102
    @property
    def record(self) -> RunRecord: ...  # noqa: D102


def color_keys(curves: Sequence[Colored]) -> tuple[Key, ...]:
    """Return the keys of a page's curves, each name and colour once.

    Where runs that share the page differ in rule, ERMAX or step size, the keys say so: `x, rule 3`.
    """
    setting = _setting([curve.record for curve in curves])
    settings: dict[Key, dict[str, None]] = {}
    for curve in curves:
        settings.setdefault(Key(curve.name, curve.color), {})[setting(curve.record)] = None
    return tuple(
        Key(f"{key.name}, {' and '.join(found)}", key.color)
        if all(found) and len(found) <= _NAMED_MOST
        else key
        for key, found in settings.items()
    )


def _setting(records: Iterable[RunRecord]) -> Callable[[RunRecord], str]:
    """Return what names the first setting in which runs differ, or says nothing."""
    runs = list(dict.fromkeys(records))
    if len({run.rule for run in runs}) > 1:
        return lambda run: f"rule {run.rule}"
    if len({run.error_max for run in runs}) > 1:
        return lambda run: f"ERMAX {run.error_max:.3g}"
    if len({run.dt for run in runs}) > 1 and all(RULES[run.rule].kind == "fixed" for run in runs):
        return lambda run: f"DT {run.dt:.3g}"
    return lambda _: ""
