"""Damaged texts through all that an editor asks of one: parse, check, colours, completion."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING
from zlib import crc32

from desire_tui.engine.check.checker import check as check_program
from desire_tui.engine.check.state_order import state_order
from desire_tui.engine.diagnostics import render_all
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.highlighting import highlight
from desire_tui.engine.syntax.parse import parse, parse_command
from desire_tui.engine.syntax.statement_rows import before
from desire_tui.language.completion import around, offers
from desire_tui.language.line_tokens import word_before
from tests.fuzz.corpus import PIECES
from tests.fuzz.corpus import texts as corpus
from tests.fuzz.mutations import mutated, window

if TYPE_CHECKING:
    from random import Random

    from desire_tui.engine.diagnostics import Diagnostic

_WHOLE_TEXTS, _PIECES_ONLY = 0.01, 0.3
_EDITOR_EVERY, _SESSION_EVERY = 4, 16
"""One input in so many goes through colours and completion, and through the check of a session."""


def generate(rng: Random) -> str:
    """Return a damaged program, some of its rows, or pieces in a row."""
    kind = rng.random()
    if kind < _WHOLE_TEXTS:
        return mutated(rng.choice(corpus()), rng)
    if kind < _PIECES_ONLY:
        glue = rng.choice(("", " ", " | "))
        return "\n".join(
            glue.join(rng.choices(PIECES, k=rng.randint(1, 7))) for _ in range(rng.randint(1, 6))
        )
    return mutated(window(rng.choice(corpus()), rng, rows_most=6), rng)


def check(text: str) -> None:
    """Hold every answer to its form: numbers, words, places within the text."""
    program = parse(Source(text, "t"))
    problems = check_program(program)
    _well_formed(problems, text)
    state_order(program)
    chance = crc32(text.encode("utf-8", "surrogatepass"))
    if chance % _EDITOR_EVERY == 0:
        parse_command(Source(text, "<command>"))
        _edited(text.split("\n"), chance)
    if chance % _SESSION_EVERY == 1:
        found = _session().check(Source(text, "t"))
        _well_formed(found, text)
        assert "Traceback" not in render_all(found)


def _edited(lines: list[str], chance: int) -> None:
    for row, line in enumerate(lines):
        last = 0
        head = before(lines, row)
        for start, end, _ in highlight(head + line):
            assert last <= start < end <= len(head) + len(line), (line, start, end)
            last = end
    row = chance % len(lines)
    word = word_before(lines[row], chance % (len(lines[row]) + 1))
    if word:
        assert all(offer.word and offer.about for offer in offers(word, around(lines, row), {}))


@cache
def _session() -> Session:
    return Session()


def _well_formed(problems: tuple[Diagnostic, ...] | list[Diagnostic], text: str) -> None:
    for problem in problems:
        assert problem.message
        assert problem.code > 0
        assert problem.span is None or 0 <= problem.span.start <= problem.span.end <= len(text) + 1
