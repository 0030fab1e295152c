"""What a pass knows about a problem, before anybody words it."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.diagnostics.wording import wording_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from desire_tui.engine.source import Source, Span

Severity = Literal["error", "warning"]


@dataclass(frozen=True)
class Diagnostic:
    """One problem: a key into the wording tables, where it is, and the facts its sentence needs.

    `span` counts from the start of `source.text`; either may be missing (a missing file has no line).
    `related` points at a second place, such as the line that invoked a submodel.
    """

    key: str
    span: Span | None = None
    facts: Mapping[str, object] = field(default_factory=dict)
    source: Source | None = None
    severity: Severity = "error"
    related: tuple[Diagnostic, ...] = ()

    @property
    def code(self) -> int:
        """Desire's error number."""
        return wording_of(self.key).code

    @property
    def message(self) -> str:
        """What is wrong, in plain words, one sentence without a full stop."""
        return _visible(_counted(wording_of(self.key).message.format_map(_Facts(self.facts))))

    @property
    def hint(self) -> str | None:
        """What to do about it; None where nothing useful can be said."""
        close = self.facts.get("close")
        if close:
            return f"did you mean '{close}'?"
        text = wording_of(self.key).hint
        return _visible(_counted(text.format_map(_Facts(self.facts)))) if text else None

    def within(self, source: Source) -> Diagnostic:
        """Return the same problem, placed in `source` if it has no source yet."""
        return self if self.source is not None else replace(self, source=source)


class DesireError(Exception):
    """A user's mistake, on its way to the one place that shows it. Holds at least one diagnostic."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__(*(d.key for d in diagnostics))
        self.diagnostics = diagnostics

    def placed(self, span: Span, source: Source | None) -> DesireError:
        """Return the error with problems that have no place of their own placed here."""
        if all(d.span is not None for d in self.diagnostics):
            return self
        return DesireError(
            *(
                d if d.span is not None else replace(d, span=span, source=d.source or source)
                for d in self.diagnostics
            )
        )

    def __str__(self) -> str:
        return "; ".join(f"error {d.code}: {d.message}" for d in self.diagnostics)


def closest(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that `name` was probably meant to be, or None.

    Short words count as close after one slip of the fingers, which is too much for a ratio of equal letters.
    """
    from difflib import get_close_matches  # 3 ms at every start, for the sake of mistakes

    candidates = list(known)
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


def _counted(sentence: str) -> str:
    """Return the sentence with `1 state(s)` as `1 state`, `2 state(s)` as `2 states`."""
    if "(s)" not in sentence:
        return sentence
    return re.sub(r"\b1 ([a-z ]+)\(s\)", r"1 \1", sentence).replace("(s)", "s")


def _visible(sentence: str) -> str:
    r"""Return the sentence with control characters as `\x1b`: they would steer the terminal."""
    if sentence.isprintable():
        return sentence
    return "".join(char if char.isprintable() else repr(char)[1:-1] for char in sentence)


class _Facts(dict[str, object]):
    """Facts that never make formatting fail: a missing one shows as `…`."""

    def __missing__(self, key: str) -> str:
        return "…"
