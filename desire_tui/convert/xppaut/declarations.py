"""What a line of an `.ode` file declares."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from desire_tui.convert.xppaut.logical_lines import Line

Kind = Literal[
    "rate", "next", "initial", "function", "volterra", "fixed", "derived", "algebraic",  # equations
    "param", "number", "init", "aux", "wiener", "markov", "table", "global", "bndry", "volt", "solve",
    "special", "set", "only", "export", "options", "option", "matrix row", "unknown",
]  # fmt: skip
_WORDS: tuple[tuple[str, Kind], ...] = (
    ("parameters", "param"), ("number", "number"), ("initial", "init"), ("auxiliary", "aux"),
    ("wiener", "wiener"), ("markov", "markov"), ("tabular", "table"), ("table", "table"),
    ("global", "global"), ("bndry", "bndry"), ("boundary", "bndry"), ("bdry", "bndry"),
    ("volterra", "volt"), ("solve", "solve"), ("special", "special"), ("set", "set"), ("only", "only"),
    ("export", "export"), ("options", "options"),
)  # fmt: skip
"""Words that begin a line. XPPAUT looks at their first letters only; one letter stands for the first here."""

_FORMS: tuple[tuple[str, Kind], ...] = (
    (r"(?P<name>[a-z_]\w*)\s*'\s*=(?P<right>.*)", "rate"),
    (r"d(?P<name>[a-z_]\w*)\s*/\s*dt\s*=(?P<right>.*)", "rate"),
    (r"(?P<name>[a-z_]\w*)\s*\(\s*t\s*\+\s*1\s*\)\s*=(?P<right>.*)", "next"),
    (r"(?P<name>[a-z_]\w*)\s*\(\s*0\s*\)\s*=(?P<right>.*)", "initial"),
    (r"(?P<name>[a-z_]\w*)\s*\(\s*t\s*\)\s*=(?P<right>.*\bint\s*[\[{].*)", "volterra"),
    (r"(?P<name>[a-z_]\w*)\s*\((?P<dummies>[^()]*)\)\s*=(?P<right>.*)", "function"),
    (r"0\s*=(?P<name>)(?P<right>.*)", "algebraic"),
    (r"!\s*(?P<name>[a-z_]\w*)\s*=(?P<right>.*)", "derived"),
    (r"(?P<name>[a-z_]\w*)\s*=(?P<right>.*)", "fixed"),
)
_EQUATIONS = tuple((re.compile(pattern, re.IGNORECASE | re.ASCII), kind) for pattern, kind in _FORMS)
_WORD = re.compile(r"([a-z]+)\s+(\S.*)", re.IGNORECASE)


@dataclass(frozen=True)
class Declaration:
    """A line by what it declares. `right` is what stands behind the sign `=` or the word."""

    kind: Kind
    line: Line
    right: str
    name: str = ""
    dummies: tuple[str, ...] = ()


def declaration(line: Line) -> Declaration:
    """Tell what a line declares."""
    text = line.text
    if text.startswith("@"):
        return Declaration("option", line, text[1:])
    if text.startswith("{"):
        return Declaration("matrix row", line, text)
    word = _WORD.match(text)
    if word is not None and not word[2].startswith(("=", "'", "(")):
        for whole, kind in _WORDS:
            first = word[1].lower()
            if whole.startswith(first) or (len(first) > 2 and first.startswith(whole[:3])):
                return Declaration(kind, line, word[2].strip())
    for pattern, kind in _EQUATIONS:
        found = pattern.fullmatch(text)
        if found is not None:
            dummies = found.groupdict().get("dummies") or ""
            names = tuple(one.strip().lower() for one in dummies.split(",") if one.strip())
            return Declaration(kind, line, found["right"].strip(), found["name"], names)
    return Declaration("unknown", line, text)


_PAIR = re.compile(r"([a-z_]\w*)(?:\s*\(\s*0\s*\))?(?:\s*=\s*([^\s,=][^\s,=]*))?", re.IGNORECASE | re.ASCII)
_SEPARATOR = re.compile(r"[\s,;]*")


def pairs(text: str) -> list[tuple[str, str]] | None:
    """Return the names with their values ("" if left out) of `a=1, b=2 c`; None: it is no such list."""
    found, at = [], _SEPARATOR.match(text).end()  # type: ignore[union-attr]
    while at < len(text):
        pair = _PAIR.match(text, at)
        if pair is None:
            return None
        found.append((pair[1], pair[2] or ""))
        at = pair.end()
        rest = _SEPARATOR.match(text, at)
        assert rest is not None
        if rest.end() == at and at < len(text):
            return None
        at = rest.end()
    return found


def braced(text: str) -> list[str]:
    """Return what stands between the braces of `{a} {b}`."""
    return [one.strip() for one in re.findall(r"\{([^{}]*)\}", text)]
