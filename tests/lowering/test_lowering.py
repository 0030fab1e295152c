"""What a segment becomes: states in order, persistence, guards, expansion."""

from __future__ import annotations

import pytest

from desire_tui.engine.check.state_order import state_order
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.lowered.expressions import Const, Load, MatVec, Op, Outer, Vec
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetVec
from desire_tui.engine.lowered.walk import walk_actions
from desire_tui.engine.syntax.parse import parse
from tests.lowering.programs import segment, source


def assigned(lowered, values, name):
    slot = values.find(name).slot
    (found,) = [a for a in walk_actions(lowered.body) if isinstance(a, Set) and a.slot == slot]
    return found


def test_states_are_numbered_in_the_order_of_their_lines():
    lowered, values = segment("d/dt y = x\nVectr d/dt s = v\nd/dt x = -y", s=(3,), v=(3,))
    assert [(r.name, r.first, r.count) for r in lowered.states] == [("y", 0, 1), ("s", 1, 3), ("x", 4, 1)]
    assert lowered.order == 5
    kinds = [(type(a), a.state) for a in lowered.body]
    assert kinds == [(Deriv, 0), (DerivVec, 1), (Deriv, 4)]
    assert values.find("s").is_state


def test_an_element_of_a_vector_state_is_that_vectors_state():
    lowered, _ = segment("d/dt s[3] = 1\nVectr d/dt s = 2\nd/dt s[1] = 3", s=(4,))
    assert [(r.name, r.first, r.count) for r in lowered.states] == [("s", 0, 4)]
    assert [a.state for a in lowered.body] == [2, 0, 0]


def test_single_elements_are_states_of_their_own():
    lowered, values = segment("d/dt s[2] = s[1]\nd/dt s[1] = -s[2]", s=(2,))
    first = values.find("s").slot
    assert [(r.name, r.slot) for r in lowered.states] == [("s[2]", first + 1), ("s[1]", first)]


def test_state_order_follows_submodels():
    text = "SUBMODEL osc(p$, q$)\nd/dt p$ = q$\nd/dt q$ = -p$\nend\nDYNAMIC\nd/dt z = 1\nosc(x, y)\nosc(u, v)"
    assert state_order(parse(source(text))) == ("z", "x", "y", "u", "v")


def test_defined_variables_are_not_persistent():
    lowered, values = segment("y = a*x\nd/dt x = y", a=1)
    assert not assigned(lowered, values, "y").persistent


@pytest.mark.parametrize(
    "body",
    [
        "p = p + 1\nd/dt x = p",
        "d/dt x = p\np = x",
        "d/dt x = p\nOUT\np = x",
        "if x\np = 1\nend if\nd/dt x = p",
    ],
)
def test_what_is_read_before_it_is_set_is_persistent(body):
    lowered, values = segment(body, p=1)
    assert assigned(lowered, values, "p").persistent


def test_both_branches_set_it():
    body = "if x\np = 1\nelse\np = 2\nend if\nd/dt x = p"
    lowered, _ = segment(body)
    assert not any(a.persistent for a in walk_actions(lowered.body) if isinstance(a, Set))


def test_vectors_persist_too():
    lowered, _ = segment("Vector v = w\nVector u = v{-1} + u\nVectr delta w = v", u=(3,), v=(3,), w=(3,))
    assert [a.persistent for a in lowered.body] == [False, True, True]


def test_elements_and_whole_vectors_are_the_same_numbers():
    lowered, _ = segment("y = v[2]\nVector v = 3\nz = v[1]", v=(3,))
    assert [a.persistent for a in lowered.body] == [False, True, False]
    lowered, _ = segment("Vector v = 3\ny = v[2]", v=(3,))
    assert [a.persistent for a in lowered.body] == [False, False]


