"""What a pass knows about a problem, before anybody words it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass, field, replace
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
    def file(self) -> str | None:
        """Name of the program's file; None: it is about no program."""
        return self.source.name if self.source is not None else None

    @property
    def line(self) -> int | None:
        """Line in it, from 1; None: it has no place there."""
        return self._position[0]

    @property
    def column(self) -> int | None:
        """Column in the line, from 1."""
        return self._position[1]

    @property
    def _position(self) -> tuple[int, int] | tuple[None, None]:
        if self.source is None or self.span is None:
            return None, None
        return self.source.position(self.span.start)

    @property
    def message(self) -> str:
        """What is wrong, in plain words, one sentence without a full stop."""
        return self._said(wording_of(self.key).message)

    @property
    def hint(self) -> str | None:
        """What to do about it; None where nothing useful can be said."""
        close = self.facts.get("close")
        if close:
            return f"did you mean '{close}'?"
        text = wording_of(self.key).hint
        return self._said(text) if text else None

    def _said(self, text: str) -> str:
        return _visible(_counted(text, self.facts).format_map(_Facts(self.facts)))

    def within(self, source: Source) -> Diagnostic:
        """Return the same problem, placed in `source` if it has no source yet."""
        return self if self.source is not None else replace(self, source=source)


def internal_error(what: str, error: BaseException) -> Diagnostic:
    """Return the problem that a fault of this program is to its user."""
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return Diagnostic("internal-error", facts={"what": what, "reason": reason.splitlines()[0]})


_NUMBERED = re.compile(r"(\{(\w+)[^}]*\}(?: [a-z]+)+)\(s\)")


def _counted(text: str, facts: Mapping[str, object]) -> str:
    """Return a wording with `{n} state(s)` as `{n} state` or `{n} states`; `white(s)` is no such word."""
    if "(s)" not in text:
        return text
    return _NUMBERED.sub(
        lambda found: found[1] + ("" if str(facts.get(found[2])) in {"1", "1.0"} else "s"), text
    )


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
