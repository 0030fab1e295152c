"""What a pass knows about a problem, before anybody words it."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.diagnostics.wording import wording_of

if TYPE_CHECKING:
    from collections.abc import Mapping

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


def internal_error(what: str, error: BaseException) -> Diagnostic:
    """Return the problem that a fault of this program is to its user."""
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return Diagnostic("internal-error", facts={"what": what, "reason": reason.splitlines()[0]})


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


class _Missing(str):
    """`…`, whatever the form in which it is asked for."""

    __slots__ = ()

    def __format__(self, form: str) -> str:
        return str(self)


class _Facts(dict[str, object]):
    """Facts that never make formatting fail: a missing one shows as `…`."""

    def __missing__(self, key: str) -> str:
        return _Missing("…")
