"""Lines that differ only in names and numbers are read by one pattern, without looking at every token.

`d/dt v12 = a*(i11 - i12)` and 1400 lines like it have one skeleton: the line with a mark for each name and
number. Two replacements find it, and a function generated for the skeleton makes the statement's nodes out
of the words: twice as fast as the tokenizer. It learns from the tokenizer, which decides what a line means;
lines with keywords, comments, strings or several statements are left to it.

Of these 1400, 100 at a time have words of the same lengths too, so that the words stand at the same places:
such a layout, the line with `a` for each letter and `0` for each digit, is found by one translation.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from functools import partial
from itertools import accumulate
from math import isinf
from operator import itemgetter
from string import ascii_letters, digits
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.left_chains import LONG
from desire_tui.engine.nodes.lazy_parts import LineForm
from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.syntax import shapes
from desire_tui.engine.syntax.statement_tokens import NAME, NUMBER
from desire_tui.engine.syntax.tokens import INFINITE_MIN
from desire_tui.engine.syntax.words import KEYWORDS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.nodes.assignments import Assign
    from desire_tui.engine.nodes.segment import Derivative
    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.syntax.statement_tokens import StatementTokens

PATTERNS_ROOM = 500
"""Patterns of earlier programs."""
LENGTH_MOST = 1000
"""Characters: longer lines are few, and some are too long."""
_DERIVATIVE = "d/dt "
_NAME_TEXT = r"(?<![A-Za-z0-9$_.])[A-Za-z][A-Za-z0-9$_]*"
_NUMBER_TEXT = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_NAMES = re.compile(_NAME_TEXT)
_NUMBERS = re.compile(_NUMBER_TEXT)
_WORDS = re.compile(f"{_NAME_TEXT}|{_NUMBER_TEXT}")
_LOGICAL = frozenset({"and", "or", "not"})
_DERIVATIVE_HEADS = frozenset(KEYWORDS)
_HEADS = _DERIVATIVE_HEADS | {"d"}
"""What means more than a name at the start of a line; a derivative's `d` is told by its layout."""
_DIGITS_MOST = 300
"""Numbers with fewer, and without an exponent, are finite."""


class _Pattern(NamedTuple):
    """How many words a line has, and what makes its statement from them and from their lengths added up.

    `lazy`: what makes its form, if its parts can be made later.
    """

    words: int
    make: shapes.MakerOfWords
    base: int
    lazy: Callable[[Sequence[int]], LineForm[Derivative | Assign]] | None


class _Layout(NamedTuple):
    """Where the words of a line stand, their lengths added up, and what the first must not be."""

    pattern: _Pattern
    form: LineForm[Derivative | Assign] | None
    words: Callable[[str], tuple[str, ...]]
    lengths: list[int]
    heads: frozenset[str]


_LAYOUTS_ROOM = 2000
"""Layouts of earlier programs: some 1 KB each."""
_layouts: RecentlyUsed[str, _Layout] = RecentlyUsed(_LAYOUTS_ROOM)
_layouts_seen: RecentlyUsed[str, bool] = RecentlyUsed(_LAYOUTS_ROOM)
_CLASSES = str.maketrans(
    {character: "a" for character in ascii_letters if character not in "eE"} | dict.fromkeys(digits, "0")
)
"""All that the place of a word depends on: an `e` may stand in a number."""
_patterns: RecentlyUsed[str, _Pattern] = RecentlyUsed(PATTERNS_ROOM)
_seen: RecentlyUsed[str, bool] = RecentlyUsed(PATTERNS_ROOM)


def read(line: str) -> tuple[Statement, int] | None:
    """Return the statement of a line, and where it begins, if the line's pattern is known."""
    if len(line) > LENGTH_MOST:
        return None
    classes = line.translate(_CLASSES)
    if line.startswith(_DERIVATIVE):
        classes = _DERIVATIVE + classes
    layout = _layouts[classes]
    if layout is None:
        return _read_anew(line, classes)
    words = layout.words(line)
    if words[0] in layout.heads or not _LOGICAL.isdisjoint(words):
        return None
    pattern, form = layout.pattern, layout.form
    return pattern.make(words, layout.lengths) if form is None else form.line(words), pattern.base


