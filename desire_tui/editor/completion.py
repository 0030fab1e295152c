"""What can be typed next: names of the program, functions of the library, statements, commands."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from desire_tui.commands import COMMANDS
from desire_tui.help import topics

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_WORD = re.compile(r"[A-Za-z][A-Za-z0-9_$]*")
_TAIL = re.compile(r"[A-Za-z][A-Za-z0-9_$/]*$")
OFFERED_MAX = 60


@dataclass(frozen=True, slots=True)
class Offer:
    """One completion: the whole word, and a line about it."""

    word: str
    about: str


def prefix_of(line: str, column: int) -> str:
    """Return the beginning of a word that stands before the column; empty inside a comment or a string."""
    before = line[:column]
    if "--" in before or before.count("'") % 2 or before.count('"') % 2:
        return ""
    found = _TAIL.search(before)
    return found.group() if found else ""


def offers(
    prefix: str, texts: Iterable[str], known: Mapping[str, str], *, commands: bool = False
) -> list[Offer]:
    """Return completions of `prefix`, the program's own names first.

    `texts` are programs whose names count, `known` are names with a line about each (quantities with their
    values); with `commands` the command line's words are offered too.
    """
    about = _words(commands=commands)
    own: dict[str, str] = dict(known)
    for text in texts:
        for word in _WORD.findall(_without_comments(text)):
            own.setdefault(word, "")
    found = [
        Offer(word, own[word] or "name in this program")
        for word in sorted(own)
        if _fits(prefix, word) and word not in about
    ]
    found += [Offer(word, line) for word, line in sorted(about.items()) if _fits(prefix, word)]
    found.sort(key=lambda offer: not offer.word.startswith(prefix))
    return found[:OFFERED_MAX]


def _fits(prefix: str, word: str) -> bool:
    return word != prefix and word.casefold().startswith(prefix.casefold())


def _without_comments(text: str) -> str:
    return re.sub(r"--.*|'[^'\n]*'|\"[^\"\n]*\"", "", text)


@cache
def _words(*, commands: bool) -> dict[str, str]:
    """Every word of the language with a line about it.

    The command line's own words too where they may stand.
    """
    from desire_tui.engine.library import LIBRARY

    table = {name: f"({entry.parameters})  {entry.help}" for name, entry in LIBRARY.items()}
    for page in topics().values():
        if page.kind == "error" or (page.kind == "command" and not commands):
            continue
        for word in (page.name, *page.words):
            if _TAIL.fullmatch(word):
                table.setdefault(word, page.summary)
    if commands:
        for command in COMMANDS:
            for word in command.words:
                table.setdefault(word, command.help)
    return table
