"""Which known name was meant by an unknown one."""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

HINTS_MOST = 20
"""Unknown names of one text that are compared with all known ones: each takes some milliseconds."""
_hints_left: ContextVar[int | None] = ContextVar("hints_left", default=None)


@contextmanager
def few_hints() -> Iterator[None]:
    """Let `closest` look for the first names only: a text in which nothing is known is checked as fast."""
    token = _hints_left.set(HINTS_MOST)
    try:
        yield
    finally:
        _hints_left.reset(token)


def closest(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that `name` was probably meant to be, or None. `known` may not be looked at.

    Short words count as close after one slip of the fingers, which is too much for a ratio of equal letters.
    """
    left = _hints_left.get()
    if left is not None:
        if not left:
            return None
        _hints_left.set(left - 1)
    from difflib import get_close_matches  # 3 ms at every start, for the sake of mistakes

    candidates = list(known)
    if name in candidates:  # the name is right, what it stands for is not
        return None
    swapped = [word for word in candidates if _letters_swapped(name, word)]
    found = swapped or get_close_matches(name, candidates, n=1, cutoff=0.7)
    found = found or [word for word in candidates if len(name) > 2 and _one_letter_off(name, word)]
    return found[0] if found else None


def _differences(name: str, word: str) -> list[tuple[str, str]]:
    """Return the letters in which two words of one length differ; nothing for different lengths."""
    same_length = len(name) == len(word)
    return [pair for pair in zip(name, word, strict=True) if pair[0] != pair[1]] if same_length else []


def _letters_swapped(name: str, word: str) -> bool:
    """Whether two letters changed places, `fro` for `for`."""
    different = _differences(name, word)
    return len(different) == 2 and different[0] == different[1][::-1]


def _one_letter_off(name: str, word: str) -> bool:
    """Whether one letter is another (another digit, `x1` for `x2`, is no slip)."""
    different = _differences(name, word)
    return len(different) == 1 and "".join(different[0]).isalpha()
