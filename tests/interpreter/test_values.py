"""The flat store: addresses stay, memory does not grow with arrays that are cleared."""

from __future__ import annotations

import resource
import sys

import numpy as np

from desire_tui.engine.interpreter.quantity_rows import names
from desire_tui.engine.values import SCALAR_SLOTS, Kind, Values
from tests.interpreter.stand_in import RecordingHost


def test_addresses_never_change():
    values = Values()
    before = values.address
    for k in range(3000):
        values.scalar(f"x{k}")
    values.array("big", (1000, 1000))
    values.clear()
    assert values.address == before


def test_clear_zeroes_and_forgets():
    values = Values()
    big = values.array("big", (3_000_000,))
    values.view(big)[:] = 7.0
    values.assign(values.scalar("x").slot, 5.0)
    values.clear()
    assert [q.name for q in values if values.is_defined(q)] == ["scale", "PI"]
    again = values.array("other", (3_000_000,))
    assert not values.view(again).any()
    assert values.cells[values.scalar("x").slot] == 0.0


def test_zeroing_part_of_the_memory_leaves_its_neighbours():
    values = Values()
    left, middle, right = (values.array(name, (200_001,)) for name in "abc")
    for quantity in (left, middle, right):
        values.view(quantity)[:] = 1.0
    values.zero(middle)
    assert values.view(left).all()
    assert not values.view(middle).any()
    assert values.view(right).all()


def test_arrays_that_are_never_touched_cost_nothing():
    values = Values()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for k in range(20):
        values.array(f"a{k}", (1_000_000,))
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 8_000  # kB; 160 MB were declared
    assert len(values.defined) < SCALAR_SLOTS
    assert sys.getsizeof(values.defined) < 10_000


def test_arrays_start_on_cache_lines():
    values = Values()
    slots = [values.array(f"a{k}", (k + 1,)).slot for k in range(20)]
    assert all(slot % 8 == 0 for slot in slots)


def test_rows_for_the_quantities_pane():
    host = RecordingHost()
    host.run("x = 1/3 | ARRAY A[2,3] | INTEGER n | COMPLEX z | STATE v[2] | z = 1 + j | n = 5 | A[1,2] = 4")
    rows = {row.name: row for row in names(host.values)}
    assert rows["x"].text == "0.333333"
    assert (rows["A"].title, rows["A"].kind, rows["A"].text) == ("A[2,3]", "real array", "0  4  0  0  …")
    assert (rows["n"].kind, rows["z"].text, rows["v"].kind) == ("INTEGER", "1 + j*( 1)", "STATE array")
    assert "TMAX" not in rows


def test_complex_views_share_memory():
    values = Values()
    z = values.array("z", (3,), Kind.COMPLEX)
    values.view(z)[1] = 2 + 3j
    assert values.cells[z.slot + 2] == 2
    assert values.view(z).dtype == np.complex128
