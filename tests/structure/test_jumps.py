"""Jumps from anywhere to where a block around them, or no block at all, is."""

from __future__ import annotations

import pytest

from tests.structure.test_structure import of


@pytest.mark.parametrize(
    "text",
    [
        "PROCEDURE p | label a | go to a | end",
        "PROCEDURE p | label a | for i = 1 to 2 | if i > 1 then | go to a | proceed | next | end",
        "for i = 1 to 2 | label a | for j = 1 to 2 | if j > 1 then | go to a | proceed | next | next",
    ],
)
def test_within_the_blocks_around(text):
    assert of(text).problems == ()


def test_out_of_a_procedure():
    found = of("label a | PROCEDURE p | if x > 1 then | go to a | proceed | end")
    assert [problem.key for problem in found.problems] == ["jump-out"]
