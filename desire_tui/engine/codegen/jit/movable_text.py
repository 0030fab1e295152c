"""Texts with addresses of this process in them, as texts that are the same in every process.

An address becomes an outside symbol, which whoever places the code gives its value; functions that are named
by a digest of such a text are numbered instead.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

_ADDRESS = re.compile(r"inttoptr i64 (\d+) to ptr|inttoptr \(i64 (\d+) to ptr\)")
_MARK = "inttoptr"


class MovableText(NamedTuple):
    """A text, the addresses of its outside symbols, and its functions' names by those they had."""

    text: str
    addresses: dict[str, int]
    names: dict[str, str]


def has_addresses(text: str) -> bool:
    """Whether a text holds addresses."""
    return _MARK in text


def movable_text(text: str, functions: Iterable[str]) -> MovableText:
    """Take the addresses out of a text that defines these functions for others."""
    symbols: dict[int, str] = {}

    def symbol(found: re.Match[str]) -> str:
        instruction, constant = found.groups()
        name = symbols.setdefault(int(instruction or constant), f"address.{len(symbols)}")
        return f"getelementptr i8, ptr @{name}, i64 0" if instruction else f"@{name}"

    written = _ADDRESS.sub(symbol, text)
    names = {function: f"function.{number}" for number, function in enumerate(functions)}
    listed = "|".join(map(re.escape, names))
    written = re.sub(rf"@({listed})(?![\w.$])", lambda found: f"@{names[found[1]]}", written)
    declared = [f"@{name} = external global %address" for name in symbols.values()]
    # of no size that is known: all that stands there may be read and written
    whole = "\n".join((written, "%address = type opaque", *declared))
    return MovableText(whole, {name: at for at, name in symbols.items()}, names)
