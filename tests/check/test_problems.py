"""Every error of the analysis, with its number and its line."""

from __future__ import annotations

import pytest

from desire_tui.engine.check.checker import check
from desire_tui.engine.syntax.parse import parse
from tests.lowering.programs import source

SCRIPT = """
TMAX = 1 | DT = 0.01 | n = 4 | a = 2
ARRAY v[n], w[n], u3[3], A[n,n], B[3,n], F[7], D[10], M[n,n]
ARRAY FX[3], FY[n], buf[50]
STATE s[n]
INTEGER count
COMPLEX z, Z[2]
FUNCTION hyp(p$, q$) = sqrt(p$^2 + q$^2)
FUNCTION loop(p$) = 1 + loop(p$)
SUBMODEL osc(x$, y$)
d/dt x$ = y$
d/dt y$ = - x$ + nothing
end
SUBMODEL self(x$)
self(x$)
end
drun
DYNAMIC
"""
FIRST = SCRIPT.strip().count("\n") + 1


def found(body):
    program = parse(source(SCRIPT + body))
    assert not program.problems, [d.message for d in program.problems]
    problems = check(program)
    at = program.source.position
    for problem in problems:
        assert problem.message
        assert "…" not in problem.message, problem.message
    return [(d.code, at(d.span.start).row - FIRST) for d in problems]


