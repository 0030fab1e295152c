"""Edges: loops that do not drift, numbers of 16 bits, rows of exactly one piece."""

from __future__ import annotations

import pytest

from tests.interpreter.stand_in import run


@pytest.mark.parametrize(
    ("last", "step", "passes"), [("0.3", "0.1", 4), ("0.9", "0.3", 4), ("-0.3", "-0.1", 4)]
)
def test_a_loop_whose_last_value_rounding_leaves_a_little_short(last, step, passes):
    """0.3/0.1 is 2.9999999999999996 in doubles."""
    assert run(f"n = 0\nfor x = 0 to {last} step {step}\nn = n + 1\nnext")["n"] == passes


def test_the_value_of_each_pass_is_computed_anew():
    """0.1 added a hundred times is 9.99999999999998; 100 times 0.1 is 10."""
    world = run("ARRAY v[101] | i = 1\nfor x = 0 to 10 step 0.1\nv[i] = x | i = i + 1\nnext")
    assert world["v"].tolist() == [k * 0.1 for k in range(101)]


@pytest.mark.parametrize(
    ("written", "shown"),
    [("%%(-32768)", "8000"), ("%%(-32769)", "ffffffffffff7fff"), ("%%32767", "7fff"), ("%(-1)", "177777")],
)
def test_negative_numbers_in_hexadecimal_and_octal(written, shown):
    assert run(f"write {written}").text == f"{shown}\n"


@pytest.mark.parametrize("size", [99, 100, 101, 200])
def test_a_row_of_any_length_is_one_line(size, tmp_path):
    run(f"ARRAY v[{size}]\nconnect 'raw' as output 3\nwrite ##3, v\ndisconnect 3", folder=tmp_path)
    assert (tmp_path / "raw.dat").read_text() == "\t".join(["0"] * size) + "\n"
