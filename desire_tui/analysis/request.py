"""Reading what is asked: `k, r = 10 in [1, 100] to x ~ position`. One cursor over the words of a request.

Every mistake is told with the request underlined at its place.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NoReturn

from desire_tui.engine.diagnostics import DesireError, Diagnostic, closest
from desire_tui.engine.source import Source, Span

if TYPE_CHECKING:
    from collections.abc import Iterable

REQUEST = "<request>"
_TOKEN = re.compile(
    r"\s*(?:(?P<text>'[^']*'|\"[^\"]*\")|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
    r"|(?P<name>[A-Za-z_$][\w$]*(?:\[[^\]\n]*\])?)|(?P<mark>->|[^\s\w]))"
)
_BARE_FILE = re.compile(r"[^\s,'\"]+")
_OPEN, _CLOSE = "([{", ")]}"


class Request:
    """A cursor over a request. DesireError 520: what is wrong, and an `example` of what is right."""

    def __init__(self, text: str, example: str) -> None:
        self.source = Source(text, REQUEST)
        self._example = example
        self._tokens = list(_TOKEN.finditer(text))
        self._at = 0

    @property
    def is_done(self) -> bool:
        """Whether all is read."""
        return self._at >= len(self._tokens)

    @property
    def span(self) -> Span:
        """Place of the next word; of the end if there is none."""
        if self.is_done:
            return Span(len(self.source.text), len(self.source.text))
        token = self._tokens[self._at]
        kind = token.lastgroup or "mark"
        return Span(token.start(kind), token.end(kind))

    def peek(self) -> str:
        """Return the next word, empty at the end."""
        span = self.span
        return self.source.text[span.start : span.end]

    def take(self, *words: str) -> str:
        """Go past the next word if it is one of these, and return it; else return nothing."""
        word = self.peek()
        if word not in words or self.is_done:
            return ""
        self._at += 1
        return word

    def expect(self, *words: str) -> str:
        """Go past the next word, which has to be one of these."""
        found = self.take(*words)
        if not found:
            self.fail(f"{self._seen()} where {_listed(words)} is expected")
        return found

    def name(self, what: str = "a name") -> str:
        """Read a name, `k` or `A[2]`."""
        if self.is_done or self._tokens[self._at].lastgroup != "name":
            self.fail(f"{self._seen()} where {what} is expected")
        found = self.peek().replace(" ", "")
        self._at += 1
        return found

    def text(self, what: str = "a text in quotes") -> str:
        """Read a text in quotes, or a plain name."""
        if self.is_done or self._tokens[self._at].lastgroup not in ("text", "name"):
            self.fail(f"{self._seen()} where {what} is expected")
        found = self.peek().strip("'\"")
        self._at += 1
        return found

    def file(self) -> str:
        """Read a file's name, with or without quotes; without, it ends at a blank or a comma."""
        if self.is_done or self._tokens[self._at].lastgroup == "text":
            return self.text("a file's name")
        begin = self.span.start
        found = _BARE_FILE.match(self.source.text, begin)
        if found is None:
            self.fail(f"{self._seen()} where a file's name is expected")
        while not self.is_done and self.span.start < found.end():
            self._at += 1
        return found[0]

    def number(self, what: str = "a number") -> float:
        """Read a number with its sign."""
        begin = self._at
        sign = -1.0 if self.take("-") else 1.0
        self.take("+")
        if self.is_done or self._tokens[self._at].lastgroup != "number":
            self._at = begin
            self.fail(f"{self._seen()} where {what} is expected")
        found = sign * float(self.peek())
        self._at += 1
        return found

    def whole(self, least: int, example: str) -> int:
        """Read a whole number that is not less than `least`."""
        span = self.span
        found = self.number("a whole number")
        if not (found >= least and found == int(found)):
            self.fail(f"{found:g} is no whole number from {least} on", example, span)
        return int(found)

    def interval(self) -> tuple[float, float]:
        """Read `[from, to]`, the first less than the second."""
        begin = self.span
        self.expect("[")
        low = self.number()
        self.expect(",")
        high = self.number()
        end = self.span
        self.expect("]")
        if not low < high:
            self.fail(f"the interval from {low:g} to {high:g} holds nothing", f"[{high:g}, {low:g}]",
                      Span(begin.start, end.end))  # fmt: skip
        return low, high

    def expression(self, *stops: str) -> str:
        """Read the text of an expression up to one of these words outside brackets, or to the end."""
        begin, depth = self.span.start, 0
        end = begin
        while not self.is_done and (depth or self.peek() not in stops):
            word = self.peek()
            depth += (word in _OPEN) - (word in _CLOSE)
            end = self.span.end
            self._at += 1
        found = self.source.text[begin:end]
        if not found:
            self.fail(f"{self._seen()} where an expression is expected")
        return found

    def end(self) -> None:
        """Nothing more may follow."""
        if not self.is_done:
            self.fail(f"{self._seen()} at the end, where nothing is expected")

    def known(self, name: str, names: Iterable[str], what: str, span: Span | None = None) -> str:
        """Return a name that has to be one of these; the nearest is named where it is not."""
        every = list(names)
        if name not in every:
            near = closest(name, every)
            shown = ", ".join(every[:8]) + (", …" if len(every) > 8 else "")
            self.fail(
                f"'{name}' is no {what}", f"did you mean {near}?" if near else f"there are {shown}", span
            )
        return name

    def fail(self, what: str, remedy: str = "", span: Span | None = None) -> NoReturn:
        """Raise a mistake at a place, by default the next word's."""
        facts = {"what": what, "remedy": remedy or f"for instance: {self._example}"}
        raise DesireError(Diagnostic("analysis-form", span or self.span, facts, self.source))

    def _seen(self) -> str:
        return f"'{self.peek()}' stands" if not self.is_done else "the request ends"


def _listed(words: tuple[str, ...]) -> str:
    quoted = [f"'{word}'" for word in words]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} or {quoted[-1]}"
