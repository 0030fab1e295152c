"""Programs with line numbers are read back as the programs they were."""

from __future__ import annotations

import pytest

from desire_tui.engine.source import Source
from desire_tui.engine.syntax.line_numbers import listing, numbered_lines, with_numbers
from desire_tui.engine.syntax.parse import parse


def statements(text):
    program = parse(Source(text, "p"))
    assert program.problems == ()
    segments = [(s.label, [p.node for p in s.body]) for s in program.segments]
    return [p.node for p in program.script], segments


@pytest.mark.parametrize(
    "text",
    [
        "x = 1\nwrite x\n",
        "x = 1 + _\n  2\n\n-- so\ny = x -\n-- what is taken away\n3 | write y\n",
        "/NEW\nPIC 'p'\n/\nfor i = 1 to 3 -- loop\n  write i\nnext\ndata 1, 2, _\n3, 4\n/\n",
        "drun\nDYNAMIC\nd/dt x = -x +\n  y\nlabel b\ny = 3\n",
        "write 'a' _\n, 'b'",
        "al_\npha = 1 | write 'x _\ny'\n",
        "x = 0\n\n-- 220\nx = x + 1\nif x < 3 then go to 230 | proceed\n",
    ],
)
def test_numbers_change_nothing(text):
    assert statements(with_numbers(text)) == statements(text)


def test_a_numbered_program_keeps_its_numbers():
    text = "210 x = 1\n220 go to 210\n"
    assert with_numbers(text) == text


def test_layout():
    rows = [f"x{i} = {i}" for i in range(10)]
    found = with_numbers("\n".join([*rows, "y = 1 + _", "2", ""])).split("\n")
    assert found[0] == "210 x0 = 0"
    assert found[9:] == ["300 x9 = 9", "310 y = 1 + _", "2", ""]


TEXT = "/NEW\n-- first\nx = 1\n  \ny = al_\npha +\n-- between\n 2\nwrite y\n/\n"


def test_lines_without_numbers_count_from_210():
    found = [(line.number, line.rows.start, line.rows.stop) for line in numbered_lines(TEXT)]
    assert found == [(210, 1, 2), (220, 2, 3), (230, 4, 8), (240, 8, 9)]
    assert [line.number for line in numbered_lines("20 x = 1\n-- why\n10 -- y\n")] == [20, 10]


@pytest.mark.parametrize(
    ("ranges", "shown"),
    [
        ("220", "220 x = 1\n"), ("200-220, 240", "210 -- first\n220 x = 1\n240 write y\n"),
        ("230", "230 y = al_\npha +\n-- between\n 2\n"), ("250-900", ""), ("240-210", ""),
    ],
)  # fmt: skip
def test_listing(ranges, shown):
    assert listing(TEXT, ranges) == shown
    assert listing("20 x = 1\n30 y = 2\n", "30") == "30 y = 2\n"
