"""What is searched for and where it stands: text in, places out."""

from __future__ import annotations

import re
import warnings
from contextlib import contextmanager
from functools import lru_cache
from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.editor.time_limit import TookTooLong, at_most
from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from textual.document._document import Location

    Range = tuple[Location, Location]

HITS_MAX = 20_000
"""So many occurrences are counted."""
PATIENCE_S, PATIENCE_FOR_ALL_S = 0.25, 1.0
"""A search, and replacing everything, may take so long: some expressions would take years."""
_BEFORE, _BEHIND = r"(?<![\w$])(?:", r")(?![\w$])"
"""Around a whole word: the letters of a name in this language."""
_ESCAPE = re.compile(r"\\.")
_SENTENCES = (
    ("missing ), unterminated subpattern", "a ( is not closed"),
    ("unbalanced parenthesis", "a ) closes nothing"),
    ("unterminated character set", "a [ is not closed"),
    ("nothing to repeat", "nothing to repeat stands before * + ? or {"),
    ("multiple repeat", "a repetition is repeated"),
    ("bad escape (end of pattern)", "a \\ stands alone at the end; \\\\ means the character itself"),
    ("bad escape (end of template)", "a \\ stands alone at the end; \\\\ means the character itself"),
    ("bad escape", "this \\ means nothing; \\\\ means the character itself"),
    ("bad character range", "a range in [ ] runs backwards"),
    ("invalid group reference", "there is no group of that number"),
    ("missing >, unterminated name", "the name of a group ends in >"),
    ("unknown group name", "there is no group of that name"),
    ("min repeat greater than max repeat", "the numbers in { } stand the wrong way round"),
    ("look-behind requires fixed-width pattern", "what (?<= ) looks for must have a fixed length"),
    ("global flags not at the start", "flags such as (?i) belong at the start"),
    ("unexpected end of pattern", "the expression breaks off"),
    ("unknown extension", "these characters after (? mean nothing"),
)
"""Python's messages about expressions, in plain words."""


class Unsearchable(ValueError):  # noqa: N818 - a statement about what is wanted
    """Nothing can be searched for with this; the sentence says why."""


Hit = tuple[int, int, int]
"""An occurrence: row, first column, column behind it. None goes beyond its row."""


class Replaced(NamedTuple):
    """What replacing everything does: rows `top` … `bottom` become `lines`."""

    top: int
    bottom: int
    lines: list[str]
    places: int


def span(hit: Hit) -> Range:
    """Return where an occurrence begins and ends in the text."""
    row, start, end = hit
    return (row, start), (row, end)


@dataclass(frozen=True, slots=True)
class SearchRequest:
    """What is searched for."""

    text: str
    case: bool | None = None
    """Whether capitals count; None: only if the text has some."""
    word: bool = False
    """Whether it must be a whole name or number."""
    regex: bool = False
    """Whether the text is a regular expression."""

    @property
    def minds_case(self) -> bool:
        """Whether capitals count."""
        if self.case is not None:
            return self.case
        letters = _ESCAPE.sub("", self.text) if self.regex else self.text
        return letters != letters.lower()

    def pattern(self) -> re.Pattern[str]:
        """Return it as an expression. Raises Unsearchable."""
        return _compiled(self.text, self.minds_case, self.word, self.regex)

    def hits(self, lines: Sequence[str], within: Range | None = None) -> list[Hit]:
        """Return its occurrences in order, at most HITS_MAX, inside `within` only. Raises Unsearchable."""
        if not self.text:
            return []
        find = self.pattern().finditer
        first, last = (within[0][0], within[1][0]) if within else (0, len(lines) - 1)
        with _limited(PATIENCE_S):
            every = ((row, *hit.span()) for row in range(first, last + 1) for hit in find(lines[row]))
            return list(islice((hit for hit in every if _is_inside(hit, within)), HITS_MAX))

    def replaced(self, lines: Sequence[str], hit: Hit, by: str) -> str:
        """Return what an occurrence becomes; groups are put in for an expression. Raises Unsearchable."""
        if not self.regex:
            return by
        row, start, _ = hit
        with _limited(PATIENCE_S):
            match = self.pattern().match(lines[row], start)
            return by if match is None else match.expand(by)

    def all_replaced(self, lines: Sequence[str], by: str, within: Range | None = None) -> Replaced:
        """Return the rows that change, with every occurrence replaced. Raises Unsearchable."""
        pattern, text = self.pattern(), by if self.regex else by.replace("\\", r"\\")
        first, last = (within[0][0], within[1][0]) if within else (0, len(lines) - 1)
        rows: list[str] = []
        top, bottom, count = -1, -1, 0
        with _limited(PATIENCE_FOR_ALL_S):
            for row in range(first, last + 1):
                line = lines[row]
                if within is None or first < row < last:
                    line, found = pattern.subn(text, line)
                else:
                    line, found = _replaced_inside(pattern, text, row, line, within)
                rows.append(line)
                count += found
                if found:
                    top, bottom = row if top < 0 else top, row
        changed = rows[top - first : bottom + 1 - first] if count else []
        return Replaced(top, bottom, "\n".join(changed).split("\n"), count)


def _is_inside(hit: Hit, within: Range | None) -> bool:
    start, end = span(hit)
    return within is None or (within[0] <= start and end <= within[1])


def _replaced_inside(
    pattern: re.Pattern[str], by: str, row: int, line: str, within: Range
) -> tuple[str, int]:
    count = 0

    def one(match: re.Match[str]) -> str:
        nonlocal count
        if not _is_inside((row, *match.span()), within):
            return match.group()
        count += 1
        return match.expand(by)

    return pattern.sub(one, line), count


@contextmanager
def _limited(seconds: float) -> Iterator[None]:
    try:
        with at_most(seconds):
            yield
    except TookTooLong:
        raise Unsearchable("this expression takes too long; perhaps it can match in too many ways") from None
    except (re.error, IndexError) as error:
        raise Unsearchable(f"the replacement: {explained(error)}") from None


@lru_cache(maxsize=16)
def _compiled(text: str, case: bool, word: bool, regex: bool) -> re.Pattern[str]:
    body = text if regex else re.escape(text)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about what a later Python may understand otherwise
            if regex:
                re.compile(body)  # for itself first: places in messages are those of the user's text
            return re.compile(
                f"{_BEFORE}{body}{_BEHIND}" if word else body, re.NOFLAG if case else re.IGNORECASE
            )
    except re.error as error:
        raise Unsearchable(explained(error)) from None
    except (OverflowError, RecursionError):
        raise Unsearchable("this expression is too large") from None


def explained(error: re.error | IndexError) -> str:
    """Return what is wrong with an expression, and where."""
    message = getattr(error, "msg", str(error))
    sentence = next((plain for start, plain in _SENTENCES if message.startswith(start)), message)
    at = getattr(error, "pos", None)
    return sentence if at is None else f"{sentence} (character {at + 1})"
