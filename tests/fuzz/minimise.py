"""Makes a failing input small: what can be left out without another failure is left out."""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.fuzz.kinds import Input

_TOKENS = re.compile(r"[A-Za-z_$]\w*|[0-9.]+(?:[eE][+-]?\d+)?|\s+|.", re.DOTALL)


def minimised(made: Input, fails: Callable[[Input], bool], seconds: float) -> Input:
    """Return the smallest input found in the time that still `fails`: lines or items first, then tokens."""
    until = time.monotonic() + seconds
    if not isinstance(made, str):
        items = _fewer(list(made), fails, until)
        for place, item in enumerate(items):

            def alone(text: Input, place: int = place) -> bool:
                return fails([*items[:place], str(text), *items[place + 1 :]])

            items[place] = _text(item, alone, until)
        return items
    return _text(made, fails, until)


def _text(text: str, fails: Callable[[Input], bool], until: float) -> str:
    lines = _fewer(text.splitlines(keepends=True), lambda rest: fails("".join(rest)), until)
    tokens = _TOKENS.findall("".join(lines))
    return "".join(_fewer(tokens, lambda rest: fails("".join(rest)), until))


def _fewer(items: list[str], fails: Callable[[list[str]], bool], until: float) -> list[str]:
    """Leave out halves, quarters, … single items."""
    size = max(len(items) // 2, 1)
    while items:
        place = 0
        while place < len(items):
            rest = items[:place] + items[place + size :]
            if time.monotonic() > until:
                return items
            if fails(rest):
                items = rest
            else:
                place += size
        if size == 1:
            break
        size //= 2
    return items
