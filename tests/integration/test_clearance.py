"""The box in which no mode switches: it is what it says, steps inside it are not looked at, none is missed."""

from __future__ import annotations

from random import Random
from unittest.mock import patch

import numpy as np
import pytest

from desire_tui.engine.codegen.jit.background import Improver
from desire_tui.engine.integration.switching import clearance, watch
from desire_tui.engine.passes import switching
from tests.integration.stiff_programs import run

CURVED = """\
x = 1 | y = 0.5 | irule 14 | TMAX = 8 | DT = 0.01 | NN = 3 | ERMAX = 1e-4
drun
DYNAMIC
size = x*x + y*y
d/dt x = y
d/dt y = -x + 0.05*swtch(size - 3)*y + rect(4*x - 1)/10 + round(2*x)/9 + trnc(3*x*y)/9 - deadc(x - 0.04*t)/9
dispt x
"""
SPIRAL = """\
x = 10 | y = 0 | irule {rule} | TMAX = 200 | DT = 0.01 | NN = 2 | ERMAX = {ermax} | DTMAX = 0.05
drun
DYNAMIC
term t - 190 - x*0
d/dt x = y
d/dt y = -x - 0.02*y
d/dt above = swtch(x - 3) + swtch(x*y - 20)
d/dt late = sgn(x + 0.05*t - 5)
dispt x
"""
"""Its switches stop to fire one after the other; that of `late` begins again and again to be near."""

FAR = """\
x = 1 | y = 0 | irule 14 | TMAX = 20 | DT = 0.01 | NN = 2 | ERMAX = 1e-4
drun
DYNAMIC
d/dt x = y
d/dt y = -x
d/dt above = swtch(x - 5) + swtch(x*y - 6)
dispt x
"""


def _improve_at_once(_improver, work):
    for _ in work.improve():
        pass


def test_no_mode_switches_anywhere_in_a_box():
    rng, boxes = Random(1), []

    def renew(w, t, h):
        clearance.renew_box(w, t, h)
        slots = [w.box_slots[i] for i in range(w.box_count)]
        sides = [(w.box_low[i], w.box_high[i]) for i in range(w.box_count)]
        here = [w.values[slot] for slot in slots]
        assert all(low <= x <= high for x, (low, high) in zip(here, sides, strict=True))
        found = []
        for _ in range(40):
            for slot, x, (low, high) in zip(slots, here, sides, strict=True):
                w.values[slot] = rng.uniform(max(low, x - 4), min(high, x + 4))
            w.modes(w.memory, w.f1_address)
            found.append([w.values[w.live + i] for i in range(w.count)])
        for slot, x in zip(slots, here, strict=True):
            w.values[slot] = x
        w.modes(w.memory, w.f1_address)
        assert found == [[w.values[w.live + i] for i in range(w.count)]] * 40
        boxes.append(sides)

    with patch.multiple(clearance, _PAUSE_LEAST=1, _PAUSE_MOST=4), patch.object(watch, "renew_box", renew):
        run(CURVED, "reference")
    assert len(boxes) > 10
    assert max(high - low for sides in boxes for low, high in sides) > 0.5


@pytest.mark.parametrize(("rule", "ermax"), [(4, 1e-6), (7, 1e-3), (8, 1e-5), (9, 1e-5), (14, 1e-5)])
def test_the_box_changes_no_bit(rule, ermax):
    text = SPIRAL.format(rule=rule, ermax=ermax)
    with patch.object(Improver, "add", _improve_at_once):
        with_box = run(text)[0].runs[-1]
        with patch.object(switching, "moving_slots", return_value=()):
            without = run(text)[0].runs[-1]
    assert with_box.count == without.count
    assert with_box.steps == without.steps > 1000
    assert np.array_equal(with_box.rows[: with_box.count], without.rows[: without.count])


def test_steps_inside_are_not_looked_at():
    with (
        patch.object(clearance, "_PAUSE_LEAST", 8),
        patch.object(watch, "are_far", side_effect=watch.are_far) as look,
    ):
        steps = run(FAR, "reference")[0].runs[-1].steps
    assert 0 < look.call_count < 0.5 * steps


@pytest.mark.parametrize("rule", [4, 14])
def test_a_run_with_another_threshold_has_another_box(rule):
    text = f"""\
x = 1 | y = 0 | a = 50 | irule {rule} | DT = 0.01 | TMAX = 40 | NN = 2 | ERMAX = 1e-6
drun
x = 1 | y = 0 | t = 0 | a = 0.5
drun
write above
DYNAMIC
d/dt x = y
d/dt y = -x
d/dt above = swtch(x - a)
dispt x
"""
    with patch.object(Improver, "add", _improve_at_once):
        written = run(text)[1]
    assert float(written) == pytest.approx(
        13 * np.pi * 2 / 6, abs=1e-3
    )  # six periods of 2π/3, and half of one
