"""The search over the help pages: names before descriptions before texts; what is misspelt is guessed."""

from __future__ import annotations

import re
from difflib import get_close_matches
from functools import cache
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass
from desire_tui.help.page_catalogue import find, topics

if TYPE_CHECKING:
    from desire_tui.help.page_catalogue import Topic

_FILLING = frozenset((
    "a", "an", "and", "are", "can", "do", "does", "how", "i", "in", "is", "my", "of", "or", "the", "to",
    "what", "where", "with", "why",
))  # fmt: skip
_AMERICAN = {
    "color": "colour",
    "colors": "colours",
    "gray": "grey",
    "center": "centre",
    "behavior": "behaviour",
}
_WORD = re.compile(r"[a-z][a-z0-9+-]*[a-z0-9]|[a-z0-9]+")
SIMILAR, GUESSES = 0.72, 3
"""How alike a guess must be (0 … 1), and how many are tried."""
WEAK = 7
"""Rank of a page that does not hold a word at all."""


@dataclass(frozen=True, slots=True)
class _Entry:
    """A page as the search sees it, in small letters."""

    page: Topic
    names: tuple[str, ...]
    also: frozenset[str]
    summary: str
    body: str


def search(text: str) -> list[Topic]:
    """Return pages for some words, the likeliest first; all pages for an empty text.

    Every word counts; where no page holds them all, those that hold most come. A word that stands nowhere is
    taken for a misspelt one.
    """
    wanted = _wanted(text)
    if not wanted:
        return list(topics().values())
    alternatives = [_alternatives(word) for word in wanted]
    ranked = []
    for number, entry in enumerate(_index()):
        ranks = [min(_rank(entry, word) + n for n, word in enumerate(words)) for words in alternatives]
        missing = sum(rank >= WEAK for rank in ranks)
        ranked.append((missing, sum(ranks), len(entry.page.name), number))
    fewest = min(missing for missing, *_ in ranked)
    if fewest == len(wanted):
        return []
    found = [_index()[number].page for missing, *_, number in sorted(ranked) if missing == fewest]
    if (exact := find(text)) is not None:
        found = [exact, *(page for page in found if page is not exact)]
    return found


def _wanted(text: str) -> list[str]:
    words = text.casefold().split()
    rest = [word for word in words if word not in _FILLING] if len(words) > 1 else words
    return [_AMERICAN.get(word, word) for word in rest or words]


def _rank(entry: _Entry, word: str) -> int:
    if word in entry.names:
        return 0
    if word in entry.also or any(word in name.split() for name in entry.names):
        return 1
    if any(name.startswith(word) for name in entry.names):
        return 2
    if any(word in name for name in entry.names):
        return 3
    if word in entry.summary:
        return 3 if re.search(rf"(?<!\w){re.escape(word)}(?!\w)", entry.summary) else 4
    if word in entry.body:
        return 5 if re.search(rf"(?<!\w){re.escape(word)}(?!\w)", entry.body) else 6
    return WEAK


def _alternatives(word: str) -> list[str]:
    """Return the word and its singular; where no page holds them, the words most like it."""
    forms = [word, word[:-1]] if len(word) > 3 and word.endswith("s") else [word]
    if any(_rank(entry, form) < WEAK for entry in _index() for form in forms):
        return forms
    return [word, *get_close_matches(word, _vocabulary(), GUESSES, SIMILAR)]


@cache
def _index() -> tuple[_Entry, ...]:
    return tuple(
        _Entry(
            page,
            tuple(name.casefold() for name in (page.name, *page.words)),
            frozenset(page.also.casefold().split()),
            page.summary.casefold(),
            page.markdown.casefold(),
        )
        for page in topics().values()
    )


@cache
def _vocabulary() -> list[str]:
    """Every word of names and descriptions, the names first: of equally good guesses the first counts."""
    texts = [" ".join((*entry.names, *entry.also)) for entry in _index()]
    texts += [entry.summary for entry in _index()]
    return list(dict.fromkeys(word for text in texts for word in _WORD.findall(text) if len(word) > 2))
