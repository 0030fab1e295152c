"""Parquet and NetCDF, read back by the libraries that users read them with."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest

import desire_tui
from desire_tui.engine.outputs.formats import DATA

FORMATS = {known.name: known for known in DATA}

TWO_RUNS = """
NN = 5 | TMAX = 1 | DT = 0.01 | k = 1 | x = 2
drun
t = 0 | k = 3 | x = 4 | plot 1, 2, 3
drun
DYNAMIC
d/dt x = -k*x
dispt x
"""
TWO_SEGMENTS = """
NN = 3 | TMAX = 1 | drun
TMAX = 2 | drun b
DYNAMIC
y = 2*t
dispt y
label b
z = 3*t
dispt z
"""


def written(name: str, text: str, *, points: bool = False) -> tuple[desire_tui.Result, BytesIO]:
    """Return the result of a program and what is written of it."""
    result, file, known = desire_tui.run(text), BytesIO(), FORMATS[name]
    write = known.write_points if points else known.write
    assert write is not None
    write(result, file)
    return result, BytesIO(file.getvalue())


@pytest.fixture
def table_of():
    """Return what reads a Parquet file; imported here, so that only the process that needs it does."""
    from pyarrow import parquet

    return parquet.read_table


@pytest.fixture
def opened():
    """Return what opens a NetCDF file."""
    from scipy.io import netcdf_file

    return lambda file: netcdf_file(file, mmap=False)


def test_parquet_has_the_table_of_csv_with_types(table_of):
    result, file = written("parquet", TWO_RUNS)
    table = table_of(file)
    assert table.column_names[:3] == ["run", "t", "x"]
    assert table["run"].to_pylist() == [1] * 5 + [2] * 5
    assert np.array_equal(table["x"], np.concatenate([run["x"] for run in result.runs]))
    assert table["k"].to_pylist() == [1.0] * 5 + [3.0] * 5
    assert b'"rule"' in table.schema.metadata[b"desire"]


def test_parquet_says_null_where_a_run_has_no_value(table_of):
    _, file = written("parquet", TWO_SEGMENTS)
    table = table_of(file)
    assert table["z"].to_pylist()[:3] == [None] * 3
    assert table["y"].to_pylist()[3:] == [None] * 3
    assert table["segment"].to_pylist() == [None] * 3 + ["b"] * 3


def test_points_of_plot_are_a_table_of_their_own(table_of):
    _, file = written("parquet", TWO_RUNS, points=True)
    assert table_of(file).to_pylist() == [{"x": 1.0, "y": 2.0, "color": 3}]


def test_netcdf_has_runs_over_one_t(opened):
    result, file = written("netcdf", TWO_RUNS)
    with opened(file) as data:
        assert data.variables["x"].dimensions == ("run", "t")
        for number, run in enumerate(result.runs):
            assert np.array_equal(data.variables["x"][number], run["x"])
        assert np.array_equal(data.variables["t"][:], result.runs[0].t)
        assert data.variables["k"][:].tolist() == [1.0, 3.0]
        assert data.variables["x(0)"][:].tolist() == [2.0, 4.0]
        assert data.variables["plot_y"][:].tolist() == [2.0]


def test_netcdf_pads_runs_whose_times_differ(opened):
    _, file = written("netcdf", TWO_SEGMENTS)
    with opened(file) as data:
        assert data.variables["t"].dimensions == ("run", "sample")
        assert np.isnan(data.variables["z"][0]).all()
        assert data.variables["z"][1].tolist() == [3.0 * t for t in data.variables["t"][1]]
        assert b"".join(data.variables["segment"][1]).rstrip(b"\0") == b"b"


@pytest.mark.parametrize("name", ["parquet", "netcdf"])
def test_a_program_without_runs_can_be_written(name):
    _, file = written(name, "x = 1\n")
    assert file.getvalue()