def test_step_and_out_rule_the_rest():
    lowered, _ = segment("d/dt x = 1\nOUT\ny = x\nstep\nz = x\nterm z - 1")
    (deriv, out) = lowered.body
    assert isinstance(out, Guard)
    assert out.kind == "out"
    assert isinstance(out.body[1], Guard)
    assert out.body[1].kind == "step"
    assert len(out.body[1].body) == 2
    assert isinstance(deriv, Deriv)


def test_out_goes_on_behind_an_end_if():
    lowered, _ = segment("if a\nOUT\ny = 1\nend if\nz = 2\nw = z", a=1)
    condition, out = lowered.body
    assert condition.kind == "if"
    assert condition.body[0].kind == "out"
    assert out.kind == "out"
    assert len(out.body) == 2


def test_else_turns_an_if():
    lowered, _ = segment("if a\ny = 1\nelse\ny = 2\nend if", a=1)
    (guard,) = lowered.body
    assert (len(guard.body), len(guard.orelse)) == (1, 1)


def test_a_guarded_derivative_keeps_its_value():
    lowered, _ = segment("d/dt y = 1\nstep\nd/dt x = 2*y")
    first, guard, last = lowered.body
    (held,) = guard.body
    assert held.persistent
    assert last == Deriv(1, Load(held.slot), last.where)
    assert first.state == 0


def test_sample_is_truncated_but_not_by_rounding_errors():
    for text, every in (("13.98", 13), ("14", 14), ("0.7/0.1", 7), ("TS*20", 3)):
        lowered, _ = segment(f"SAMPLE {text}\ny = 1", TS=0.15)
        assert lowered.body[0].every == every


def test_a_functions_argument_is_one_object():
    lowered, values = segment("y = sq(x + 1)", functions="FUNCTION sq(p$) = p$*p$", x=1)
    product = assigned(lowered, values, "y").value
    assert product.args[0] is product.args[1]
    assert product.args[0] == Op("add", (Load(values.find("x").slot), Const(1.0)))


def test_functions_see_the_programs_names_and_shadow_them_with_dummies():
    lowered, values = segment("y = f(b)", functions="FUNCTION f(a) = a + c", a=1, b=2, c=3)
    a, c = assigned(lowered, values, "y").value.args
    assert (a.slot, c.slot) == (values.find("b").slot, values.find("c").slot)


def test_a_program_function_wins_over_max():
    lowered, values = segment("y = max(1, 2)", functions="FUNCTION max(a$, b$) = a$ - b$")
    assert assigned(lowered, values, "y").value.name == "sub"


def test_submodels_are_expanded_with_their_place():
    text = "SUBMODEL half(x$, y$)\ny$ = x$/2\nend"
    lowered, values = segment("x = 3\nhalf(x, p)\nhalf(p, q)", functions=text)
    p, q = assigned(lowered, values, "p"), assigned(lowered, values, "q")
    assert p.where.span == q.where.span
    assert lowered.source.text[slice(*p.where.span)] == "y$ = x$/2"
    assert lowered.source.text[slice(*q.where.invoked_at)] == "half(p, q)"


def test_nested_submodels_name_the_outer_invocation():
    text = "SUBMODEL in(x$)\nx$ = 1\nend\nSUBMODEL out(y$)\nin(y$)\nend"
    lowered, values = segment("out(p)", functions=text)
    assert lowered.source.text[slice(*assigned(lowered, values, "p").where.invoked_at)] == "out(p)"


def test_a_submodel_takes_arrays_of_any_size():
    text = "SUBMODEL norm(v$, w$)\nDOT sum = v$*1\nVector w$ = v$/sum\nend"
    lowered, _ = segment("norm(a, b)\nnorm(c, d)", functions=text, a=(4,), b=(4,), c=(7,), d=(7,))
    assert [a.count for a in lowered.body if isinstance(a, SetVec)] == [4, 7]


