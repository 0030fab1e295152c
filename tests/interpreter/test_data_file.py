"""Files of measurements: what is read, and that every problem has its row and column."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.data_files.data_file import read_data_file, read_program_data
from desire_tui.engine.diagnostics import DesireError


@pytest.fixture
def file(tmp_path):
    def made(text, name="measured.csv", encoding="utf-8"):
        path = tmp_path / name
        path.write_bytes(text.encode(encoding))
        return path

    return made


def problems(path):
    with pytest.raises(DesireError) as error:
        read_data_file(path)
    return [
        (d.key, d.source.position(d.span.start).row, d.source.position(d.span.start).column, d.message)
        for d in error.value.diagnostics
    ]


@pytest.mark.parametrize(
    "text",
    [
        "t,x,y\n0,1.5,-2\n1,,3e2\n",
        "# made by hand\n\nt;x;y\n0;1,5;-2\n# a pause\n1;;3e2\n",
        "t\tx\ty\r\n0\t1,5\t-2\r\n1\tNA\t300\r\n",
        "t x y\n0 1.5 -2\n1 - 300\n",
        "t,x,y,\n0,1.5,-2,\n1,nan,300,\n",
        "t;x;y\n(s);[m];m/s\n0;1.5;-2\n1;?;300\n",
    ],
)
def test_forms(file, text):
    found = read_data_file(file(text))
    assert list(found.columns)[:3] == ["t", "x", "y"]
    assert found.columns["t"].tolist() == [0.0, 1.0]
    assert found.columns["x"][0] == 1.5
    assert np.isnan(found.columns["x"][1])
    assert found.columns["y"].tolist() == [-2.0, 300.0]


def test_units_and_settings(file):
    found = read_data_file(file("# k = 2.5\n#x0=-1e3\n# note: k = 2 or so\nTime (s);Temp. [°C]\n0;20,5\n"))
    assert list(found.columns) == ["Time", "Temp"]
    assert found.time == "Time"
    assert found.settings == {"k": 2.5, "x0": -1000.0}
    assert "units are not converted" in found.notes[0]
    assert found.find("temp") == "Temp"
    assert found.find("pressure") is None
    assert found.near("Tmep") == "Temp"


def test_the_time_is_the_first_column_where_none_is_called_so(file):
    assert read_data_file(file("day,n\n0,1\n")).time == "day"
    assert read_data_file(file("n,t\n0,1\n")).time == "t"


def test_other_encodings(file):
    assert list(read_data_file(file("t;Höhe\n0;1,5\n", encoding="latin-1")).columns) == ["t", "Höhe"]


def test_everything_that_is_wrong_at_once(file):
    found = problems(file("t,x\n0,1\n1,one\n2\n3,4,5\nfour,6\n"))
    assert [(key, row, column) for key, row, column, _ in found] == [
        ("data-cell", 3, 3), ("data-ragged", 4, 1), ("data-ragged", 5, 1), ("data-cell", 6, 1),
    ]  # fmt: skip
    assert found[0][3] == "'one' in column x of measured.csv is no number"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "there are no measurements in measured.csv: it is empty"),
        ("# only a comment\n", "there are no measurements in measured.csv: it is empty"),
        ("0,1\n1,2\n", "there are no measurements in measured.csv: its first line holds no names of columns"),
        ("t,x\n", "there are no measurements in measured.csv: no numbers stand below the names"),
        ("t,x,x\n0,1,2\n", "there are no measurements in measured.csv: two columns are called x"),
    ],
)
def test_files_without_measurements(file, text, message):
    assert [problem[3] for problem in problems(file(text))] == [message]


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(DesireError, match="38"):
        read_data_file(tmp_path / "nothing.csv")


def test_excel(tmp_path):
    import pandas as pd

    path = tmp_path / "measured.xlsx"
    pd.DataFrame({"t": [0, 1], "x (m)": [1.5, None]}).to_excel(path, index=False)
    found = read_data_file(path)
    assert found.columns["t"].tolist() == [0.0, 1.0]
    assert found.columns["x"][0] == 1.5
    pd.DataFrame({"t": [0, 1], "x": [1.5, "much"]}).to_excel(path, index=False)
    assert [problem[0:3] for problem in problems(path)] == [("data-cell", 3, 3)]


def test_excel_without_its_library(tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(DesireError) as error:
        read_data_file(tmp_path / "measured.xlsx")
    assert error.value.diagnostics[0].message == "measured.xlsx needs the library pandas"


def test_a_note_speaks_of_units_only_where_there_are_some(file):
    assert read_data_file(file("t;blood glucose\n0;1\n")).notes == (
        "measured.csv: blood glucose is blood_glucose",
    )
    assert read_data_file(file("t;x\n0;1\n")).notes == ()


def test_files_that_a_program_names(file, tmp_path):
    path = file("t;x\n0;1,5\n")
    assert read_program_data(path).columns["x"].tolist() == [1.5]
    (tmp_path / "link.csv").symlink_to(path)
    for name, key in (
        ("nothing.csv", "measurements-missing"), ("link.csv", "cannot-read"), (".", "cannot-read"),
    ):  # fmt: skip
        with pytest.raises(DesireError) as error:
            read_program_data(tmp_path / name)
        assert [d.key for d in error.value.diagnostics] == [key]


def test_an_excel_file_that_a_program_names(tmp_path):
    import pandas as pd

    path = tmp_path / "measured.xlsx"
    pd.DataFrame({"t": [0.0, 1.0], "x": [1.5, 2.5]}).to_excel(path, index=False)
    assert read_program_data(path).columns["x"].tolist() == [1.5, 2.5]
