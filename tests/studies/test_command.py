"""`desire study` as users type it."""

from __future__ import annotations

import csv
import shutil

import pytest
from click.testing import CliRunner

from desire_tui.cli import main

SPRING = """k = 3 | r = 0.1 | DT = 0.01 | TMAX = 1 | NN = 11 | x = 1 | v = 0
drun
DYNAMIC
d/dt x = v
d/dt v = -k*x - r*v
dispt x
"""


@pytest.fixture
def study(tmp_path):
    (tmp_path / "spring.src").write_text(SPRING)

    def run(*words):
        return CliRunner().invoke(
            main, ["study", str(tmp_path / "spring.src"), *words], catch_exceptions=False
        )

    return run


def test_files_of_each_kind(study, tmp_path):
    import xarray as xr

    words = [
        "--over",
        "k=1:3:3",
        "--over",
        "r=0.1,0.2",
        "--keep",
        "x[end], max(v/2)",
        "--keep",
        "y=x@0:1:0.5",
    ]
    for name in ("s.csv", "s.nc", "s.zarr"):
        result = study(*words, "-o", str(tmp_path / name))
        assert result.exit_code == 0, result.output
        assert "6 runs (3 k × 2 r), 0 failed" in result.output
    rows = list(csv.DictReader((tmp_path / "s.csv").open()))
    assert list(rows[0]) == ["run", "k", "r", "x[end]", "max(v/2)", "y@0", "y@0.5", "y@1", "error"]
    stored = xr.open_zarr(tmp_path / "s.zarr", consolidated=False)
    with xr.open_dataset(tmp_path / "s.nc") as found:
        for number, row in enumerate(rows):
            place = {"k": number // 2, "r": number % 2}
            for dataset in (found, stored):
                here = dataset.isel(place)
                assert float(row["x[end]"]) == here["x[end]"] == here["y"].values[-1]
                assert float(row["max(v/2)"]) == here["max(v÷2)"]
                assert float(row["y@0.5"]) == here["y"].values[1]
    again = study(*words, "-o", str(tmp_path / "s.zarr"), "--resume")
    assert again.exit_code == 0


def test_the_summary(study):
    result = study("--sample", "k=uniform(1,2)", "--runs", "50", "--seed", "7", "--keep", "x@0, t[x<-5]")
    assert "50 runs (50 run), 0 failed; made in lock step" in result.output
    assert [line.split() for line in result.output.splitlines()[1:]] == [
        ["runs", "min", "mean", "max"], ["x@0", "50", "1", "1", "1"], ["t[x<-5]", "0", "–", "–", "–"],
    ]  # fmt: skip
    assert study("--keep", "x[end]", "--quiet").output == ""


@pytest.mark.parametrize(("name", "size"), [("F.zarr", "2 MB"), ("F.nc", "2 MB"), ("F.csv", "12.8 MB")])
def test_a_study_too_large_for_the_disk_is_refused_before_its_first_run(
    study, tmp_path, monkeypatch, name, size
):
    free = shutil.disk_usage(tmp_path)._replace(free=2_000_000)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: free)
    options = ["--over", "k=1:2:1000", "--over", "r=0:1:200", "--keep", "x[end]", "-o", str(tmp_path / name)]
    ended = study(*options)
    assert ended.exit_code == 1
    assert (
        f"200000 runs of 1 number each take {size}; the disk of {tmp_path / name} has 2 MB left"
        in ended.output
    )
    assert not (tmp_path / name).exists()


def test_what_scripts_ask_for(study, tmp_path):
    (tmp_path / "spring.src").write_text(SPRING.replace("drun", "input k\ndrun"))
    (tmp_path / "answers.txt").write_text("0\n")
    result = study(
        "--over", "x=1,2", "--keep", "v[end]", "--input", str(tmp_path / "answers.txt"), "--set", "r=0"
    )
    assert "v[end]" in result.output
    assert result.output.split()[-3:] == ["0", "0", "0"], "no spring, no motion"


@pytest.mark.parametrize(
    ("words", "message", "status"),
    [
        (["--over", "q=1,2", "--keep", "x[end]"], "the program has no 'q'", 1),
        (["--over", "k=1:2", "--keep", "x[end]"], "--over:1:3: error 510", 1),
        (["--over", "k=1,2", "--keep", "max(y)"], "--keep:1:5: error 200", 1),
        (["--over", "k=1,2"], "Missing option '--keep'", 2),
        (["--keep", "x[end]", "-o", "s.txt"], "end its name with .nc, .csv or .zarr", 1),
        (["--keep", "x[end]", "-o", "/no/such/s.csv"], "there is no such folder", 1),
        (["--keep", "x[end]", "--resume"], "--resume needs a folder", 1),
        (["--points", "/no/such.csv", "--keep", "x[end]"], "there is no file", 1),
        (["--over", "k=-1e300,-2e300", "--keep", "x[end]"], "2 runs: error", 1),
    ],
)
def test_mistakes(study, words, message, status):
    result = study(*words)
    assert message in result.output
    assert result.exit_code == status
    assert "Traceback" not in result.output
