"""Analyses from the shell and from Python: files, words, exit status; nothing of it is left to one of them."""

from __future__ import annotations

import json
import os
import signal

import pytest
from click.testing import CliRunner

import desire_tui
from desire_tui.__main__ import COMMANDS
from desire_tui.analysis import libraries
from desire_tui.analysis.command import _Watch
from desire_tui.analysis.registry import ANALYSES
from desire_tui.analysis.result import Result, Table
from desire_tui.cli import main
from desire_tui.engine.diagnostics import DesireError
from desire_tui.help.page_catalogue import find

TONE = """w = 3 | TMAX = 100 | DT = 0.01 | NN = 1001
drun
DYNAMIC
y = sin(w*t)
dispt y
"""


def desire(*words):
    return CliRunner().invoke(main, list(words), catch_exceptions=False)


@pytest.fixture
def tone(tmp_path):
    path = tmp_path / "tone.src"
    path.write_text(TONE)
    return str(path)


@pytest.mark.parametrize("analysis", ANALYSES, ids=lambda one: one.name)
def test_each_has_a_command_a_page_and_a_function(analysis):
    assert analysis.name in COMMANDS
    assert analysis.name in main.commands
    page = find(analysis.name)
    assert page is not None
    assert f"analysis.{analysis.name}" in page.actions
    assert callable(getattr(desire_tui, analysis.name))


def test_files_of_each_kind(tone, tmp_path):
    outputs = [str(tmp_path / name) for name in ("peaks.csv", "all.json", "chart.png", "chart.svg")]
    words = [word for output in outputs for word in ("-o", output)]
    shown = desire("spectrum", tone, "y", "window", "500", *words, "--set", "w=5")
    assert shown.exit_code == 0, shown.output
    assert shown.output.startswith("Spectrum of y, tone.src\npeaks of y\n")
    header, line = (tmp_path / "peaks.csv").read_text().splitlines()
    assert header == "frequency,period,amplitude"
    assert float(line.split(",")[1]) == pytest.approx(2 * 3.14159265 / 5, rel=1e-2)
    found = json.loads((tmp_path / "all.json").read_text())
    assert found["program"] == "tone.src"
    assert found["tables"]["peaks of y"]["amplitude"] == pytest.approx([1.0], rel=0.05)
    assert (tmp_path / "chart.png").read_bytes().startswith(b"\x89PNG")
    assert "Spectrum of y" in (tmp_path / "chart.svg").read_text()


def test_a_request_is_underlined_where_it_is_wrong(tone):
    shown = desire("spectrum", tone, "y", "widow", "8")
    assert shown.exit_code == 1
    assert "<request>:1:3: error 520: 'widow' stands where 'window' or 'from' is expected" in shown.stderr
    assert "    y widow 8\n      ^^^^^" in shown.stderr


def test_an_ending_without_a_meaning_is_said_before_the_run(tone):
    shown = desire("spectrum", tone, "y", "-o", "x.doc")
    assert shown.exit_code == 1
    assert "x.doc is no file for results" in shown.stderr


def test_from_python(tone):
    found = desire_tui.spectrum(tone, "y", set={"w": 5.0})
    assert found.tables[0].columns["frequency"] == pytest.approx([5 / 6.28318531], rel=1e-2)
    assert str(found).startswith("Spectrum of y")
    with pytest.raises(ValueError, match="did you mean 'spectrum'"):
        desire_tui.analyse("spektrum", tone, "y")
    with pytest.raises(TypeError, match="sett"):
        desire_tui.spectrum(tone, "y", sett={})


def test_ctrl_c_asks_to_end_and_then_ends():
    with _Watch(None) as watch:
        assert watch(None, "begins")
        os.kill(os.getpid(), signal.SIGINT)
        assert not watch(0.5, "half")
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)


def test_a_library_that_is_missing_is_named():
    with pytest.raises(DesireError) as error:
        libraries.needed("no_such_library.part", "a spectrum")
    (problem,) = error.value.diagnostics
    assert problem.message == "a spectrum needs the library no_such_library"


def test_long_tables_show_their_ends():
    shown = Result("x", tables=[Table("", {"k": list(range(100)), "v": ["a"] * 100})]).lines()
    assert "… 60 more" in shown
    assert shown[-1].split() == ["99", "a"]


def test_a_part_of_an_answer_says_so():
    assert Result("found", is_partial=True).lines() == ["found (stopped: what was found so far)"]
