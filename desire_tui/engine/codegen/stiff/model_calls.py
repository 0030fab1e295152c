"""What solvers ask of a model, in plain Python: derivatives, error weights, states to and from the values.

They know the model only through `integration.problem.SolverProblem`; `integration.callbacks` does the same
with numpy for the reference back end.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.plain_python.library import copy
from desire_tui.engine.integration.problem import FLOOR
from desire_tui.engine.values import T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32, Ints, Reals
    from desire_tui.engine.integration.problem import SolverProblem

FEW = 20
"""Numbers that are copied one by one."""
GO_BACK = 1
"""A callback's result for: try a smaller step."""
_LARGEST = 1.7976931348623157e308


def scatter(problem: SolverProblem, y: Reals) -> None:
    """Write a state vector to the states' places among the values."""
    if problem.range_count == 1:  # most models: a copy of a length that code for n states knows
        values: Reals = problem.values
        ranges: Ints = problem.ranges
        transfer(values, ranges[0], y, problem.n)
    else:
        scatter_ranges(problem, y)


def transfer(to: Reals, place: int, numbers: Reals, n: int) -> None:
    """Copy n numbers, a few one by one: two loaded at once that were just stored singly are waited for."""
    if n <= FEW:
        for i in range(n):
            to[place + i] = numbers[i]
    else:
        copy(to, place, numbers, 0, n)


def scatter_ranges(problem: SolverProblem, y: Reals) -> None:
    """Do it where they do not stand together."""
    values: Reals = problem.values
    ranges: Ints = problem.ranges
    for i in range(problem.range_count):
        slot = ranges[3 * i]
        first = ranges[3 * i + 1]
        count = ranges[3 * i + 2]
        if count == 1:
            values[slot] = y[first]
        else:
            copy(values, slot, y, first, count)


def gather(problem: SolverProblem) -> None:
    """Copy the states' values to the solver's vector."""
    values: Reals = problem.values
    ranges: Ints = problem.ranges
    states: Reals = problem.states
    for i in range(problem.range_count):
        copy(states, ranges[3 * i + 1], values, ranges[3 * i], ranges[3 * i + 2])


def evaluate(problem: SolverProblem, t: float, y: Reals, derivatives: Reals) -> Int32:
    """Where a derivative is not finite, name the state `suspect` and ask for a smaller step."""
    values: Reals = problem.values
    values[T] = t
    scatter(problem, y)
    problem.derivative_calls += 1
    problem.derivatives(problem.memory, derivatives)
    if has_finite_sum(derivatives, problem.n):
        return 0
    wild = False
    for i in range(problem.n):
        if not abs(derivatives[i]) <= _LARGEST:
            problem.suspect = i
            wild = True
    return GO_BACK if wild else 0


def has_finite_sum(numbers: Reals, n: int) -> int:
    """Whether the sum is finite: then all numbers are. Four sums at a time: this follows every call."""
    first = 0.0
    second = 0.0
    third = 0.0
    fourth = 0.0
    i = 0
    while i + 4 <= n:
        first += numbers[i]
        second += numbers[i + 1]
        third += numbers[i + 2]
        fourth += numbers[i + 3]
        i += 4
    while i < n:
        first += numbers[i]
        i += 1
    return abs(first + second + third + fourth) <= _LARGEST


def weigh(problem: SolverProblem, y: Reals, weights: Reals) -> Int32:
    """1 / (ERMAX·max |y| so far + ERABS), the maximum taken as 1 while it is 0 (language.md 11)."""
    largest: Reals = problem.largest
    tolerance: float = problem.tolerance
    n = problem.n
    most = 0.0
    for i in range(n):
        size = max(largest[i], abs(y[i]))
        largest[i] = size
        most = max(most, size)
    problem.floor = most * FLOOR
    absolute: float = problem.absolute
    for i in range(n):
        weights[i] = 1.0 / (tolerance * scale(problem, i) + absolute)
    if problem.noisy != 0:
        excuse_noise(problem, weights)
    return 0


def excuse_noise(problem: SolverProblem, weights: Reals) -> None:
    """Let errors of states that are rounding noise (`stiff.rounding`) be as large as that."""
    noise: Reals = problem.noise
    for i in range(problem.n):
        if noise[i] > 0.0:
            weights[i] = min(weights[i], 1.0 / noise[i])


def scale(problem: SolverProblem, i: int) -> float:
    """Return the largest magnitude of state i so far, 1 for 0."""
    largest: Reals = problem.largest
    size: float = largest[i]
    if size == 0.0:
        return 1.0
    floor: float = problem.floor
    return max(floor, size)
