"""After an edit only one piece is written anew; what is kept is what would be written."""

from __future__ import annotations

from unittest.mock import patch

import pytest

from desire_tui.engine.codegen.pieces import kept_pieces
from desire_tui.engine.codegen.pieces.pass_pieces import cut, write
from desire_tui.engine.lowered.expressions import Const, Load, Op
from desire_tui.engine.lowered.statements import Deriv, Set, Where
from desire_tui.engine.source import Span
from tests.lowering.programs import segment

PLACE = Where(Span(0, 1))


@pytest.fixture(autouse=True)
def nothing_kept():
    kept_pieces.forget()


def pieces_of(lines):
    lowered, _ = segment("\n".join(lines), a=1)
    return [kept_pieces.piece_of(group) for group in cut(lowered.body)]


def test_an_edit_writes_one_piece():
    lines = [f"d/dt x{k} = a*sin(x{(7 * k) % 200}) - x{k}" for k in range(200)]
    before = pieces_of(lines)
    lines[100] = "d/dt x100 = a"
    with patch.object(kept_pieces, "write", wraps=write) as written:
        after = pieces_of(lines)
    assert len(before) == len(after) == 4
    assert written.call_count == 1
    assert [one is other for one, other in zip(before, after, strict=True)] == [True, False, True, True]
    kept_pieces.forget()
    assert pieces_of(lines) == after


def test_what_a_statement_sets_makes_a_piece():
    value = Op("add", (Load(20), Const(2.0)))
    groups = [
        [Deriv(3, value, PLACE)],
        [Set(3, value, PLACE)],
        [Deriv(4, value, PLACE)],
        [Set(4, value, PLACE)],
    ]
    assert [kept_pieces.piece_of(group) for group in groups] == [write(group) for group in groups]
    assert len({kept_pieces.piece_of(group).text for group in groups}) == 4


def test_other_statements_are_always_written():
    lowered, _ = segment("if x\nu = x\nend if\nd/dt x = u", u=1)
    with patch.object(kept_pieces, "write", wraps=write) as written:
        kept_pieces.piece_of(lowered.body)
        kept_pieces.piece_of(lowered.body)
    assert written.call_count == 2
