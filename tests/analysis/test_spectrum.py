"""Spectra of signals whose spectrum is known."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.analysis.progress import unwatched
from desire_tui.analysis.signals.spectrum import analyse
from desire_tui.engine.diagnostics import DesireError

TWO_TONES = """TMAX = 100 | DT = 0.01 | NN = 10001
drun
DYNAMIC
y = 3 + 2*sin(2*a*1.25*t) + 0.5*cos(2*a*7.5*t)
z = cos(2*a*3*t)
dispt y, z
"""
TWO_TONES = f"a = {np.pi} | {TWO_TONES}"


def test_frequencies_and_amplitudes_of_two_tones(subject):
    found = analyse(subject(TWO_TONES), "y, z window 2000", unwatched)
    peaks = found.tables[0].columns
    assert peaks["frequency"] == pytest.approx([1.25, 7.5], abs=1e-3)
    assert peaks["amplitude"] == pytest.approx([2.0, 0.5], rel=1e-3)
    assert found.tables[1].columns["period"] == pytest.approx([1 / 3], rel=1e-3)


def test_the_density_holds_the_variance(subject):
    """Parseval: the integral of the density is the variance, 2^2/2 + 0.5^2/2."""
    found = analyse(subject(TWO_TONES), "y", unwatched)["y"]
    step = found["frequency"][1]
    assert step * found["density"].sum() == pytest.approx(2.125, rel=5e-3)


def test_what_is_slower_than_the_windows_is_told(subject):
    slow = TWO_TONES.replace("y = 3 + 2*sin(2*a*1.25*t)", "y = 3 + 2*sin(2*a*0.05*t)")
    found = analyse(subject(slow), "y window 2000", unwatched)
    assert found.notes[1] == (
        "y: its largest part is slower than 3 periods in a window: window 10001, all samples"
    )
    assert found.tables[0].columns["frequency"] == pytest.approx([7.5], abs=1e-3)
    assert len(analyse(subject(slow), "y window 10001", unwatched).notes) == 1


def test_a_part_of_the_run(subject):
    text = TWO_TONES.replace("y = 3", "y = 100*swtch(t - 9)*swtch(11 - t) + 3")
    whole = analyse(subject(text), "y", unwatched)["y"]["density"]
    late = analyse(subject(text), "y from 12", unwatched)["y"]["density"]
    assert np.sum(late) < 0.5 * np.sum(whole)


def test_other_values_of_the_program(subject):
    found = analyse(subject(TWO_TONES, settings={"a": 2 * np.pi}), "z", unwatched)
    assert found.tables[0].columns["frequency"] == pytest.approx([6.0], abs=1e-2)


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ("", "the request ends where a quantity's name is expected"),
        ("y window 3", "3 is no whole number from 8 on"),
        ("q", "'q' is to be recorded, but the program does not have it"),
    ],
)
def test_mistakes(subject, request_, message):
    with pytest.raises(DesireError) as error:
        analyse(subject(TWO_TONES), request_, unwatched)
    assert error.value.diagnostics[0].message == message


def test_a_run_of_few_samples_says_nothing(subject):
    with pytest.raises(DesireError, match="too few"):
        analyse(subject(TWO_TONES.replace("NN = 10001", "NN = 2")), "y", unwatched)
