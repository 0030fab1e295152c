"""What a fit is asked for: `k, r = 10 in [1, 100] log to x ~ position weights sigma, v loss soft_l1`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.analysis.request import Request
from desire_tui.analysis.unknowns import read_unknowns
from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from desire_tui.analysis.unknowns import Unknown
    from desire_tui.engine.source import Span

EXAMPLE = "fit k, r = 10 in [1, 100] to x ~ position, v ~ speed"
LOSSES = ("linear", "soft_l1", "huber", "cauchy", "arctan")
RUNS = 500


@dataclass(frozen=True)
class Pair:
    """A quantity of the program, the column it has to agree with, and the standard deviation there.

    `weights`: a column, a number, or None where it is to be estimated from the residuals.
    """

    quantity: str
    column: str
    weights: str | float | None
    span: Span


@dataclass(frozen=True)
class Asked:
    """All that is asked; `request` is where it stands, `files` are those that it names."""

    unknowns: list[Unknown]
    pairs: list[Pair]
    files: list[str]
    loss: str
    runs: int
    request: Request


def read_request(text: str) -> Asked:
    """Read what a fit is asked for. DesireError 520."""
    asked = Request(text, EXAMPLE)
    unknowns = read_unknowns(asked, "to")
    asked.expect("to")
    pairs = _pairs(asked)
    files: list[str] = []
    loss, runs = "linear", RUNS
    while not asked.is_done:
        word, span = asked.expect("from", "loss", "runs"), asked.span
        if word == "from":
            files += _files(asked)
        elif word == "loss":
            loss = asked.known(asked.name("a loss"), LOSSES, "loss", span)
        else:
            runs = asked.whole(1, f"runs {RUNS}")
    return Asked(unknowns, pairs, files, loss, runs, asked)


def read_comparison(text: str) -> Asked:
    """Read `x ~ position, v from 'measured.csv'`, by which nothing is varied. DesireError 520."""
    asked = Request(text, "measured x ~ position from 'measured.csv'")
    pairs = _pairs(asked)
    files: list[str] = []
    while not asked.is_done:
        asked.expect("from")
        files += _files(asked)
    return Asked([], pairs, files, "linear", 1, asked)


def _pairs(asked: Request) -> list[Pair]:
    pairs = []
    while True:
        span = asked.span
        quantity = asked.name("the name of a quantity")
        column = asked.text("the name of a column") if asked.take("~") else quantity
        weights: str | float | None = None
        if asked.take("weights"):
            place = asked.span
            weights = asked.number() if asked.peek()[:1].isdigit() else asked.text("a column or a number")
            if weights == 0.0:
                asked.fail("a standard deviation of 0 has no weight", "weights 0.1", place)
        pairs.append(Pair(quantity, column, weights, span))
        if not asked.take(","):
            return pairs


def _files(asked: Request) -> list[str]:
    found = [asked.file()]
    while asked.take(","):
        found.append(asked.file())
    return found
