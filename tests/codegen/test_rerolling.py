"""Runs of scalar statements of one shape become loops, and the numbers stay the same."""

import pytest

from desire_tui.engine.codegen.scalar import rerolling
from desire_tui.engine.codegen.scalar.rerolling import Rolled, roll
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import Values
from tests.codegen.conftest import run


def ladder(n):
    lines = ["d/dt i0 = b*(1 - v1 - i0)"]
    for k in range(1, n + 1):
        lines.append(f"d/dt v{k} = a*(i{k - 1} - i{k})")
        lines.append(f"d/dt i{k} = b*(v{k} - v{k + 1})" if k < n else f"d/dt i{k} = b*(v{k} - i{k})")
    return lines


def chain(n):
    """Defined variables in a row, then derivatives with one of two numbers in turn."""
    lines = [f"u{k} = 0.5*(x{k} + x{k + 1})^2" for k in range(n)] + [f"u{n} = x{n}"]
    lines += [f"d/dt x{k} = {1 + k % 2}.25*u{k} - 3*x{k}" for k in range(n)]
    return [*lines, f"d/dt x{n} = -x{n}"]


def recursion(n):
    """Each line needs the one before: nothing may be rolled up."""
    return ["u0 = x0", *(f"u{k} = 0.5*(u{k - 1} + a)" for k in range(1, n)), f"d/dt x0 = u{n - 1} - x0"]


def program(lines, states):
    starts = " | ".join(f"{name} = 0.{k % 9 + 1}" for k, name in enumerate(states))
    return (
        f"a = 2 | b = 3 | irule 3\n{starts}\nTMAX = 0.5 | DT = 0.01 | NN = 6\ndrun\nDYNAMIC\n" + "\n".join(lines)
        + f"\ndispt {states[0]}, {states[-1]}\n"
    )  # fmt: skip


def states_of(lines):
    return [line.split()[1] for line in lines if line.startswith("d/dt")]


@pytest.mark.parametrize(("lines", "loops"), [(ladder(200), 1), (chain(230), 2), (recursion(250), 0)])
@pytest.mark.parametrize("width", [2, 4, 8])
def test_what_is_rolled_up(lines, loops, width):
    values = Values()
    for name in (*states_of(lines), "a", "b"):
        values.assign(values.scalar(name).slot, 1.0)
    values.assign(0, 0.0)
    segment = lower(parse(Source("DYNAMIC\n" + "\n".join(lines) + "\n")), None, values)
    rolled = roll(segment.body, width)
    found = [r for r in rolled if isinstance(r, Rolled)]
    assert len(found) == loops
    assert sum(r.count for r in found) + len(rolled) - loops == len(lines)
    assert loops == 0 or len(rolled) < 12


@pytest.mark.parametrize(
    "lines", [ladder(200), chain(230), recursion(250)], ids=["ladder", "chain", "recursion"]
)
def test_rolled_up_statements_give_the_same_bits(lines, monkeypatch):
    text = program(lines, states_of(lines))
    rolled = run(text).rows.tolist()
    monkeypatch.setattr(rerolling, "_RUN_LEAST", 10**9)
    assert run(text).rows.tolist() == rolled


def test_library_functions_stay_alone():
    lines = [f"d/dt x{k} = sin(x{k})" for k in range(300)]
    values = Values()
    for name in states_of(lines):
        values.assign(values.scalar(name).slot, 1.0)
    segment = lower(parse(Source("DYNAMIC\n" + "\n".join(lines) + "\n")), None, values)
    assert not any(isinstance(r, Rolled) for r in roll(segment.body, 4))
