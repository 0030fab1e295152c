"""Patterns of Jacobians, their colours, and the plan that is made from them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from desire_tui.engine.integration.pattern import Pattern
from desire_tui.engine.integration.plan import plan
from desire_tui.engine.integration.problem import Matrix
from desire_tui.engine.integration.rules import RULES


@st.composite
def patterns(draw):
    n = draw(st.integers(1, 25))
    state = st.integers(0, n - 1)
    entries = draw(st.lists(st.tuples(state, state), max_size=60))
    rows, columns = np.array(entries, dtype=np.int32).reshape(-1, 2).T
    return Pattern.of(n, rows, columns), set(entries)


def heat(n):
    i = np.arange(n, dtype=np.int32)
    return Pattern.of(n, np.concatenate((i, i[1:], i[:-1])), np.concatenate((i, i[:-1], i[1:])))


@given(patterns())
def test_entries_are_sorted_unique_and_hold_the_diagonal(made):
    pattern, entries = made
    found = list(zip(pattern.columns.tolist(), pattern.rows.tolist(), strict=True))
    assert found == sorted(set(found))
    assert {(r, c) for c, r in found} == entries | {(i, i) for i in range(pattern.n)}
    assert pattern.starts[0] == 0
    assert pattern.starts[-1] == pattern.count


@given(patterns())
def test_states_of_one_colour_share_no_row(made):
    pattern, _ = made
    pairs = list(zip(pattern.rows.tolist(), pattern.colours[pattern.columns].tolist(), strict=True))
    assert len(pairs) == len(set(pairs))


@given(patterns())
def test_every_entry_is_filled_once_by_its_colour(made):
    """Fill a matrix as the callbacks do, with exact columns of a known matrix, and get it back."""
    pattern, _ = made
    n = pattern.n
    true = np.zeros((n, n))
    true[pattern.rows, pattern.columns] = np.arange(1.0, pattern.count + 1)
    tables = plan(14, pattern).tables
    data = np.zeros(n * n)
    for colour in range(len(tables.seed_starts) - 1):
        direction = np.zeros(n)
        direction[tables.seeds[tables.seed_starts[colour] : tables.seed_starts[colour + 1]]] = 1.0
        column = true @ direction
        part = slice(*tables.entry_starts[colour : colour + 2])
        data[tables.places[part]] = column[tables.rows[part]]
    assert np.array_equal(data.reshape(n, n).T, true)


def test_three_colours_and_a_band_for_the_heat_equation():
    pattern = heat(1000)
    assert pattern.colours.max() == 2
    made = plan(14, pattern)
    assert (made.linear.kind, made.linear.lower, made.linear.upper) == ("band", 1, 1)
    assert made.method is Matrix.TANGENT


def test_an_arrow_needs_two_colours():
    """First row and column full: all other columns share row 0, so every state has its own colour."""
    n = 40
    i = np.arange(n, dtype=np.int32)
    zero = np.zeros(n, dtype=np.int32)
    assert Pattern.of(n, i, zero).colours.max() == 1  # a full first column: two colours
    assert Pattern.of(n, zero, i).colours.max() == n - 1  # a full first row: n


def test_two_fields_side_by_side_get_a_sparse_matrix():
    """u[n] and v[n] coupled element by element: bandwidth n, 4 entries a row."""
    n = 1000
    i = np.arange(n, dtype=np.int32)
    rows = np.concatenate((i, i[1:], i[:-1], i + n, i, i + n))
    columns = np.concatenate((i, i[:-1], i[1:], i + n, i + n, i))
    made = plan(14, Pattern.of(2 * n, rows, columns))
    assert made.linear.kind == "sparse"
    assert made.linear.nonzeros == len(rows)


@pytest.mark.parametrize(
    ("rule", "kind", "linear"),
    [(9, "fixed-point", "fixed-point"), (10, "jacobian", "dense"), (11, "differences", "dense"),
     (12, "diagonal", "diagonal"), (13, "fixed-point", "fixed-point"), (14, "jacobian", "dense"),
     (15, "differences", "dense"), (16, "diagonal", "diagonal")],
)  # fmt: skip
def test_each_rule_has_its_way(rule, kind, linear):
    assert RULES[rule].corrector == kind
    assert plan(rule, Pattern.full(3)).linear.kind == linear


def test_the_program_goes_before_the_derived_jacobian():
    assert plan(14, Pattern.full(3), program=True).method is Matrix.PROGRAM
    assert plan(15, Pattern.full(3), program=False).method is Matrix.DIFFERENCES
    assert plan(14, Pattern.full(3), tangent=False).method is Matrix.DIFFERENCES