CASES = [
    # names
    ("y = x1 + 1", [(200, 1)]),
    ("y = later\nlater = 1", [(200, 1)]),
    ("y = x1\nz1 = x1", [(200, 1)]),
    ("q = q + 1\nd/dt x = q", [(200, 1)]),  # how fast it counts depends on the rule
    ("q = sgn(q - x)\nd/dt x = q", []),
    ("d/dt x = ran() - x", [(489, 1)]),  # a warning: which rule it will be, the text does not tell
    ("e = gauss(0)\nd/dt x = e - x", [(489, 1)]),
    ("d/dt x = e - x\nstep\ne = ran()", [(200, 1)]),  # of e, which has no first value; the noise stands still
    ("y = q\nq = q + 1", [(200, 1)]),
    ("y = z", [(218, 1)]),
    ("y = Z[1]", [(218, 1)]),
    ("count = 3", [(218, 1)]),
    ("y = count", []),
    ("PI = 3", [(73, 1)]),
    ("hyp = 3", [(73, 1)]),
    # arrays as numbers
    ("y = v", [(69, 1)]),
    ("y = v[1,2]", [(69, 1)]),
    ("y = v[5]", [(2, 1)]),
    ("y = v[0]", [(2, 1)]),
    ("y = v[n]", []),
    ("y = v[3.9]", []),
    ("y = v[4.9]", [(2, 1)]),
    ("y = a[1]", [(19, 1)]),
    ("y = nowhere[1]", [(19, 1)]),
    ("y = v[unknown]", [(200, 1)]),
    ("y = sin[1]", [(19, 1)]),
    # functions
    ("y = sine(1)", [(59, 1)]),
    ("y = tim(0)", [(59, 1)]),
    ("y = Cabs(1)", [(59, 1)]),
    ("y = sin(1, 2)", [(56, 1)]),
    ("y = hyp(1)", [(56, 1)]),
    ("y = hyp(hyp(3, 4), 12)", []),
    ("y = func1(a; F)", [(32, 1)]),
    ("y = func1(a; D)", []),
    ("y = func1(a; 3)", [(36, 1)]),
    ("y = func1(a; a)", [(19, 1)]),
    ("y = func2(a, a; A, FX, FY)", [(74, 1)]),
    ("y = func2(a, a; B, FX, FY)", []),
    ("func y = D(a", []),
    # submodels
    ("nowhere(a)", [(201, 1)]),
    ("osc(a)", [(56, 1)]),
    ("osc(a, 1)", [(209, 1)]),
    ("sin(a)", [(219, 1)]),
    # vectors
    ("Vector v = w + u3", [(74, 1)]),
    ("Vector v = A*w + 1", []),
    ("Vector v = B*w", [(74, 1)]),
    ("Vector u3 = tanh(B*w)", []),
    ("Vector v = B%*u3", []),
    ("Vector v = B*u3", [(74, 1), (74, 1)]),
    ("Vector v = A", [(75, 1)]),
    ("Vector v = nowhere", [(70, 1)]),
    ("Vector nowhere = v", [(19, 1)]),
    ("Vector a = v", [(19, 1)]),
    ("Vector A = v", [(75, 1)]),
    ("Vector v = A*v", [(85, 1)]),
    ("Vector v = v{1}", [(85, 1)]),
    ("Vector v = v{-1}", []),
    ("Vectr d/dt s = A*s + s{1}", []),
    ("Vectr delta v = v{2}", [(85, 1)]),
    ("Vector v = A#", []),
    ("Vector v = v#", [(75, 1)]),
    ("Vector u3 = A#", [(74, 1)]),
    ("Vector v = [u3] w", [(74, 1)]),
    ("Vector v = Z", [(218, 1)]),
    ("y = A*w", [(69, 1), (69, 1)]),
    ("y = w{1}", [(75, 1)]),
    # matrices
    ("MATRIX A = v*w", []),
    ("MATRIX A = v*u3", [(74, 1)]),
    ("MATRIX A = v & w", []),
    ("MATRIX A = B", [(74, 1)]),
    ("MATRIX A = v", [(75, 1)]),
    ("MATRIX v = 1", [(75, 1)]),
    ("DELTA A = a*(M - A)*ran()*v*w; -1, 1", []),
    ("DELTA A = [B] M", [(74, 1)]),
    # DOT
    ("DOT y = v*w + v*1 - v*A*w + u3*B*w + v*B%*u3", []),
    ("DOT y = v*u3", [(74, 1)]),
    ("DOT y = v", [(75, 1)]),
    ("DOT y = v*2", [(75, 1)]),
    ("DOT y = a*v", [(19, 1)]),
    ("AVG y = v*1 + u3*1", [(74, 1)]),
    # derivatives
    ("d/dt x = 1\nd/dt x = 2", [(101, 2)]),
    ("if a\nd/dt x = 1\nelse\nd/dt x = 2\nend if", []),
    ("if a\nd/dt x = 1\nend if\nd/dt x = 2", [(101, 4)]),
    ("Vectr d/dt s = 1\nd/dt s[1] = 2", []),
    ("Vectr d/dt s = 1\nVectr d/dt s = 2", [(101, 2)]),
    # guards
    ("y = h\nOUT\nh = 1", [(200, 1)]),
    ("OUT\nh = 1\ny = h", []),
    ("if a\nh = 1\nend if\ny = h", [(200, 4)]),
    ("if a\nh = 1\nelse\nh = 2\nend if\ny = h", []),
    ("else", [(111, 1)]),
    ("SAMPLE 2\ny = 1\nSAMPLE 3", [(8, 3)]),
    ("SAMPLE 0", [(44, 1)]),
    # requests
    ("d/dt x = 1\ndispt x\ndispxy x, x", [(8, 3)]),
    ("d/dt x = 1\ndispt x\ntype x", []),
    ("dispt nothing", [(200, 1)]),
    ("dispt v", [(69, 1)]),
    ("dispt v[n], v[1]", []),
    ("dispt v[7]", [(2, 1)]),
    ("DISPXY a, n, TMAX", [(14, 1)]),
    ("dispxy a", [(14, 1)]),
    ("SHOW a, 2", [(112, 1)]),
    ("SHOW A, 2", []),
    ("stash a\nstash n", [(8, 2)]),
    # history
    ("store D = a", []),
    ("store A = a", [(75, 1)]),
    ("store nowhere = a", [(19, 1)]),
    ("get y = D\nd/dt x = y", []),
    ("d/dt x = y\nget y = D", [(200, 1)]),
    ("tdelay y = buf(a, 0.1", []),
    # others
    ("write a", [(219, 1)]),
    ("for i = 1 to 3", [(219, 1)]),
    ("y = x1 + x2\nVector v = u3\nterm x3", [(200, 1), (200, 1), (74, 2), (200, 3)]),
    # Jacobian
    ("d/dt x = a\nd/dt y = x\nJACOBIAN\nA[2,1] = 1", []),
    ("d/dt x = a\nd/dt y = x\nJACOBIAN\nA[3,1] = 1", [(230, 4)]),
    ("d/dt x = a\nJACOBIAN\nA[1,1] = 1\nM[1,1] = 2", [(230, 4)]),
    ("d/dt x = a\nJACOBIAN\nterm a", [(219, 3)]),
    ("Vectr d/dt s = 1\nd/dt x = 1\nJACOBIAN\nA[1,1] = 1", [(230, 4)]),
]  # fmt: skip


