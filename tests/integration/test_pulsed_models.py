"""Published models driven by pulses shorter than the samples lie apart: against scipy at 1e-12, begun anew at each edge.

A nerve under a pulse train, a heart cell stimulated for a millisecond, the ring modulator: `pulsed_models/*.src`. No DTMAX, no
DTMIN, no further sample is needed to see a pulse. The numbers are those of `pulsed_models/references.py`.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from desire_tui.engine.integration.rules import rules_of
from tests.integration.pulsed_models.references import MODELS, solve
from tests.integration.stiff_programs import run

FOLDER = Path(__file__).parent / "pulsed_models"
ERMAX = 1e-6
ENDS = {
    "hodgkin_huxley": (-63.8664496879, 0.06404110697, 0.548064516801, 0.344804192129),
    "beeler_reuter": (
        -82.9462347945, 1.88341041699e-07, 0.225098129826, 0.0135650174237, 0.979061372405, 0.958105389742,
        0.00342300098925, 0.961182070246,
    ),
    "ring_modulator": (
        0.0111902669605, -0.00142600664939, 0.22671171537, -0.219977271599, -0.226285127883, 0.220403859087,
        -0.135058281288, -7.08416083195e-09, 5.31690835748e-10, -0.00152563636694, -0.00154891948507,
        0.00154891619706, 0.00152563965495, 5.39312298707e-05, 8.10725012083e-07,
    ),
}  # fmt: skip
LARGEST = {
    "hodgkin_huxley": (76.17, 0.9938, 0.5986, 0.7685),
    "beeler_reuter": (84.57, 6.17e-06, 0.3664, 0.9985, 0.988, 0.975, 0.9729, 0.9951),
    "ring_modulator": tuple(abs(end) for end in ENDS["ring_modulator"]),
}
"""Largest magnitudes on the way: what ERMAX is relative to."""


def largest_error(model, rule):
    """The largest error of all states at the end, in units of ERMAX."""
    text = (FOLDER / f"{model}.src").read_text().replace("irule 14", f"irule {rule}")
    session, _ = run(text)
    record = session.runs[-1]
    assert (record.rule, record.error_max, record.ended) == (rule, ERMAX, "tmax")
    names = [line.split()[1] for line in text.splitlines() if line.startswith("d/dt")]
    found = np.array([session.values.data[session.values.find(name).slot] for name in names])
    scale = np.array(LARGEST[model]) + (1 if rule < 9 else 0)
    return float((np.abs(found - ENDS[model]) / scale).max()) / ERMAX


CASES = [(model, rule) for model in ENDS for rule in rules_of("variable", "multistep", "series")]
SLOW = [("hodgkin_huxley", 4), ("hodgkin_huxley", 7), ("hodgkin_huxley", 8)]
"""Right too, in so many steps that a test of them would take seconds."""


@pytest.mark.parametrize(("model", "rule"), [case for case in CASES if case not in SLOW])
def test_no_pulse_is_missed(model, rule):
    assert largest_error(model, rule) < 10


def test_the_references_are_what_their_script_makes():
    ends, largest = solve("hodgkin_huxley", 1e-8)
    assert ends == pytest.approx(ENDS["hodgkin_huxley"], rel=1e-6)
    assert largest == pytest.approx(LARGEST["hodgkin_huxley"], rel=1e-3)
    assert set(MODELS) == set(ENDS)
