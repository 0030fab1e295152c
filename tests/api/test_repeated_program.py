"""`desire_tui.run` of one text again and again: from the second time on it is quick, and gives the same."""

from __future__ import annotations

import dataclasses
import threading
from pathlib import Path

import numpy as np
import pytest

import desire_tui
from desire_tui.api import whole_program
from desire_tui.api.repeated_program import repeated_result
from desire_tui.batch.runner import RunOptions
from desire_tui.engine.source import Source

ROOT = Path(__file__).parents[2]
HEAD = "k = 2 | b = 3*k | x = 1 | TMAX = 1 | DT = 0.01 | NN = 11\n"
TAIL = "DYNAMIC\nd/dt x = -k*x\ny = b + x\ndispt x, y\n"


def same(first, second):
    """Compare results but for how long they took."""
    assert (first.status, first.console, first.problems) == (second.status, second.console, second.problems)
    assert len(first.runs) == len(second.runs)
    for one, other in zip(first.runs, second.runs, strict=True):
        for field in dataclasses.fields(one):
            if field.name not in {"seconds", "curves", "t", "state"}:
                assert getattr(one, field.name) == getattr(other, field.name), field.name
        assert list(one) == list(other)
        assert all(np.array_equal(one[name], other[name], equal_nan=True) for name in one)
    assert first.keys() == second.keys()
    assert all(np.array_equal(first[name], second[name], equal_nan=True) for name in first)


def both(text, settings, *, repeats=True):
    """Run a program as a whole and by what was kept of it."""
    source = Source(text, "<text>")
    for _ in range(3):
        kept = repeated_result(source, "native", settings, None)
    assert (kept is not None) == repeats
    if kept is not None:
        same(whole_program._whole(source, {}, RunOptions(settings=settings)), kept)


@pytest.mark.parametrize(
    ("program", "settings"),
    [
        (f"{HEAD}drun\n{TAIL}", {}),
        (f"{HEAD}drun\n{TAIL}", {"k": 7.0}),
        (f"{HEAD}drun\n{TAIL}", {"b": 7.0, "x": -3.0}),
        (f"{HEAD}write 'before'\ndrun\nq = 2*x | write q; k\n{TAIL}", {"k": 0.5}),
        (f"{HEAD}SEED 3 | q = ran()\ndrun\nwrite q\n{TAIL.replace('-k*x', '-k*x + 0*ran()')}", {"k": 0.5}),
        (f"{HEAD}drun\nfirst = x | second = first + ln(x)\n{TAIL}", {"k": 0.5}),
        (f"{HEAD}drun\n{TAIL[:-1]}, z\n".replace("dispt", "z = 1/(x - 1)\ndispt"), {"k": 3.0}),
        (f"{HEAD}drun\n{TAIL}z = ln(x - 0.5)\nd/dt w = z\n", {"k": 3.0}),
        (
            f"ARRAY v[3]\nfor i = 1 to 3 | a = i | next\nv[2] = a | {HEAD}drun\n{TAIL}z = v[2]*x\n",
            {"v[2]": 5.0},
        ),
        (f"irule 15 | ERMAX = 1E-6\n{HEAD}drun\n{TAIL}", {"k": 1e4}),
        (f"{HEAD}DT = 0\ndrun\n{TAIL}", {"k": 1e4}),
    ],
)
def test_a_repeated_program_gives_what_the_whole_one_gives(program, settings):
    both(program, settings)


@pytest.mark.parametrize(
    ("name", "settings"),
    [("ch2/lorenz", {"b": 20.0}), ("ch2/torpedo", {"UC": 0.3}), ("ch4/peak_hold", {"damping": 0.12})],
)
def test_examples(name, settings):
    text = (ROOT / "examples" / f"{name}.src").read_text("utf-8")
    both(text, {})
    both(text, settings)


@pytest.mark.parametrize(
    ("program", "settings"),
    [
        (f"{HEAD}drun\ndrun\n{TAIL}", {}),
        (f"{HEAD}for i = 1 to 2\ndrun\nnext\n{TAIL}", {}),
        (f"{HEAD}drun\nwrite nothing\n{TAIL}", {}),
        (f"{HEAD}NN = 0.5\ndrun\n{TAIL}", {"x": 0.0}),
        (f"{HEAD}began = tim(0)\ndrun\n{TAIL}", {}),
        (f"{HEAD}plot 1, 2\ndrun\n{TAIL}", {}),
        (f"{HEAD}drun\nplot 1, x\n{TAIL}", {}),
        (f"{HEAD}drun\n{TAIL}type x\n", {}),
        (f"{HEAD}drun\nSTOP\n{TAIL}", {}),
        (f"{HEAD}write k\ndrun\n{TAIL}", {"k": 4.0}),
        (f"{HEAD}if k > 3 then | x = 5 | proceed\ndrun\n{TAIL}", {"k": 4.0}),
        (f"{HEAD}drun\n{TAIL}", {"kk": 4.0}),
        (f"{HEAD}drun\n{TAIL}SAMPLE k\nh = x\n", {"k": 4.0}),
        (f"{HEAD}", {}),
        ("x = nope\n", {}),
    ],
)
def test_other_programs_run_as_a_whole_each_time(program, settings):
    both(program, settings, repeats=False)


def test_files_are_read_each_time(tmp_path):
    (tmp_path / "data.csv").write_text("5\n")
    program = tmp_path / "p.src"
    program.write_text("connect 'data.csv' as input 1\ninput #1, k\nTMAX = 1\ndrun\nDYNAMIC\nd/dt x = k\n")
    assert [desire_tui.run(program)["x"] for _ in range(3)] == pytest.approx([5, 5, 5])
    (tmp_path / "data.csv").write_text("7\n")
    assert desire_tui.run(program)["x"] == pytest.approx(7)
    program.write_text("k = 9 | TMAX = 1\ndrun\nDYNAMIC\nd/dt x = k\n")
    assert [desire_tui.run(program)["x"] for _ in range(3)] == pytest.approx([9, 9, 9])
    program.write_text("k = 10 | TMAX = 1\ndrun\nDYNAMIC\nd/dt x = k\n")
    assert desire_tui.run(program)["x"] == pytest.approx(10)


def test_a_time_limit_holds_for_repeated_runs_and_is_over_with_them():
    text = f"{HEAD}drun\n{TAIL}".replace("DT = 0.01", "DT = 0.001 | q = 1")
    for _ in range(2):
        assert desire_tui.run(text, timeout=100).status == "done"
    ended = desire_tui.run(text, set={"TMAX": 1e9}, timeout=0.05)
    assert (ended.status, ended.problems[-1].code, ended.runs[0].ended) == ("limit", 490, "stopped")
    assert desire_tui.run(text).status == "done"


def test_threads_share_a_text_and_not_its_numbers():
    text = f"{HEAD}drun\n{TAIL}"
    alone = [desire_tui.run(text, set={"k": k})["x"] for k in range(8)]
    found = {}

    def work(number):
        found[number] = [desire_tui.run(text, set={"k": k})["x"] for k in range(8)]

    threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [found[number] for number in range(4)] == [alone] * 4