@pytest.mark.parametrize(("body", "expected"), CASES, ids=[c[0].replace("\n", "|") for c in CASES])
def test_problem(body, expected):
    assert found(body) == expected


def test_function_recursion_names_the_function_and_its_use():
    program = parse(source(SCRIPT + "y = loop(1)"))
    (problem,) = check(program)
    assert problem.code == 52
    assert "loop" in problem.message
    row = program.source.position(problem.related[0].span.start).row
    assert row == FIRST + 1


def test_a_submodels_line_names_the_invocation():
    program = parse(source(SCRIPT + "osc(x, y)\nosc(p, q)"))
    (problem,) = check(program)
    assert (problem.code, problem.facts["name"]) == (200, "nothing")
    at = program.source.position
    assert program.source.line(at(problem.span.start).row) == "d/dt y$ = - x$ + nothing"
    assert at(problem.related[0].span.start).row == FIRST + 1


def test_submodel_recursion():
    (problem,) = check(parse(source(SCRIPT + "self(a)")))
    assert problem.code == 52


def test_used_before_set_names_the_line_that_defines_it():
    program = parse(source(SCRIPT + "y = later\nx1 = 3\nlater = 1"))
    (problem,) = check(program)
    assert problem.facts["line"] == FIRST + 3


def test_a_name_assigned_after_the_first_drun_does_not_count():
    assert [d.code for d in check(parse(source("TMAX = 1\ndrun\nk = 1\nDYNAMIC\nd/dt x = k")))] == [200]
    assert not check(parse(source("TMAX = 1\nif TMAX > 2 then\nk = 1\nproceed\ndrun\nDYNAMIC\nd/dt x = k")))


def test_jumps_make_every_assignment_count():
    text = "TMAX = 1\ngo to set\nlabel run\ndrun\nSTOP\nlabel set\nk = 1\ngo to run\nDYNAMIC\nd/dt x = k"
    assert not check(parse(source(text)))


def test_unknown_sizes_are_tolerated():
    text = "input n\nARRAY v[n], w[3]\ndrun\nDYNAMIC\nVector v = w + v\ny = v[12]\nVector w = w{1}"
    assert [d.code for d in check(parse(source(text)))] == [85]


def test_a_broken_line_is_one_mistake():
    text = "ARRAY v[3\nk = = 2\ndrun\nDYNAMIC\nVector v = k\ny = v[1] + other"
    codes = [d.code for d in check(parse(source(text)))]
    assert codes.count(200) == 1
    assert 70 not in codes
    assert 19 not in codes


def test_a_misspelt_name_gets_a_hint():
    (problem,) = check(parse(source("velocity = 1\ndrun\nDYNAMIC\nd/dt x = velocty")))
    assert "velocity" in problem.hint


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        ("x = y + 1", [(200, "y")]),
        ("x = x + 1\nwrite x", []),
        ("x = sine(1)", [(200, "sine")]),
        ("FUNCTION f(a$) = a$*q\nx = f(1)", [(200, "q")]),
        ("v[1] = 2", [(19, "v")]),
        ("for i = 1 to n | write i | next", [(200, "n")]),
        ("PROCEDURE p(a; B)\nB[1] = a\nend\nARRAY v[3]\ncall p(1; v)", []),
        ("COMPLEX z\nz = 1 + 2*j\nwrite Re(z), PI, TMAX", []),
        ("STOP\nwrite q", []),
        ("read a | data 3 | write a", []),
        ("write total\nNN = 3\ndrun\nDYNAMIC\ntotal = total + 1", []),
        ("MATRIX A = $In(A)", [(200, "A")]),
        ("x = 1\nd/dt x = 2\nOUT\ntype q", [(300, None), (300, None), (300, None)]),
    ],
)
def test_names_of_the_script(script, expected):
    problems = check(parse(source(script)))
    assert [(d.code, d.facts.get("name")) for d in problems] == expected
