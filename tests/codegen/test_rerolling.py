"""Runs of scalar statements of one shape become loops, and the numbers stay the same."""

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from desire_tui.engine.codegen.scalar import rerolling
from desire_tui.engine.codegen.scalar.rerolling import Rolled, roll
from desire_tui.engine.lowered.expressions import Const, Load, Op
from desire_tui.engine.lowered.statements import Deriv, Set, Where
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.source import Source, Span
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


PLACE = Where(Span(0, 1))
OPERANDS = {
    "side by side": lambda k: Load(20 + k),
    "in turn": lambda k: Const((1.5, 2.5)[k % 2]),
    "zeros": lambda k: Const(-0.0 if k == 57 else 0.0),
    "two, a slot or a number": lambda k: Load(2) if k % 50 else Const(2.0),
    "side by side, then in turn": lambda k: Load(20 + k) if k < 24 else Load(36 + k % 8),
    "eight in turn": lambda k: Load(20 + k % 8),
    "a number among slots": lambda k: Const(20.0 + k) if k == 44 else Load(20 + k),
    "always one": lambda k: Load(7),
}
ODD = {
    "jump": lambda k, value: Deriv(k + 1, value, PLACE),
    "other kind": lambda k, value: Set(k, value, PLACE),
    "other shape": lambda k, value: Deriv(k, Op("sub", value.args), PLACE),
    "no shape": lambda k, value: Deriv(k, Op("ran", ()), PLACE),
}


@given(
    st.tuples(st.sampled_from(sorted(OPERANDS)), st.sampled_from(sorted(OPERANDS))),
    st.dictionaries(st.integers(0, 119), st.sampled_from(sorted(ODD)), max_size=4),
    st.sampled_from([2, 4, 8]),
    st.sampled_from([8, 9, 16]),
)
@example(("side by side, then in turn", "always one"), {}, 8, 8)
@example(("eight in turn", "always one"), {}, 8, 8)
def test_whole_columns_are_compared_as_single_operands_are(operands, odd, width, alone):
    left, right = (OPERANDS[name] for name in operands)
    values = [Op("add", (left(k), right(k))) for k in range(120)]
    actions = [
        ODD[odd[k]](k, value) if k in odd else Deriv(k, value, PLACE) for k, value in enumerate(values)
    ]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rerolling, "_ONE_BY_ONE", 10**9)
        expected = roll(actions, width)
        patch.setattr(rerolling, "_ONE_BY_ONE", alone)
        found = roll(actions, width)
    assert [shown(action) for action in found] == [shown(action) for action in expected]


def shown(action):
    """What a statement is: the very one, or a loop with the signs of its zeros."""
    return (
        (id(action.first), action.count, repr(action.operands)) if isinstance(action, Rolled) else id(action)
    )