def _read_anew(line: str, classes: str) -> tuple[Statement, int] | None:
    """Look for the line's words; the second line of a layout is worth keeping it."""
    pattern = _patterns[_skeleton(line)]
    if pattern is None:
        return None
    words = _WORDS.findall(line)
    if len(words) != pattern.words or not _are_plain(line, words):
        return None
    numbers = [word for word in words if not word[0].isalpha()]
    if any(isinf(float(number)) for number in numbers):
        return None  # a fault that the tokenizer reports
    lengths = [*accumulate(map(len, words))]
    form = pattern.lazy(lengths) if pattern.lazy is not None and len(line) < LONG else None
    if not _layouts_seen[classes]:
        _layouts_seen.keep(classes, True)
    elif len(words) > 1 and all(map(_is_always_finite, numbers)):
        heads = _DERIVATIVE_HEADS if line.startswith(_DERIVATIVE) else _HEADS
        places = itemgetter(*(slice(*word.span()) for word in _WORDS.finditer(line)))
        _layouts.keep(classes, _Layout(pattern, form, places, lengths, heads))
    return pattern.make(words, lengths) if form is None else form.line(words), pattern.base


def _is_always_finite(number: str) -> bool:
    """Whether a number is finite whatever its digits are."""
    return len(number) < INFINITE_MIN or (len(number) < _DIGITS_MOST and "e" not in number.lower())


def learn(line: str, chunk: StatementTokens) -> None:
    """Make a pattern for lines like this one, which holds this sound statement and nothing else.

    The second line of a kind is worth it.
    """
    if len(line) > LENGTH_MOST:
        return
    skeleton = _skeleton(line)
    if not _seen[skeleton]:
        _seen.keep(skeleton, True)
        return
    words = _WORDS.findall(line)
    places = _places(line, chunk, words)
    if places is None or not _are_plain(line, words) or not line.isascii():
        return
    make = shapes.function_of_words(chunk, places)
    if make is not None:
        _patterns.keep(skeleton, _Pattern(len(words), make, chunk.base, _lazy(chunk, places, words)))


def _lazy(
    chunk: StatementTokens, places: shapes.WordPlaces, words: Sequence[str]
) -> Callable[[Sequence[int]], LineForm[Derivative | Assign]] | None:
    """Return what makes the form of a line from the lengths of its words, added up."""
    found = shapes.makers_of_parts(chunk, places)
    if found is None:
        return None
    kind, makers = found
    numbered = [f"#{k}" if word[0].isalpha() else str(k) for k, word in enumerate(words)]
    target, value = (makers[part](numbered, (0,) * len(words)) for part in ("target", "value"))
    return partial(LineForm, kind, int(target.name[1:]), value, makers)


def age() -> None:
    """Between two programs: forget patterns that no program of late had."""
    _patterns.age()
    _layouts.age()
    _layouts_seen.age()
    _seen.age()


def forget() -> None:
    """Forget all patterns."""
    _patterns.forget()
    _layouts.forget()
    _layouts_seen.forget()
    _seen.forget()


def _skeleton(line: str) -> str:
    """Return the line with a mark for each name and each number."""
    marked = _NUMBERS.sub("\2", _NAMES.sub("\1", line))
    return _DERIVATIVE + marked if line.startswith(_DERIVATIVE) else marked


def _are_plain(line: str, words: Sequence[str]) -> bool:
    """Whether no word means more than a name or a number, and nothing joins the line to the next."""
    if not words or (words[-1][-1] == "_" and line.rstrip().endswith("_")):
        return False
    first = words[0]
    means_more = first in KEYWORDS or (first == "d" and not line.startswith(_DERIVATIVE))
    return not means_more and _LOGICAL.isdisjoint(words)


def _places(line: str, chunk: StatementTokens, words: list[str]) -> shapes.WordPlaces | None:
    """Find each token among the words; None if the line has words that are no tokens, or goes on behind."""
    begins = [found.start() for found in _WORDS.finditer(line)]
    numbers: list[int] = []
    for kind, text, start in zip(chunk.kinds, chunk.texts, chunk.starts, strict=True):
        number = bisect_left(begins, chunk.base + start)
        if kind in (NAME, NUMBER):
            if number >= len(words) or begins[number] != chunk.base + start or words[number] != text:
                return None
        elif text[:1].isalnum() and text != _DERIVATIVE.strip():
            return None
        numbers.append(number)
    last = chunk.base + chunk.ends[-1]
    if line[last:].strip(" \t") or (begins and begins[-1] >= last):
        return None
    lengths = [0, *accumulate(map(len, words))]
    ends = [begin + len(word) for begin, word in zip(begins, words, strict=True)]

    def place(offset: int) -> str:
        before = bisect_right(ends, chunk.base + offset)
        constant = offset - lengths[before]
        return f"{constant:d}" if before == 0 else f"c[{before - 1:d}] + {constant:d}"

    return shapes.WordPlaces(
        numbers, [place(start) for start in chunk.starts], [place(end) for end in chunk.ends]
    )
