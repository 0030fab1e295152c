"""Expressions kept from earlier programs: whatever was lowered before, a program becomes the same."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from desire_tui.engine.check.checker import check
from desire_tui.engine.check.state_order import state_order
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.lowering import lowering_cache
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import Values
from tests.lowering.programs import segment

LINES = (
    "d/dt x = a*(y - x)", "d/dt y = -b*y + sin(x)", "u = a*x", "u = u + 1", "v = u*u - f(x)", "w = v + u", "if x - 1",
    "else", "end if", "OUT", "step", "u = ran()", "a = a + 1", "v = c[2]*x", "w = func1(x; c)", "term y - u", "v = c",
)  # fmt: skip
SCRIPTS = ("", "FUNCTION f(p$) = a*p$ - x\n", "FUNCTION f(p$) = b*p$\n", "FUNCTION sin(p$) = p$\n")
NAMES = st.permutations(["a", "b", "c", "u", "v"]).flatmap(
    lambda names: st.integers(0, len(names)).map(lambda count: names[:count])
)


def outcome(text: str, names: list[str], arrays: set[str]):
    program = parse(Source(text))
    values = Values()
    for name in names:
        if name in arrays:
            values.array(name, (4,))
        else:
            values.assign(values.scalar(name).slot, 1.0)
    for name in state_order(program):
        if name not in values.names or not values.names[name].shape:
            values.scalar(name, is_state=True)
    problems = tuple((p.key, p.span) for p in check(program))
    try:
        return lower(program, None, values), problems
    except DesireError as error:
        return [(p.key, p.span, p.facts) for p in error.diagnostics], problems


@given(
    lines=st.lists(st.sampled_from(LINES), min_size=1, max_size=12),
    script=st.sampled_from(SCRIPTS),
    names=NAMES,
    arrays=st.sets(st.sampled_from(["c", "a"])),
)
def test_the_stores_change_nothing(lines, script, names, arrays):
    """They are warm from all earlier examples; then once more, empty."""
    text = f"{script}DYNAMIC\n" + "\n".join(lines) + "\n"
    warm = outcome(text, names, arrays)
    lowering_cache.forget()
    assert outcome(text, names, arrays) == warm


def test_an_edit_leaves_the_other_lines_values_alone():
    body = "d/dt x = a*(y - x)\nd/dt y = {}*x - y\nd/dt z = x*y - a*z"
    before, _ = segment(body.format(2), a=1)
    after, _ = segment(body.format(3), a=1)
    assert before.body[2].value is after.body[2].value
    assert before.body[1].value is not after.body[1].value


def test_a_name_in_another_slot_is_read_there():
    body = "d/dt x = a*x\nd/dt y = a*y"
    first, values = segment(body, a=1)
    moved, others = segment(body, q=1, a=1)
    assert values.find("a").slot != others.find("a").slot
    assert first.body[1].value.args[0].slot == values.find("a").slot
    assert moved.body[1].value.args[0].slot == others.find("a").slot


def test_a_function_with_a_library_functions_name_counts():
    body = "d/dt x = sin(x)"
    library, _ = segment(body)
    own, _ = segment(body, functions="FUNCTION sin(p$) = p$ + p$")
    again, _ = segment(body)
    assert [s.body[0].value.name for s in (library, own, again)] == ["sin", "add", "sin"]


def test_functions_are_expanded_as_they_are_now():
    body = "d/dt x = f(x)"
    sums, _ = segment(body, functions="FUNCTION f(p$) = p$ + p$")
    products, _ = segment(body, functions="FUNCTION f(p$) = p$*p$")
    assert [s.body[0].value.name for s in (sums, products)] == ["add", "mul"]


def test_an_array_elements_place_is_found_anew():
    body = "d/dt x = c[k]*x"
    first, values = segment(body, c=(4,), k=1)
    second, _ = segment(body, c=(4,), k=3)
    start = values.find("c").slot
    assert [s.body[0].value.args[0].slot - start for s in (first, second)] == [0, 2]