def test_products_of_matrix_and_vector():
    lowered, values = segment("Vector y = 2*A*x*y + tanh(B%*z)", A=(3, 3), x=(3,), y=(3,), B=(2, 3), z=(2,))
    slot = {n: values.find(n).slot for n in "AxyBz"}
    total = lowered.body[0].value
    left, right = total.args
    assert left == Op(
        "mul", (Op("mul", (Const(2.0), MatVec(slot["A"], 3, 3, False, slot["x"]))), Vec(slot["y"], 3))
    )
    assert right == Op("tanh", (MatVec(slot["B"], 2, 3, True, slot["z"]),))


def test_outer_products():
    lowered, values = segment("DELTA W = a*u*v - W; -1, 1", a=2, W=(2, 3), u=(2,), v=(3,))
    (made,) = lowered.body
    slot = {n: values.find(n).slot for n in "Wuv"}
    outer = Outer("mul", slot["u"], 2, slot["v"], 3)
    assert made.value == Op("sub", (Op("mul", (Load(values.find("a").slot), outer)), Vec(slot["W"], 6)))
    assert (made.mode, made.lower, made.upper) == ("add", Const(-1.0), Const(1.0))


def test_powers():
    lowered, values = segment("y = x^2 + x^-3 + x^0.5 + x^a", x=2, a=2)
    names = []
    value = assigned(lowered, values, "y").value
    while value.name == "add":
        names.append(value.args[1].name)
        value = value.args[0]
    assert [*names, value.name] == ["pow", "pow", "ipow", "ipow"]


def test_columns_show_worked_out_subscripts():
    lowered, values = segment("Vector v = 1\ndispt v[n], v[1]\ntype v[2]", v=(3,), n=3)
    assert [c.name for c in lowered.columns] == ["v[3]", "v[1]", "v[2]"]
    assert lowered.columns[0].slot == values.find("v").slot + 2


def test_everything_wrong_is_raised_at_once():
    with pytest.raises(DesireError) as caught:
        segment("y = p\nVector v = w\nz = v[9]", v=(3,), w=(2,))
    assert [d.code for d in caught.value.diagnostics] == [200, 74, 2]


def test_actual_sizes_decide():
    with pytest.raises(DesireError):
        segment("Vector v = w", v=(3,), w=(4,))
    segment("Vector v = w", v=(4,), w=(4,))


def test_a_missing_segment():
    program_text = "x = 1"
    from desire_tui.engine.lowering.lowering import lower
    from desire_tui.engine.values import Values

    with pytest.raises(DesireError) as caught:
        lower(parse(source(program_text)), None, Values())
    assert caught.value.diagnostics[0].code == 215


def test_shared_arguments_cost_nothing_and_explosions_are_refused():
    from desire_tui.engine.passes.slices import derivative_slice

    text = "FUNCTION sq(p$) = p$*p$ + 1"
    nested = "sq(" * 40 + "x" + ")" * 40
    lowered, _ = segment(f"y = {nested}\nd/dt x = y", functions=text, x=0.1)
    assert len(derivative_slice(lowered)) == 2  # 2^40 visits would take years
    chain = "\n".join(
        ["FUNCTION f0(p$) = p$"] + [f"FUNCTION f{i}(p$) = f{i - 1}(p$) + f{i - 1}(2)" for i in range(1, 31)]
    )
    with pytest.raises(DesireError) as caught:
        segment("y = f30(1)", functions=chain)
    assert [d.code for d in caught.value.diagnostics] == [410]


def test_functions_must_not_make_expressions_too_deep():
    body = "-(1 + " * 45 + "p$" + ")" * 45
    for nested in ("f(f(f(x)))", "f(" * 80 + "x" + ")" * 80):
        with pytest.raises(DesireError) as caught:
            segment(f"y = {nested}", functions=f"FUNCTION f(p$) = {body}", x=1)
        assert {d.code for d in caught.value.diagnostics} == {401}
    segment("y = f(x) + f(1)", functions=f"FUNCTION f(p$) = {body}", x=1)
