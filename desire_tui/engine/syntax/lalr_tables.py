"""LALR tables of `desire.lark`: made by lark once, stored in the user's cache, read back without lark.

lark takes 50 ms to import and 250 ms to build the tables; reading them back takes 2 ms, and then
`automaton` steps through them. lark stays the only thing that understands the grammar file (`lalr_builder`);
its own `cache` option would save the 250 ms, but not the import.
"""

# ruff: noqa: PTH118, PTH120, PTH123 - pathlib would add 5 ms to every start

from __future__ import annotations

import marshal
import os
import sys
from functools import cache
from typing import Any, NamedTuple
from zlib import crc32

from desire_tui.engine import disk_cache

FORMAT = 2
"""Raised when the stored form below changes."""


class Rule(NamedTuple):
    """A production: its left side, the number of symbols on its right, the `Builder` method for its node.

    Without a method the single child stands for the whole (`?rule`) or, if `splice`, the children join the
    parent's.
    """

    origin: str
    size: int
    method: str
    splice: bool


class LalrTables(NamedTuple):
    """Per state: token kind → next state (≥ 0) or −1 − rule; rule name → next state. `$END` ends."""

    start: int
    accept: int
    actions: list[dict[str, int]]
    gotos: list[dict[str, int]]
    rules: list[Rule]


@cache
def tables() -> LalrTables:
    """Return the tables, from the cache if it has them for exactly this grammar."""
    here = os.path.dirname(__file__)
    with open(os.path.join(here, "desire.lark"), encoding="utf-8") as file:
        grammar = file.read()
    key = f"{FORMAT}-{sys.hexversion:x}-{crc32(grammar.encode()):08x}"
    stored = _read(key)
    if stored is None:
        from desire_tui.engine.syntax.lalr_builder import build

        stored = build(grammar)
        _write(key, stored)
    return _unpack(stored)


def _unpack(stored: dict[str, Any]) -> LalrTables:
    return LalrTables(
        stored["start"],
        stored["accept"],
        stored["actions"],
        stored["gotos"],
        [Rule(*rule) for rule in stored["rules"]],
    )


def _read(key: str) -> dict[str, Any] | None:
    """Return the stored tables; None if there are none of use."""
    content = disk_cache.read(f"grammar-{key}.tables")
    if content is None:
        return None
    try:
        stored: dict[str, Any] = marshal.loads(content)  # noqa: S302 - this user's own file, whole by its check sum
        _unpack(stored)
    except (ValueError, EOFError, KeyError, TypeError):
        return None
    return stored


def _write(key: str, stored: dict[str, Any]) -> None:
    disk_cache.write(f"grammar-{key}.tables", marshal.dumps(stored))
