"""Which array statements share a loop: only those that do not see each other's elements move."""

from __future__ import annotations

import pytest

from desire_tui.engine.codegen.vector.fusion import groups, needs_copy, statement_footprint
from tests.lowering.programs import segment

ARRAYS = dict.fromkeys(("a", "b", "c", "x", "y"), (20,))


@pytest.mark.parametrize(
    ("body", "sizes"),
    [
        ("Vector a = x + y\nVector b = 2*a\nVector c = a - b", [3]),
        ("Vector a = x\nVector x = y", [2]),  # read and then written, element by element
        ("Vector a = x{-1}\nVector x = y", [1, 1]),  # x[i] would be gone when a[i + 1] wants it
        ("Vector x = y\nVector a = x{1}", [1, 1]),  # x[i + 1] would not be there yet
        ("Vector a = y{-1}\nVector b = y{1}\nVector c = y", [3]),
        ("Vector a = x{-1}\nVector b = a\nVector x = b", [2, 1]),
        ("Vector a = 1\nVector b = x{1}\nVector c = a{1}", [2, 1]),
    ],
)
def test_statements_in_one_loop(body, sizes):
    lowered, _ = segment(body, **ARRAYS)
    assert [len(group) for group in groups(lowered.body)] == sizes


@pytest.fixture
def views():
    """Arrays a and b of 20 numbers each whose storage overlaps: b begins 4 numbers behind a."""

    def lowered(body):
        from desire_tui.engine.lowering.lowering import lower
        from desire_tui.engine.syntax.parse import parse
        from desire_tui.engine.values import Quantity, Values
        from tests.lowering.programs import source

        values = Values()
        first = values.array("a", (20,)).slot
        values.array("spare", (4,))
        values.names["b"] = Quantity("b", first + 4, (20,))
        values.array("c", (20,))
        return lower(parse(source(f"DYNAMIC\n{body}")), None, values)

    return lowered


@pytest.mark.parametrize(
    "body",
    [
        "Vector a = c\nVector b = c",  # the second one wins wherever both write
        "Vector c = a\nVector b = 1",  # a[i + 4] is wanted before b[i] is written
        "Vector a = 1\nVector c = b",
    ],
)
def test_overlapping_views_do_not_share_a_loop(views, body):
    assert [len(group) for group in groups(views(body).body)] == [1, 1]


def test_a_statement_that_would_read_what_it_has_written_goes_by_a_copy(views):
    bodies = ("Vector b = a", "Vector a = a{-1}", "Vector a = 2*a", "Vector a = c{1}")
    copied = [needs_copy(statement_footprint(views(body).body[0])) for body in bodies]
    assert copied == [True, True, False, False]
