"""`data 'file'`: the columns of a file are known while a program is checked, where the file can be looked at."""

from __future__ import annotations

import os

import pytest

from desire_tui.engine.check.checker import check
from desire_tui.engine.data_files.table_names import tables_beside
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse

SEGMENT = "TMAX = 1 | drun\nDYNAMIC\nd/dt x = func1(t; position)\ndispt x\n"
FILE = "# made by hand\nt [s];position (m);Höhe\n0;1;2\n"


@pytest.fixture
def messages(tmp_path):
    def found(text):
        source = Source(text, "t.src", tmp_path / "t.src")
        return [(problem.code, problem.line, problem.facts.get("name")) for problem in check(parse(source))]

    return found


def test_columns_are_arrays(messages, tmp_path):
    (tmp_path / "m.csv").write_text(FILE)
    assert messages(f"data 'm.csv'\nwrite position, Hohe[1], func1(1; Hohe)\n{SEGMENT}") == []
    assert messages("data 'm.csv'\na = func1(1; positoin)\nwrite a, velocity[2]\n") == [
        (200, 2, "positoin"),
        (19, 3, "velocity"),
    ]
    assert messages("data 'm.csv'\nTMAX = 1 | drun\nDYNAMIC\nd/dt x = func1(t; speed)\n") == [
        (19, 4, "speed")
    ]


def test_nothing_is_said_of_a_file_that_cannot_be_looked_at(messages, tmp_path):
    everything = f"write position, Hohe[1], func1(1; Hohe)\n{SEGMENT}"
    (tmp_path / "numbers.csv").write_text("0;1\n1;2\n")
    (tmp_path / "book.xlsx").write_bytes(b"PK\0\0")
    (tmp_path / ".hidden.csv").write_text("t,secret\n0,1\n")
    (tmp_path / "outside.csv").symlink_to("/etc/hostname")
    (tmp_path / "binary.csv").write_bytes(bytes(100))
    for name in (
        "nothing.csv",
        "numbers.csv",
        "book.xlsx",
        "binary.csv",
        "../m.csv",
        ".hidden.csv",
        "outside.csv",
        "",
        ".",
        "\0",
    ):
        assert messages(f"data '{name}'\n{everything}") == [], name
    assert messages(f"data 'nothing.csv'\n{everything}".replace("Hohe[1]", "typo + 1")) == [(200, 2, "typo")]
    assert len(messages(everything)) == 3


def test_a_column_called_like_a_quantity_of_the_segment(messages, tmp_path):
    (tmp_path / "m.csv").write_text("t,x,position\n0,1,2\n")
    assert messages(f"data 'm.csv'\n{SEGMENT}") == [(73, 1, "x")]


def test_a_file_that_changed_is_looked_at_again(tmp_path):
    source = Source("data 'm.csv'", "t.src", tmp_path / "t.src")
    path = tmp_path / "m.csv"
    for names in ("a", "b", "bb"):
        path.write_text(f"t,{names}\n0,1\n")
        os.utime(path, ns=(0, ord(names[0])))
        assert tables_beside(source, "m.csv") == {names: names}


def test_what_columns_are_called(tmp_path):
    source = Source("", "t.src", tmp_path / "t.src")
    (tmp_path / "m.csv").write_text("Time (s);blood glucose;Größe;end;sin;DT;µ;x.y\n")
    assert tables_beside(source, "m.csv") == {
        "blood_glucose": "blood_glucose",
        "Größe": "Grosse",
        "end": "end_data",
        "sin": "sin_data",
        "DT": "DT_data",
        "µ": "column",
        "x_y": "x_y",
    }
