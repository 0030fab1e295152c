"""Pulses, switches, roots, events, doses and delays under every rule that controls its steps, against exact ends.

docs/rules.md has the figures (`moments_table`).
"""

from __future__ import annotations

import pytest

from tests.integration.moments_problems import MOMENTS, RULES, error
from tests.integration.moments_table import BEGIN, LIMIT, PAGE

TAYLOR = 17


@pytest.mark.parametrize("moment", MOMENTS, ids=lambda moment: moment.title)
def test_every_rule(moment):
    rules = [rule for rule in RULES if rule != TAYLOR or "delay(" not in moment.body]  # a delay has no series
    assert {rule: found for rule in rules if not (found := error(moment, rule)[0]) <= LIMIT} == {}


def test_the_page_has_a_row_for_each():
    table = PAGE.read_text(encoding="utf-8").partition(BEGIN)[2]
    assert all(f"| {moment.title} |" in table for moment in MOMENTS)
    assert "**" not in table
