"""Programs with line numbers are read back as the programs they were."""

from __future__ import annotations

import pytest

from desire_tui.engine.source import Source
from desire_tui.engine.syntax.line_numbers import with_numbers
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
    assert found[0] == " 10 x0 = 0"
    assert found[9:] == ["100 x9 = 9", "110 y = 1 + _", "    2", ""]
