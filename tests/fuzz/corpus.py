"""The texts that mutations start from: examples, the suite's programs, pieces of the language."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tests.check.test_robustness import PIECES as STATEMENT_PIECES
from tests.strategies import PIECES as TOKEN_PIECES

ROOT = Path(__file__).parents[2]
ODD = [
    "1e308",
    "-1e308",
    "1e-320",
    "5e-324",
    "0",
    "-0",
    "-1",
    "2^53",
    "2^63",
    "2^64",
    "1e19",
    "99999999999",
    "&&FFFF",
    "&777",
    "é",
    "–",
    "𝒳",
    "\u2028",
    "\u202e",
    "\x1b",
    "\x00",
    "\ufeff",
    "\x7f",
    "'",
    '"\n[',
    "]",
    "(",
    ")",
    "{",
    "}",
    "|",
    "--",
    "_",
    "\r",
    "\t",
    "$",
    "%",
    "#",
    "##",
    "&",
    ";",
    "NN=1e9",
    "NN=-5",
    "TMAX=-1",
    "TMAX=1e308",
    "DT=0",
    "DT=1e-300",
    "irule=9",
    "ERMAX=0",
    "scale=0",
    "MM=-3",
    "MM=2^64\nCHECKN=9",
    "ran()",
    "invoke",
    "JACOBIAN",
    "repeat",
    "next",
    "d/dt",
    "Vectr",
    "MATRIX",
    "DYNAMIC",
    "STOP",
    "OUT",
    "step",
    "drun",
    "reset",
    "clear",
    "exit",
]
PIECES = (*STATEMENT_PIECES, *TOKEN_PIECES, *ODD)


@cache
def programs() -> tuple[str, ...]:
    """Return the suite's small programs."""
    return tuple(path.read_text("utf-8") for path in sorted(ROOT.glob("tests/programs/*/*.src")))


@cache
def texts() -> tuple[str, ...]:
    """Return small programs and examples."""
    return (
        *programs(),
        *(path.read_text("utf-8") for path in sorted(ROOT.glob("examples/**/*.src"))),
    )
