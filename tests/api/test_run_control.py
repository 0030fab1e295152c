"""Runs from several threads, in blocks, with a limit of time; what a run and a result show of themselves."""

from __future__ import annotations

import threading

import numpy as np
import pytest

import desire_tui

LONG = "irule 3 | x = 1 | k = 1 | DT = 0.001 | TMAX = 20 | NN = 201\ndrun\nDYNAMIC\nd/dt x = -k*x\ndispt x\n"
ENDLESS = LONG.replace("TMAX = 20", "TMAX = 1E9")


@pytest.fixture(scope="module")
def long_run():
    return desire_tui.load(LONG)


def test_threads_get_what_one_thread_gets(long_run):
    alone = [long_run.run(k=k)["x"] for k in range(6)]
    found = [[], [], []]
    threads = [
        threading.Thread(target=lambda out=out: out.extend(long_run.run(k=k)["x"] for k in range(6)))
        for out in found
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(own, alone) for own in found)


def test_blocks_are_the_samples_and_false_ends_the_run(long_run):
    blocks = []
    run = long_run.run(on_block=lambda block: blocks.append(block["x"]))
    assert np.array_equal(np.concatenate(blocks), run["x"])
    ended = desire_tui.load(ENDLESS).run(on_block=lambda _: False)
    assert ended.ended == "stopped"


def test_a_time_limit_ends_a_run_and_says_so():
    run = desire_tui.load(ENDLESS).run(timeout=0.05)
    assert (run.ended, run.error.diagnostics[0].key) == ("stopped", "time-limit")


def test_runs_become_tables_axes_and_pictures(long_run):
    run = long_run.run(k=2)
    table = run.to_dataframe()
    assert np.array_equal(table["x"], run["x"])
    assert np.array_equal(table.index, run.t)
    assert run.to_xarray()["x"].attrs == {}
    assert run.to_xarray().attrs["k"] == 2
    (line,) = run.plot().get_lines()
    assert np.array_equal(line.get_ydata(), run["x"])
    plane = desire_tui.load(LONG.replace("dispt x", "y = 2*x\ndispxy x, y")).run()
    (line,) = plane.plot().get_lines()
    assert np.array_equal(line.get_xdata(), plane["x"])
    assert np.array_equal(line.get_ydata(), plane["y"])
    assert run._repr_png_().startswith(b"\x89PNG")
    assert "<img" in run._repr_html_()
