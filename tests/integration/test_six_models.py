"""Six models as users have them, under every rule that chooses its step: against scipy's Radau (1e-11) or DOP853.

A chemical oscillator, a diode circuit, a reactor with a table and vectors, a slab that radiates, an orbit, enzymes
in submodels: `six_models/*.src`. The last digits of the numbers below are scipy's at two tolerances.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from desire_tui.engine.integration.rules import rules_of
from tests.integration.stiff_programs import run

FOLDER = Path(__file__).parent / "six_models"
RULES = rules_of("variable", "multistep", "series")
ENDS = {
    "oregonator": {"x": 1.002489016, "y": 402.7724109, "z": 26144.94766},
    "clipper": {"v": -0.2078646756, "qr": 0.738696381},
    "reactor": {
        "n": 1.265044627,
        "c": (893.1844061, 2500.782794, 696.8188983, 589.6082531, 45.20736778, 5.824758407),
    },
    "slab": {"u[1]": 1.27149512, "u[20]": 0.8882365707, "u[40]": 0.6476309987, "energy": 16.33557088},
    "arenstorf": {"x": -1.174553507, "y": -0.2759450771, "u": -0.25317075, "v": 0.4473767479},
    "enzyme": {
        "s1": 0.3803017656, "c1": 0.01998423571, "p1": 0.5997139987, "s2": 0.001830808369, "c2": 0.004871251546,
        "p2": 0.2932979401,
    },
}  # fmt: skip
LARGEST = {
    "oregonator": (117800, 402.8, 31260), "clipper": (0.5646, 0.7387),
    "reactor": (1.883, 893.2, 2501, 696.8, 606.2, 56.98, 8.322), "slab": (1.271, 0.8882, 0.6476, 16.34),
    "arenstorf": (1.175, 1.142, 1.191, 2.002), "enzyme": (1, 0.01999, 0.5997, 0.3, 0.04672, 0.2933),
}  # fmt: skip
"""Largest magnitudes on the way: what ERMAX is relative to."""


def found(session, name):
    name, _, subscript = name.partition("[")
    quantity = session.values.find(name)
    view = session.values.data[quantity.slot : quantity.slot + quantity.slots]
    return view[int(subscript[:-1]) - 1 :][:1] if subscript else view


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("model", ENDS)
def test_a_model_ends_where_scipy_does(model, rule):
    """Within 10·ERMAX; the orbit passes the moon and makes more of local errors: one digit more is asked."""
    ermax = 1e-7 if model == "arenstorf" else 1e-6
    text = (
        (FOLDER / f"{model}.src")
        .read_text()
        .replace("irule 14", f"irule {rule}")
        .replace("1.0E-06 |", f"{ermax} |")
    )
    session, _ = run(text)
    record = session.runs[-1]
    assert (record.rule, record.error_max, record.ended) == (rule, ermax, "tmax")
    ends = np.concatenate([found(session, name) for name in ENDS[model]])
    expected = np.concatenate([np.atleast_1d(number) for number in ENDS[model].values()])
    scale = np.array(LARGEST[model]) + (1 if rule < 9 else 0)
    assert np.abs((ends - expected) / scale).max() < 1e-5


def test_what_the_slab_took_up_is_in_it():
    """Rule 14: heat in minus heat out is the rise of all layers together, whatever the steps are."""
    session, _ = run((FOLDER / "slab.src").read_text())
    rise = found(session, "u").sum() - 40 * 0.5
    assert found(session, "energy")[0] == pytest.approx(rise, rel=1e-6)
