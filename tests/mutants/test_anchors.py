"""The table of deliberate faults keeps up with the code: each place is there, once, and its fault is Python."""

from __future__ import annotations

import ast

import pytest

from tests.mutants.anchors import ROOT, with_fault
from tests.mutants.table import MUTANTS


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.title[:60])
def test_a_fault_has_its_one_place(mutant):
    path, text = with_fault(mutant, ROOT)
    assert text != path.read_text(encoding="utf-8")
    ast.parse(text)
    for target in mutant.first:
        assert (ROOT / target.split("::")[0]).exists(), target


def test_there_are_enough_of_them():
    assert len(set(MUTANTS)) == len(MUTANTS) >= 60
