"""Expectations in a program's comments: what a program must show when it is run.

    --? x = 1.193253129                    final value of a quantity
    --? run 2: max(X) + scale = 1.5887     samples of a run; X and t are arrays (0-based), nth, at, last … below;
                                           (`at` and `peak` without it: of the last run);
                                           steps, rejected, calls, jacobians count, least and most are steps
    --? x = 1.19 +- 1e-6                   absolute tolerance; `+- 1e-6 rel` relative; `<` and `>` need none
    --? with ERMAX = 1e-8 | NN = 11: …     the same, checked on another run with these values overridden
    --? runs = 18        --? points = 100  how many runs were made, points plotted (of a run: its samples)
    --? prints 'one\\ttwo'                  the console shows this text (\\t, \\n as in Python)
    --? console                            the console shows exactly the `--| …` lines that follow
    --? error 200 at 12                    the program fails with this error (at this row)
    --? warning 3 at 12                    a warning with this number (at this row) is given, once
    --? go                                 STOPs are answered by go
    --? answers 3 | 14 | !                 what is typed at input
    --? reference TMAX = 1 | NN = 101      the slow reference back end runs with these values overridden
    --? compare 1e-4                       how far the two back ends may differ (relative; 1e-12 if not said)

The program's own names come before these words. A number with six or more digits that stands alone on the right is met if it is met to half a unit of its last digit;
otherwise the tolerance is 1e-9 of it.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, field
from decimal import Decimal, InvalidOperation

Settings = tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Check:
    """`left op right`, on the final values or on run number `run`, with `settings` overridden."""

    row: int
    text: str
    left: str
    op: str
    right: str
    tolerance: float | None
    relative: bool
    run: int | None = None
    settings: Settings = ()


@dataclass
class Expectations:
    """Everything a program's comments expect."""

    checks: list[Check] = field(default_factory=list)
    prints: list[str] = field(default_factory=list)
    console: list[str] | None = None
    error: tuple[int, int | None] | None = None
    warnings: list[tuple[int, int | None]] = field(default_factory=list)
    go: bool = False
    answers: list[str] = field(default_factory=list)
    reference: Settings = ()
    compare: float = 1e-12

    @property
    def variants(self) -> list[Settings]:
        """The overrides under which something is to be checked."""
        return list(dict.fromkeys(check.settings for check in self.checks))


def read_expectations(text: str) -> Expectations:
    """Collect a program's expectations; ValueError names the row of one that cannot be understood."""
    found = Expectations()
    for row, line in enumerate(text.splitlines(), 1):
        if line.startswith("--|"):
            assert found.console is not None, f"row {row}: a console line without --? console"
            found.console.append(line[4:] if line[3:4] == " " else line[3:])
        elif line.startswith("--?"):
            _read(found, row, line[3:].strip())
    return found


def _read(found: Expectations, row: int, text: str) -> None:
    word, _, rest = text.partition(" ")
    if text == "go":
        found.go = True
    elif text == "console":
        found.console = []
    elif word == "answers":
        found.answers = [answer.strip() for answer in rest.split(" | ")]
    elif word == "reference":
        found.reference = read_settings(rest)
    elif word == "compare" and re.fullmatch(r"[-\d.e]+", rest):
        found.compare = float(rest)
    elif word == "prints":
        found.prints.append(ast.literal_eval(rest))
    elif word in ("error", "warning"):
        match = re.fullmatch(r"(\d+)(?: at (\d+))?", rest)
        if match is None:
            raise ValueError(f"row {row}: {text}")
        problem = (int(match[1]), int(match[2]) if match[2] else None)
        if word == "error":
            found.error = problem
        else:
            found.warnings.append(problem)
    else:
        found.checks.append(_check(row, text))


def read_settings(text: str) -> Settings:
    """Read `A = 1 | B = 2`."""
    pairs = (part.partition("=") for part in text.split("|"))
    return tuple((name.strip(), float(value)) for name, _, value in pairs)


def _check(row: int, text: str) -> Check:
    settings: Settings = ()
    run = None
    rest = text
    if match := re.match(r"with (.*?): ", rest):
        settings = read_settings(match[1])
        rest = rest[match.end() :]
    if match := re.match(r"run (-?\d+): ", rest):
        run = int(match[1])
        rest = rest[match.end() :]
    body, _, tolerance = rest.partition(" +- ")
    left, op, right = _split(body, row)
    relative = tolerance.endswith(" rel")
    bound = float(tolerance.removesuffix(" rel")) if tolerance else None
    if bound is None and op == "=":
        bound, relative = _implied(right)
    return Check(row, text, left, op, right, bound, relative, run, settings)


def _split(text: str, row: int) -> tuple[str, str, str]:
    """Split at the relation outside all brackets."""
    depth = 0
    for i, char in enumerate(text):
        depth += (char in "([") - (char in ")]")
        if depth == 0 and text[i : i + 3] in (" = ", " < ", " > "):
            return text[:i], text[i + 1], text[i + 3 :]
    raise ValueError(f"row {row}: no relation in {text!r}")


def _implied(right: str) -> tuple[float, bool]:
    """Tolerance of a number given without one: half a unit of its last digit if it has six or more."""
    try:
        number = Decimal(right)
    except InvalidOperation:
        return 1e-9, True
    _, digits, exponent = number.as_tuple()
    if len(digits) < 6 or not isinstance(exponent, int):
        return 1e-9, True
    return max(0.5000001 * 10.0**exponent, 1e-9 * abs(float(number))), False
