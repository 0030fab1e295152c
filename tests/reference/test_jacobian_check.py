"""JACOBIAN segments compared with the model before a run: warning 462 of `desire check`."""

from __future__ import annotations

import pytest

from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

LOTKA = """{script}
ARRAY J[2,2]
a = 2 | x = 1 | y = 0.5
irule 14 | ERMAX = 1E-6 | TMAX = 1 | DT = 0.01
drun
DYNAMIC
d/dt x = a*x - x*y
d/dt y = x*y - 3*y
dispt x
JACOBIAN
J[1,1] = a - y | J[1,2] = {element}
J[2,1] = y | J[2,2] = x - 3
"""


def warnings(text, folder=None):
    """Return (line, row, column) of all warnings 462; nothing else may be reported."""
    source = Source(text, "test.src")
    found = Session(folder=folder).check(source)
    assert all((p.code, p.severity) == (462, "warning") for p in found), [p.message for p in found]
    return [(source.position(p.span[0]).row, p.facts["row"], p.facts["column"]) for p in found]


def lotka(element="-x", script=""):
    return LOTKA.format(element=element, script=script)


def test_a_right_one_and_a_wrong_one():
    assert warnings(lotka()) == []
    assert warnings(lotka("x")) == [(11, 1, 2)]


def test_both_numbers_are_told_at_the_start_of_the_run():
    (problem,) = Session().check(Source(lotka("x + 1"), "test.src"))
    assert (problem.facts["given"], problem.facts["exact"]) == (2.0, -1.0)
    assert "t = 0, x = 1, y = 0.5" in problem.message


def test_an_element_that_is_left_out_is_told_at_the_states_line():
    assert warnings(lotka().replace("| J[2,2] = x - 3", "")) == [(8, 2, 2)]


def test_an_element_assigned_twice_has_the_last_value():
    assert warnings(lotka() + "J[1,2] = 5*x\n") == [(13, 1, 2)]
    assert warnings(lotka("5*x") + "J[1,2] = -x\n") == []


def test_constants_rounded_to_four_digits_are_right():
    third = lotka().replace("-3*y", "-y/3").replace("- 3*y", "- y/3")
    assert warnings(third.replace("J[2,2] = x - 3", "J[2,2] = x - 0.3333")) == []
    assert warnings(third.replace("J[2,2] = x - 3", "J[2,2] = x - 0.33")) != []


def test_parameters_are_what_the_script_makes_of_them():
    """The JACOBIAN may use that b is a·a, which the text of the segment does not say."""
    script = "b = 1\nfor i = 1 to 3\nb = {factor}*b\nnext\nARRAY p[2]\ndata 2, {p2}\nread p"
    model = lotka("-x + (b - 8)", script).replace("= a*x", "= p[2]*x").replace("= a - y", "= b - y")
    assert warnings(model.format(factor=2, p2=8)) == []
    wrong = warnings(model.format(factor=2, p2=9)), warnings(model.format(factor=3, p2=8))
    assert [[w[1:] for w in found] for found in wrong] == [[(1, 1)], [(1, 1), (1, 2)]]


@pytest.mark.parametrize(
    "script",
    [
        "input q",  # nobody answers
        "connect 'nothere' as input 3",
        "while 1 > 0 | n = n + 1 | end while",  # left after a while
        "z = 1/0",
        "A = 1 | ARRAY B[100000,100000]",  # not for a check while typing
    ],
)
def test_a_script_that_cannot_be_followed_says_nothing(script):
    assert warnings(lotka("x", script)) == []


def test_a_script_is_followed_through_runs_stops_graphs_and_output():
    script = "display N15 | plot 0.5, 0.5 | write 'text' | STOP\nwrite x | sh touch made | note 'n'\ndrun one"
    text = lotka("x", "x = 0 | TMAX = 1 | DT = 0.1 | " + script) + "label one\nd/dt x = -x\ndispt x\n"
    assert [w[1:] for w in warnings(text)] == [(1, 2)]


def test_nothing_happens_in_the_world(tmp_path, capfd):
    script = (
        "sh touch shell\nconnect 'made.dat' as output 3\nwrite #3, 1\ndisconnect 3\nnotebook 'book.md'\n"
        "write 'to the screen'\nsnapshot 'graph.png'"
    )
    assert [w[1:] for w in warnings(lotka("x", script), tmp_path)] == [(1, 2)]
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr() == ("", "")


def test_the_session_stays_as_it_is():
    session = Session()
    session.execute("x = 7 | J = 8")
    session.check(Source(lotka("x"), "test.src"))
    assert session.values.cells[session.values.find("x").slot] == 7
    assert session.values.find("y") is None
    assert session.runs == []
    assert session.program is None


def test_a_quick_check_leaves_it_out_and_a_full_one_still_comes():
    session, source = Session(), Source(lotka("x"), "test.src")
    assert session.check(source, quick=True) == ()
    assert len(session.check(source)) == 1
    assert len(session.check(source, quick=True)) == 1  # known by now


KINKED = "ARRAY J[1,1] | TMAX = 1 | DT = 0.01 | x = {x}\ndrun\nDYNAMIC\nd/dt x = {f}\ndispt x\nJACOBIAN\nJ[1,1] = {j}\n"


@pytest.mark.parametrize(
    ("formula", "derivative", "steep"),
    [
        ("sqrt(x) - x", "0.5/sqrt(x) - 1", 1),  # no number at half of the places
        ("-abs(x)", "-sgn(x)", 0),
        ("-ln(x)", "-1/x", 1),
        ("-sat(4*x)", "-4*rect(4*x)", 0),
        ("-exp(40*x)", "-40*exp(40*x)", 1),
        ("1 - max(x, 0.5)", "-swtch(x - 0.5)", 1),
    ],
)
def test_kinks_and_domains_raise_no_alarm(formula, derivative, steep):
    for x in (0, 0.25, 0.5, 1):
        assert warnings(KINKED.format(x=x, f=formula, j=derivative)) == []
    assert warnings(KINKED.format(x=steep, f=formula, j=f"1.1*({derivative})")) == [(7, 1, 1)]


def test_models_that_cannot_be_differentiated_say_nothing():
    noisy = lotka("x").replace("d/dt x = a*x", "d/dt x = ran()*x")
    assert [p.code for p in Session().check(Source(noisy, "test.src"))] == [489]


def test_vectors_and_submodels():
    text = """ARRAY J[4,4] | STATE u[3]
SUBMODEL decay(s$, r$) | d/dt s$ = -r$*s$*s$ | end
STATE s | r = 3 | s = 1 | u[1] = 1 | c = 100
TMAX = 1 | DT = 0.001
drun
DYNAMIC
Vectr d/dt u = c*(u{1} - 2*u + u{-1})
invoke decay(s, r)
dispt s
JACOBIAN
J[1,1] = -2*c | J[1,2] = c
J[2,1] = c | J[2,2] = -2*c | J[2,3] = c
J[3,2] = c | J[3,3] = -2*c
J[4,4] = -2*r*s
"""
    assert warnings(text) == []
    assert warnings(text.replace("J[2,3] = c", "J[3,1] = c")) == [(7, 2, 3), (12, 3, 1)]


def test_a_matrix_too_large_to_compare_is_left_alone():
    n = 60
    rows = "\n".join(f"J[{i},{k}] = 7" for i in range(1, n + 1) for k in range(1, n + 1))
    text = f"ARRAY J[{n},{n}] | STATE u[{n}] | TMAX = 1\ndrun\nDYNAMIC\nVectr d/dt u = -u\ndispt u[1]\nJACOBIAN\n{rows}\n"
    assert warnings(text) == []
