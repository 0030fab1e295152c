"""`Model.start`: runs that continue one another, snapshots to go back to."""

from __future__ import annotations

import numpy as np
import pytest

import desire_tui

HEAD = "irule 3 | k = 1 | b = 2*k | x = 1 | TMAX = 1 | DT = 0.01 | NN = 11\n"
NOISY = (
    HEAD
    + "ARRAY past[20]\nstored = 0\ndrun\nDYNAMIC\nd/dt x = -k*x + b*ran()\ndispt x\nSAMPLE 3\nstored = x\n"
)
DELAYED = HEAD + "drun\nDYNAMIC\nd/dt x = -k*delay(x, 0.7)\ndispt x\n"


def twice(text):
    """Run a program whose script has two runs, one after the other."""
    return desire_tui.run(text.replace("drun\n", "drun\ndrun\n"))


@pytest.mark.parametrize("text", [NOISY, DELAYED], ids=["noise", "delay"])
@pytest.mark.parametrize("backend", ["native", "reference"])
def test_runs_continue_as_in_a_script(text, backend):
    simulation = desire_tui.load(text, backend=backend).start()
    whole = desire_tui.run(text.replace("drun\n", "drun\ndrun\n"), backend=backend)
    for number in range(2):
        run = simulation.run()
        assert np.array_equal(run["x"], whole.runs[number]["x"])
        assert run.continues == whole.runs[number].continues
    assert simulation.t == pytest.approx(2)
    assert simulation["x"] == whole["x"]


@pytest.mark.parametrize("text", [NOISY, DELAYED], ids=["noise", "delay"])
@pytest.mark.parametrize("backend", ["native", "reference"])
def test_a_snapshot_is_gone_back_to_whatever_happened_since(text, backend):
    simulation = desire_tui.load(text, backend=backend).start()
    simulation.run(2)
    here = simulation.snapshot()
    first = simulation.run(3)
    simulation.restore(here)
    assert simulation.t == here.t == 2
    simulation.run(0.5, k=9)  # another way, whose past must leave no trace
    simulation.run(0.5)
    simulation.restore(here)
    again = simulation.run(3)
    assert np.array_equal(first["x"], again["x"])
    assert first.parameters == again.parameters


def test_parameters_hold_from_then_on_and_what_follows_follows():
    simulation = desire_tui.load(HEAD + "drun\nDYNAMIC\nd/dt x = -k*x\nd/dt y = b\ndispt x\n").start(k=2, t=5)
    assert simulation.t == 5
    run = simulation.run(1)
    assert (run["t"][0], run["t"][-1]) == (5, 6)
    assert run["x"][-1] == pytest.approx(np.exp(-2), abs=1e-7)
    assert simulation["y"] == pytest.approx(4)
    simulation.run(k=3)
    simulation.run()
    assert simulation.state == pytest.approx([np.exp(-8), 16], abs=1e-6)
    assert repr(simulation) == "<Simulation of <text> at t = 8>"
    assert repr(simulation.snapshot()) == "<Snapshot at t = 8>"


def test_a_run_that_cannot_begin_changes_nothing():
    simulation = desire_tui.load(DELAYED).start()
    simulation.run()
    before = simulation.state
    with pytest.raises(desire_tui.DesireError):
        simulation.run(DT=5)
    assert np.array_equal(simulation.state, before)
    assert simulation.run()["t"][0] == pytest.approx(1)


def test_what_cannot_be():
    text = "n = 2\nARRAY v[n]\nv[1] = 3 | TMAX = 1 | DT = 0.1\ndrun\nDYNAMIC\nd/dt x = v[1]\n"
    model = desire_tui.load(text)
    simulation, other = model.start(n=3), model.start()
    assert simulation["v"].shape == (3,)
    assert simulation.run().state == pytest.approx([3])
    with pytest.raises(ValueError, match="give it to Model"):
        simulation.run(n=4)
    with pytest.raises(TypeError, match="did you mean 'record'"):
        simulation.run(recrd="x")
    with pytest.raises(ValueError, match="the simulation that it was taken of"):
        other.restore(simulation.snapshot())
    with pytest.raises(KeyError):
        simulation["nothing"]
    assert simulation.run(set={"v[1]": 1}).state == pytest.approx([4])
