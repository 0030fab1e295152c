"""Damages a text: bytes, tokens, numbers, lines, splices of two texts."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from tests.fuzz.corpus import PIECES, texts

if TYPE_CHECKING:
    from random import Random

_TOKENS = re.compile(r"[A-Za-z_$]\w*|[0-9.]+(?:[eE][+-]?\d+)?|\s+|.", re.DOTALL)
_NUMBER = re.compile(r"\d+(?:\.\d*)?")
_NUMBERS = ("0", "1", "2", "-1", "0.5", "1e308", "1e-320", "1e19", "9007199254740993", "1e5", "3.7")


def mutated(text: str, rng: Random, most: int = 4) -> str:
    """Return the text with one to `most` things changed."""
    for _ in range(rng.randint(1, most)):
        text = rng.choice(_WAYS)(text, rng)
    return text


def window(text: str, rng: Random, rows_most: int = 12) -> str:
    """Return some rows of a text that follow each other."""
    rows = text.splitlines(keepends=True)
    first = rng.randrange(max(len(rows), 1))
    return "".join(rows[first : first + rng.randint(1, rows_most)])


def _bytes(text: str, rng: Random) -> str:
    raw = bytearray(text.encode("utf-8", "surrogatepass"))
    if raw:
        for _ in range(rng.randint(1, 3)):
            raw[rng.randrange(len(raw))] = rng.randrange(256)
    return raw.decode(rng.choice(("latin-1", "utf-8")), "replace")


def _pieces(pieces: list[str], rng: Random) -> str:
    place = rng.randrange(len(pieces)) if pieces else 0
    match rng.randrange(5):
        case 0:
            del pieces[place : place + rng.randint(1, 3)]
        case 1:
            pieces.insert(place, rng.choice(pieces or PIECES))
        case 2:
            pieces[place : place + 1] = [rng.choice(PIECES)]
        case 3 if pieces:
            other = rng.randrange(len(pieces))
            pieces[place], pieces[other] = pieces[other], pieces[place]
        case _:
            pieces.insert(place, f"{rng.choice(PIECES)}{rng.choice(['', ' ', chr(10)])}")
    return "".join(pieces)


def _tokens(text: str, rng: Random) -> str:
    return _pieces(_TOKENS.findall(text), rng)


def _lines(text: str, rng: Random) -> str:
    return _pieces(text.splitlines(keepends=True), rng)


def _numbers(text: str, rng: Random) -> str:
    found = list(_NUMBER.finditer(text))
    if not found:
        return text
    number = rng.choice(found)
    return text[: number.start()] + rng.choice(_NUMBERS) + text[number.end() :]


def _splice(text: str, rng: Random) -> str:
    other = window(rng.choice(texts()), rng)
    cut = rng.randrange(len(text) + 1)
    if rng.random() < 0.5:
        return text[:cut] + other
    return other[: rng.randrange(len(other) + 1)] + text[cut:]


_WAYS = (_bytes, _tokens, _tokens, _lines, _numbers, _splice)
