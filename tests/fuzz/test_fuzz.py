"""A few inputs of every kind, always the same ones; and the fuzzer itself: it sees exceptions, crashes and hangs."""

from __future__ import annotations

import os
import time

import pytest

from tests.fuzz.kinds import KINDS, Kind
from tests.fuzz.minimise import minimised
from tests.fuzz.runner import SingleInputs, try_kind

SEED = 1
PATIENCE = 5.0
"""On a busy machine everything takes longer; what hangs does so all the same."""
OWN = Kind("test_fuzz", "inputs that say what is to happen", 3, 1, 1)


def _first(seed, number):
    return OWN.random(seed, number).random()


@pytest.mark.parametrize("name", KINDS)
def test_inputs_of_every_kind(name):
    kind = KINDS[name]
    report = try_kind(kind, SEED, count=kind.in_suite, seconds=float("inf"), patience=PATIENCE)
    assert report.tried == kind.in_suite
    assert not report.faults


def test_inputs_depend_on_seed_and_number_only():
    for kind in KINDS.values():
        assert kind.generate(SEED, 3) == kind.generate(SEED, 3)
        assert kind.generate(SEED, 3) != kind.generate(SEED + 1, 3)


def test_faults_of_all_sorts_are_seen():
    report = try_kind(OWN, SEED, count=len(_MADE), seconds=60)
    assert report.tried == len(_MADE)
    assert report.failed == 3
    assert sorted(signature.split(" ")[0] for signature in report.faults) == [
        "ZeroDivisionError",
        "crash",
        "hang",
    ]
    assert "Fatal Python error: Aborted" in next(
        f.detail for _, f in report.faults.values() if "crash" in f.signature
    )


def test_failing_inputs_are_made_small():
    tester = SingleInputs(OWN, 3)
    text = "one\ntwo raise three\nfour\n"
    assert minimised(text, lambda made: tester.fault(made) is not None, 30) == "raise"
    assert minimised(["a", text, "b"], lambda made: "raise" in "".join(made), 30) == ["raise"]
    tester.close()


_MADE = ("sound", "raise", "sound", "abort", "hang", "sound")
_NEXT = {_first(SEED, k): word for k, word in enumerate(_MADE)}


def generate(rng):
    """Return an input of a kind that this module is: it says what is to happen."""
    return _NEXT[rng.random()]


def check(made):
    if "raise" in made:
        raise ZeroDivisionError
    if "abort" in made:
        os.abort()
    if "hang" in made:
        time.sleep(100)
