"""A run that fails before its first sample: every output shows it, none ends in a traceback."""

from __future__ import annotations

import json

import numpy as np
import pytest

import desire_tui
from desire_tui.engine.runtime import stash
from tests.batch.command_line import desire

FAILING = {
    "delay": "TMAX = 1 | DT = 0.01 | NN = 11 | ARRAY D[2]\ndrun\nDYNAMIC\nd/dt x = 1\ntdelay y = D(x, 0.5\ndispt x, y\n",
    "room": "TMAX = 1 | DT = 1E-12 | NN = 1E10\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x\n",
    "table": "ARRAY F[4] | NN = 3 | F[1] = 1\ndrun\nDYNAMIC\ny = func1(t; F)\ndispxy y, t\n",
}
OUTPUTS = ["csv", "json", "npz", "parquet", "netcdf", "png", "svg", "pdf"]


@pytest.mark.parametrize("text", FAILING.values(), ids=FAILING)
def test_in_python(text):
    result = desire_tui.run(text)
    assert result.status == "failed"
    assert [len(run.t) for run in result.runs] == [0]
    assert [run.ended for run in result.runs] == ["failed"]


@pytest.mark.parametrize("text", FAILING.values(), ids=FAILING)
def test_in_every_output(text, tmp_path):
    from scipy.io import netcdf_file

    (tmp_path / "p.src").write_text(text)
    options = [word for kind in OUTPUTS for word in (f"--{kind}", f"o.{kind}")]
    status, _, _ = desire("run", "p.src", "--plot", *options, cwd=tmp_path)
    assert status == 1
    assert all((tmp_path / f"o.{kind}").exists() for kind in OUTPUTS)
    assert json.loads((tmp_path / "o.json").read_text())["status"] == "failed"
    with netcdf_file(tmp_path / "o.netcdf", mmap=False) as data:
        assert np.isnan(data.variables["t"][:]).all()


def test_of_a_name_that_a_line_not_reached_yet_defines_wrongly():
    """The script never came to that line: without the unknown name there would be no reason."""
    result = desire_tui.run("TMAX = 1\ndrun\nARRAY D[50, E[50]\nDYNAMIC\nd/dt x = 1\ndelay y = D(x, 0.5)\n")
    assert result.status == "failed"
    assert result.problems[-1].line == 6


def test_reset_after_a_run_that_never_began():
    text = FAILING["delay"].replace("drun\n", "x = 5 | t = 3\ndrun\n")
    result = desire_tui.run(text)
    assert result["x"] == 5
    assert result["t"] == 3


def header(text):
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode()


def written(tmp_path, array):
    np.save(tmp_path / "array.npy", array, allow_pickle=True)
    return (tmp_path / "array.npy").read_bytes()


CORRUPT = {
    "empty": lambda _: b"",
    "text": lambda _: b"hello\n",
    "zip": lambda _: b"PK\x03\x04" + bytes(40),
    "no dictionary": lambda _: header("(((((\n"),
    "not closed": lambda _: header("{'descr': '''\n"),
    "huge": lambda _: header("{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000, 1), }\n"),
    "negative": lambda _: (
        header("{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 1), }\n") + bytes(16)
    ),
    "of objects": lambda tmp: written(tmp, np.array([[{}]], dtype=object)),
    "of texts": lambda tmp: written(tmp, np.array([["a"]])),
    "cut": lambda tmp: written(tmp, np.ones((11, 1)))[:-20],
    "no samples": lambda tmp: written(tmp, np.ones((0, 1))),
    "one dimension": lambda tmp: written(tmp, np.ones(11)),
}


@pytest.mark.parametrize("make", CORRUPT.values(), ids=CORRUPT)
def test_stash_files_that_are_none(make, tmp_path):
    program = tmp_path / "p.src"
    program.write_text("TMAX = 1 | NN = 11\ndrun\nDYNAMIC\nd/dt y = x\ndispt y\nrecover x\n")
    (tmp_path / "p.stash.npy").write_bytes(make(tmp_path))
    result = desire_tui.run(program)
    assert [p.code for p in result.problems] == [92]


def test_a_stash_file_in_the_order_of_columns(tmp_path):
    stored = np.asfortranarray(np.arange(6.0).reshape(3, 2))
    np.save(tmp_path / "s.npy", stored)
    assert stash._histories(tmp_path / "s.npy").tolist() == stored.tolist()
