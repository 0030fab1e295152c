"""`ran()`: exactly the 48-bit sequence, whatever shape the code has."""

import math

import numpy as np
import pytest

from desire_tui.engine.random_sequence import jump, seeded
from desire_tui.engine.reference.random import Sequence
from tests.codegen.conftest import run

MODULUS = 1 << 48


def sequence(seed, count):
    """The sequence of POSIX drand48, from its definition."""
    x = (seed << 16) + 0x330E
    for _ in range(count):
        x = (0x5DEECE66D * x + 11) % MODULUS
        yield x / MODULUS


@pytest.mark.parametrize("count", [0, 1, 2, 7, 1000, -1, -13])
def test_jumps_are_repeated_steps(count):
    a, c = jump(count)
    x = 0x123456789ABC
    there = (a * x + c) % MODULUS
    back, forth = (x, there) if count >= 0 else (there, x)
    for _ in range(abs(count)):
        back = (0x5DEECE66D * back + 11) % MODULUS
    assert back == forth


@pytest.mark.parametrize("count", [0, 1, 2, 3, 8, 1000])
def test_many_numbers_drawn_at_once_are_the_next_ones(count):
    drawn = Sequence(np.array([seeded(5)], np.uint64))
    assert drawn.block(count).tolist() == list(sequence(5, count))
    assert [drawn.uniform(), *drawn.block(2)] == list(sequence(5, count + 3))[count:]


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 8, 13, 100])
def test_vectors_draw_from_the_last_element_down_and_left_to_right(n):
    made = run(
        f"SEED 5 | ARRAY x[{n}], y[{n}]\nNN = 2\ndrun\nDYNAMIC\nz = ran()\nVector x = ran() + 10*ran()\n"
        "Vector y = ran()\ndispt z\n"
    )
    u = np.array([2 * v - 1 for v in sequence(5, 2 * (1 + 3 * n))])
    second = u[1 + 3 * n :]  # the second of the two passes is what is left
    assert made.scalar("z") == second[0]
    pairs = second[1 : 1 + 2 * n].reshape(n, 2)[::-1]
    assert made.array("x").tolist() == (pairs[:, 0] + 10 * pairs[:, 1]).tolist()
    assert made.array("y").tolist() == second[1 + 2 * n :][::-1].tolist()


@pytest.mark.parametrize("shape", [(1, 1), (2, 3), (3, 5), (4, 8), (5, 9)])
@pytest.mark.parametrize("factor", ["", "u*v*"])
def test_matrices_draw_from_the_last_element_down(shape, factor):
    m, n = shape
    made = run(
        f"SEED 9 | m = {m} | n = {n} | ARRAY W[m,n], u[m], v[n]\nfor i = 1 to m | u[i] = 1 | next\n"
        f"for k = 1 to n | v[k] = 1 | next\nNN = 2\ndrun\nDYNAMIC\nMATRIX W = {factor}ran()\nz = 0\ndispt z\n"
    )
    u = np.array([2 * v - 1 for v in sequence(9, 2 * m * n)])[m * n :]
    assert made.array("W").ravel().tolist() == u[::-1].tolist()


def test_gauss_takes_two_numbers_first_the_radius():
    made = run("SEED 1\nNN = 2\ndrun\nDYNAMIC\nz = gauss(0)\ndispt z\n")
    u = list(sequence(1, 4))
    wanted = [math.sqrt(-2 * math.log(u[i])) * math.cos(2 * math.pi * u[i + 1]) for i in (0, 2)]
    assert made.rows[:, 1].tolist() == wanted


def test_a_shared_argument_is_drawn_once():
    made = run("FUNCTION twice(a$) = a$ - a$\nSEED 1\nNN = 20\ndrun\nDYNAMIC\nz = twice(ran())\ndispt z\n")
    assert not made.rows[:, 1].any()


@pytest.mark.parametrize("backend", ["native", "reference"])
def test_the_same_line_twice_draws_twice(backend):
    made = run("SEED 3\nNN = 2\ndrun\nDYNAMIC\nu = ran()\nv = u\nu = ran()\nz = u - v\ndispt z\n", backend)
    u = [2 * v - 1 for v in sequence(3, 4)]
    assert made.rows[:, 1].tolist() == [u[1] - u[0], u[3] - u[2]]
