"""Results in a folder: filled as they come, gone on with, refused to another study."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import desire_tui
from desire_tui import DesireError

DECAY = "k = 1 | a = 2 | DT = 0.05 | TMAX = 1 | NN = 11 | x = 1\ndrun\nDYNAMIC\nd/dt x = -k*x^a\ndispt x\n"
SETTINGS = {
    "over": {"k": "0:3:40"}, "sample": {"x": "uniform(-2, 1)"}, "runs": 30, "keep": "x[end], y=x@0:1:0.25, max(x/2)",
}  # fmt: skip


@pytest.fixture(scope="module")
def whole():
    return desire_tui.study(DECAY, **SETTINGS, set={"a": 3})


def same(found, whole):
    return all(
        np.array_equal(found[name.replace("/", "÷")].values, whole[name].values, equal_nan=True)
        for name in (*whole.data_vars, *whole.coords)
    )


def test_a_folder_holds_what_memory_would(whole, tmp_path):
    found = desire_tui.study(DECAY, **SETTINGS, set={"a": 3}, store=tmp_path / "s.zarr")
    assert same(found, whole)
    assert found["x"].dims == ("run",)
    assert "x" in found.coords
    assert found.attrs["failed"] == whole.attrs["failed"]


def test_a_study_that_was_ended_goes_on(whole, tmp_path):
    path = tmp_path / "s.zarr"
    part = desire_tui.study(DECAY, **SETTINGS, set={"a": 3}, store=path, threads=1, progress=lambda _: False)
    missing = int((part["error"] == -2).sum())
    assert 0 < missing < 1200
    made = []
    found = desire_tui.study(DECAY, **SETTINGS, set={"a": 3}, store=path, resume=True, progress=made.append)
    assert same(found, whole)
    assert made[-1].made == 1200
    assert found.attrs["failures"] == whole.attrs["failures"]
    made.clear()
    desire_tui.study(DECAY, **SETTINGS, set={"a": 3}, store=path, resume=True, progress=made.append)
    assert not made, "nothing is missing"


def test_another_study_does_not_go_on_with_a_store(tmp_path):
    path = tmp_path / "s.zarr"
    settings = {"over": {"k": [1, 2]}, "keep": "x[end]", "store": path}
    desire_tui.study(DECAY, **settings)
    with pytest.raises(DesireError, match=r"s\.zarr is there already"):
        desire_tui.study(DECAY, **settings)
    for program, other, message in (
        (DECAY.replace("x^a", "x"), {}, "its program's text is another"),
        (DECAY, {"over": {"k": [1, 3]}}, r"its list of k is \[1.0, 2.0\], not \[1.0, 3.0\]"),
        (DECAY, {"keep": "max(x)"}, r'its keep is "x\[end\]", not "max\(x\)"'),
        (DECAY, {"seed": 3}, "its seed"),
        (DECAY, {"set": {"a": 1}}, r'its fixed is {}, not {"a": 1.0}'),
    ):
        with pytest.raises(DesireError, match="holds another study: " + message):
            desire_tui.study(program, **settings | other, resume=True)
    (tmp_path / "other.zarr").mkdir()
    with pytest.raises(DesireError, match="it is no study that can be gone on with"):
        desire_tui.study(DECAY, **settings | {"store": tmp_path / "other.zarr"}, resume=True)


KILLED = """
import sys, desire_tui
from tests.studies.test_stores import DECAY, SETTINGS
def told(progress):
    print(progress.made, flush=True)
    sys.stdin.read()
desire_tui.study(DECAY, **SETTINGS, set={"a": 3}, store=sys.argv[1], threads=1, progress=told)
"""


def test_a_process_that_is_killed_loses_nothing_that_was_made(whole, tmp_path):
    """The machine may go down at any moment: what is in the folder stays, the rest is made later."""
    path = tmp_path / "s.zarr"
    process = subprocess.Popen(
        [sys.executable, "-c", KILLED, str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    made = int(process.stdout.readline())
    process.kill()
    process.communicate()
    told = []
    found = desire_tui.study(DECAY, **SETTINGS, set={"a": 3}, store=path, resume=True, progress=told.append)
    assert same(found, whole)
    assert made < told[0].made <= told[-1].made == 1200
