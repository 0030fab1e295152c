"""What can be typed next: names of the program, functions of the library, statements, commands."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass
from desire_tui.language.line_tokens import words_in

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

_TYPED = re.compile(r"d/[A-Za-z]*|[A-Za-z][A-Za-z0-9_$]*")
OFFERED_MAX = 60
LINES_SEARCHED, LINE_SEARCHED = 2000, 1000
"""So many lines before and behind the cursor are searched for names, and so many characters of each."""
Words = tuple[tuple[str, str], ...]
"""Words with a line about each."""
SMALL_WORDS = frozenset({"and", "or", "not", "then", "to", "t0"})
OWN_NAME = "name in this program"


@dataclass(frozen=True, slots=True)
class Offer:
    """One completion: the whole word, and a line about it."""

    word: str
    about: str


def around(lines: Sequence[str], row: int) -> list[str]:
    """Return the lines around a row, as many as are searched for names; rows joined by `_` as one."""
    top, bottom = max(0, row - LINES_SEARCHED), row + LINES_SEARCHED
    found: list[str] = []
    joins = False
    for line in lines[top:bottom]:
        begun = found.pop() if joins else ""
        joins = len(begun) < LINE_SEARCHED and "--" not in line and line.rstrip().endswith("_")
        found.append(f"{begun}{line.rstrip()[:-1] if joins else line}"[:LINE_SEARCHED])
    return found


def offers(
    prefix: str,
    lines: Iterable[str],
    known: Mapping[str, str],
    *,
    commands: Words = (),
    complete: bool = False,
) -> list[Offer]:
    """Return completions of `prefix`, the likeliest first; itself before all if it is `complete`.

    Capitals as typed come before others, the program's names before the language's, words that it uses
    already before the rest, short ones before long ones.
    `lines` are those of a program whose names count, `known` are names with a line about each (quantities
    with their values); `commands` are words of the command line, which are offered there only.
    """
    about = _words(commands)
    own: dict[str, str] = dict(known)
    for word in _words_like(prefix, lines):
        own.setdefault(word, "")
    found = [
        Offer(word, about.get(word) or own[word] or OWN_NAME)
        for word in {**about, **own}
        if _fits(prefix, word)
    ]

    def rank(offer: Offer) -> tuple[object, ...]:
        word = offer.word
        return not word.startswith(prefix), word in about, word not in own, len(word), word

    found.sort(key=rank)
    if complete:
        found.insert(0, Offer(prefix, own.get(prefix) or about.get(prefix) or OWN_NAME))
    return found[:OFFERED_MAX]


def is_complete(
    word: str, lines: Iterable[str], known: Mapping[str, str], *, commands: Words = (), itself: int = 1
) -> bool:
    """Whether a word is one already: the language's, a quantity, or in the lines beyond `itself` times."""
    if word in known or word in _words(commands):
        return True
    return sum(name == word for name in _words_like(word, lines)) > itself


def _fits(prefix: str, word: str) -> bool:
    return word != prefix and word.casefold().startswith(prefix.casefold())


def _words_like(prefix: str, lines: Iterable[str]) -> Iterator[str]:
    """Yield the words of those lines that can hold one with that beginning."""
    folded = prefix.casefold()
    return (word for line in lines if folded in line.casefold() for word in words_in(line))


@cache
def _words(commands: Words) -> dict[str, str]:
    """Every word of the language with a line about it, and those of the command line where they may stand."""
    from desire_tui.engine.library import LIBRARY
    from desire_tui.engine.syntax.highlighting import highlight
    from desire_tui.help.page_catalogue import topics

    table = {name: f"({entry.parameters})  {entry.help}" for name, entry in LIBRARY.items()}
    for page in topics().values():
        if page.kind == "error" or (page.kind == "command" and not commands):
            continue
        for word in (page.name, *page.words):
            if not _TYPED.fullmatch(word):
                continue
            of_the_language = word in SMALL_WORDS or highlight(word)[0][2] != "name"
            if of_the_language or page.kind == "command":  # other words only lead to the page
                table.setdefault(word, page.summary)
    for word, about in commands:
        table.setdefault(word, about)
    return table
