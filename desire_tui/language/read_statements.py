"""The statements of a program, each with its tokens: nodes alone do not know where all their names stand."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.syntax.logical_lines import logical_lines
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.syntax.tokens import mark_logical_words, scan

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.source import Source
    from desire_tui.engine.syntax.statement_tokens import StatementTokens

ROOM = 2_000_000
"""Characters of lines whose tokens are kept."""
LINE_COST = 100
"""What a line adds to that beside its characters."""

_tokens: RecentlyUsed[str, tuple[StatementTokens, ...]] = RecentlyUsed(
    ROOM, cost=lambda line: len(line) + LINE_COST
)


class ReadStatement(NamedTuple):
    """A statement, its tokens, and the offset in the text from which both count."""

    node: Statement
    tokens: StatementTokens
    at: int


def read_program(source: Source) -> tuple[Program, tuple[ReadStatement, ...]]:
    """Return a program and its statements in the order of the text, those that cannot be read as `Faulty`.

    The words `DYNAMIC`, `JACOBIAN` and `STOP` that divide it are none of them; nor is what is not part of the
    program, such as commentary behind a last `STOP`.
    """
    program = parse(source)
    _tokens.age()
    return program, tuple(_with_tokens(source, _by_offset(program)))


def _by_offset(program: Program) -> dict[int, Statement]:
    placed: list[Placed] = [*program.script]
    for segment in program.segments:
        placed += [*segment.body, *segment.jacobian]
    return {one.at: one.node for one in placed}


def _with_tokens(source: Source, nodes: dict[int, Statement]) -> Iterator[ReadStatement]:
    from desire_tui.engine.nodes.control import Label

    text, starts = source.text, [*source.line_starts, len(source.text) + 1]
    for _, at, _, rows in logical_lines(text):
        for tokens in _tokens_of(text[at : starts[rows.stop] - 1]):
            place = at + tokens.base
            node = nodes.get(place)
            if node is None and tokens.kinds[:1] == ["label"] and len(tokens.texts) > 1:
                node = Label(tokens.texts[1], 0, tokens.ends[-1])  # begins a segment: no statement of one
            if node is not None:
                yield ReadStatement(node, tokens, place)


def _tokens_of(line: str) -> tuple[StatementTokens, ...]:
    known = _tokens[line]
    if known is None:
        known = tuple(scan(line).chunks)
        for tokens in known:
            mark_logical_words(tokens)
        _tokens.keep(line, known)
    return known
