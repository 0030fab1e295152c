"""CSV files as other programs read them."""

from __future__ import annotations

import csv
import json
from io import StringIO

import numpy as np
import pytest

import desire_tui
from desire_tui.engine.outputs import csv_file
from desire_tui.engine.outputs.csv_file import write_csv

# The names hold commas; the second run records others than the first
MATRIX = """ARRAY A[1,2], v[2]
NN = 5 | TMAX = 1 | DT = 0.01
drun
drun second
DYNAMIC
A[1,2] = sin(7*t) / 3
Vector v = A[1,2] * v + t
dispt A[1,2], v[2]
label second
y = exp(-t)
dispt y, A[1,2]
"""


@pytest.fixture(scope="module")
def runs():
    result = desire_tui.run(MATRIX)
    assert not result.problems, result.problems
    return result.runs


def text_of(runs, **options):
    file = StringIO()
    write_csv(runs, file, **options)
    return file.getvalue()


def test_a_name_with_a_comma_is_one_column(runs):
    assert text_of(runs).split("\n")[0] == 'run,t,"A[1,2]",v[2],y,segment'
    assert text_of(runs[:1], numbered=False).split("\n")[0] == 't,"A[1,2]",v[2]'
    assert text_of(runs[:1], numbered=False, delimiter="\t").split("\n")[0] == "t\tA[1,2]\tv[2]"


def test_read_back_by_the_csv_module_every_bit_is_there(runs):
    head, *rows = csv.reader(StringIO(text_of(runs), newline=""))
    assert head == ["run", "t", "A[1,2]", "v[2]", "y", "segment"]
    assert len(rows) == 10
    for number, run in enumerate(runs, 1):
        own = [row for row in rows if row[0] == str(number)]
        assert [float(row[1]) for row in own] == run.t.tolist()
        recorded = {curve.name: curve.values.tolist() for curve in run.curves}
        for place, name in enumerate(head[2:], 2):
            column = [row[place] for row in own]
            if name == "segment":
                assert column == [run.segment or ""] * 5
            elif name in recorded:
                assert [float(cell) for cell in column] == recorded[name]
            else:
                assert column == [""] * 5


@pytest.mark.parametrize("delimiter", [",", "\t"])
def test_read_back_by_numpy_every_bit_is_there(runs, delimiter):
    text = text_of(runs[1:], numbered=False, delimiter=delimiter)
    table = np.loadtxt(StringIO(text), delimiter=delimiter, skiprows=1, quotechar='"')
    expected = np.column_stack([runs[1].t, *(curve.values for curve in runs[1].curves)])
    assert np.array_equal(table, expected)


def test_a_missing_cell_is_a_number_that_is_not_there(runs):
    table = np.genfromtxt(StringIO(text_of(runs)), delimiter=",", skip_header=1)
    assert np.isnan(table[:5, 4]).all()
    assert not np.isnan(table[5:, 4]).any()


def test_a_long_run_is_written_piece_by_piece(runs, monkeypatch):
    whole = text_of(runs)
    monkeypatch.setattr(csv_file, "_ROWS", 2)
    assert text_of(runs) == whole


def test_numbers_are_as_in_json(runs):
    odd = desire_tui.run(
        "NN = 3 | TMAX = 1 | t = 0 | drun\nDYNAMIC\ny = 1E300*t\nz = -t*0\ndispt y, z\n"
    ).runs
    cells = [row.split(",")[2:] for row in text_of(odd).splitlines()[1:]]
    assert [[json.loads(cell) for cell in row] for row in cells] == [
        [0.0, -0.0],
        [5e299, -0.0],
        [1e300, -0.0],
    ]
    assert cells[2] == ["1e+300", "-0.0"]
