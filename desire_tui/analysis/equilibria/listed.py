"""Which states a terminal lists: all of few, of many those that the program displays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.analysis.result import Table

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from typing import Any

_MOST = 8


def tables(
    title: str, columns: Mapping[str, Sequence[Any]], states: Sequence[str], shown: Sequence[str]
) -> list[Table]:
    """Return a table; with many states as columns, one that lists some and one for files that has all."""
    if len(states) <= _MOST:
        return [Table(title, columns)]
    wanted = list(dict.fromkeys([*(name for name in shown if name in states), *states]))[:_MOST]
    some = {name: column for name, column in columns.items() if name not in states or name in wanted}
    left_out = f"{title or 'the first states'} ({len(states) - _MOST} more states in files)"
    return [Table(left_out, some), Table(f"{title or 'states'}: all", columns, is_listed=False)]
