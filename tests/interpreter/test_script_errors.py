"""Users' mistakes: the error's number and the exact piece of text it points at."""

from __future__ import annotations

import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.diagnostics.wording.script import MESSAGES
from tests.interpreter.stand_in import RecordingHost, error_of, run


@pytest.mark.parametrize(
    ("script", "code", "piece"),
    [
        ("y = 2 + 1/(3 - 3)*4", 5, "(3 - 3)"),
        ("x = 0\ny = 5*(1 + 2/x)", 5, "x"),
        ("x = 0 | y = x^-2", 5, "x^-2"),
        ("y = 1 + ln(0)", 9, "ln(0)"),
        ("y = log(-1) + 2", 9, "log(-1)"),
        ("y = 2*sqrt(-4)", 47, "sqrt(-4)"),
        ("y = 3 + (-8)^0.5", 9, "(-8)^0.5"),
        ("x = -8 | k = 3 | y = 2 + x^k", 9, "x^k"),
        ("ARRAY v[2], w[2] | v[1] = -8 | k = 3\nVector w = 2 + v^k", 9, "v^k"),
        ("ARRAY v[2], w[2] | k = -1\nVector w = 1 + v^k", 9, "v^k"),
        ("y = exp(1000)", 3, "exp(1000)"),
        ("y = 1E300*1E300", 3, "1E300*1E300"),
        ("x = 1E300 | y = 1/(x*x)", 3, "(x*x)"),
        ("x = 1E300 | y = atan(x*x)", 3, "x*x"),
        ("x = 1E300 | y = 2 - (x*x)^-2", 3, "(x*x)"),
        ("x = 1E300 | if 2*x*x > 0 then | y = 1 | proceed", 3, "2*x*x"),
        ("x = 1E300 | write x*x", 3, "x*x"),
        ("FUNCTION f(a) = a*a\nx = 1E300 | y = 1/f(x)", 3, "f(x)"),
        ("ARRAY v[2] | x = 1E300 | Vector v = x\nDOT s = v*v", 3, "s"),
        ("ARRAY v[2] | x = 1E300 | Vector v = x\nVector v = atan(v*v)", 3, "atan(v*v)"),
        ("FUNCTION f(a) = 2*a\nARRAY v[2]\nVector v = f(v, v)", 56, "f(v, v)"),
        ("FUNCTION f(a, b) = a*b\nARRAY v[2], w[3]\nVector v = f(v, w)", 74, "f(v, w)"),
        ("FUNCTION f(a) = 1/a\nARRAY v[2]\nVector v = f(v)", 5, "a"),
        ("y = asin(2)", 44, "asin(2)"),
        ("x = 1 | y = x + nosuch", 200, "nosuch"),
        ("y = nosuch(3)", 200, "nosuch(3)"),
        ("y = sin + 2", 200, "sin"),
        ("y = sin(1, 2)", 44, "sin(1, 2)"),
        ("call nobody()", 201, "call nobody()"),
        ("ARRAY A[3,2] | k = 3\nA[k, k] = 5", 2, "k"),
        ("ARRAY x[3]\ny = x[0]", 2, "0"),
        ("ARRAY x[3]\ny = x[3.5]", 2, "3.5"),
        ("ARRAY x[3]\ny = x[1,2]", 53, "x[1,2]"),
        ("ARRAY x[3]\ny = 2*x", 53, "x"),
        ("ARRAY x[3]\nx = 2", 53, "x"),
        ("x = 1\ny = x[1]", 19, "x[1]"),
        ("ARRAY x[3] | ARRAY x[4]", 28, "x[4]"),
        ("x = 1 | ARRAY x[4]", 73, "x[4]"),
        ("ARRAY TMAX[4]", 73, "TMAX[4]"),
        ("FUNCTION f(a) = a\nf = 3", 73, "f"),
        ("FUNCTION f(a) = a\ny = f(1, 2)", 56, "f(1, 2)"),
        ("FUNCTION f(a) = g(a)\nFUNCTION g(a) = f(a)\ny = f(1)", 52, "f(a)"),
        ("FUNCTION f(a) = 1/a\nx = 2 | y = f(x - 2)", 5, "a"),
        ("FUNCTION f(a) = a + nosuch\ny = f(1)", 200, "nosuch"),
        ("PROCEDURE p()\ncall p()\nend\ncall p()", 52, "call p()"),
        ("PROCEDURE p(a;b)\nend\ncall p(1)", 56, "call p(1)"),
        ("PROCEDURE p(;b)\nend\ncall p(;1 + 2)", 56, "1 + 2"),
        ("PI = 3", 55, "PI"),
        ("ARRAY x[0]", 32, "0"),
        ("ARRAY x[1,1,1,1,1,1,1,1,1,1,1]", 32, "x[1,1,1,1,1,1,1,1,1,1,1]"),
        ("for k = 1 to 5 step 0\nnext", 23, "0"),
        ("COMPLEX z\nfor z = 1 to 2\nnext", 48, "z"),
        ("COMPLEX z\nx = 2*z", 84, "2*z"),
        ("COMPLEX z\nz = z^0.5", 75, "z^0.5"),
        ("COMPLEX z\nx = sin(z)", 84, "z"),
        ("COMPLEX z\nif z < 2 then | x = 1 | proceed", 84, "z < 2"),
        ("INTEGER i\ni = 1E20", 20, "1E20"),
        ("read x", 51, "read x"),
        ("data 1, 2/0\nread x, y", 5, "0"),
        ("data 1, nosuch\nread x, y", 200, "nosuch"),
        ("irule 6", 86, "6"),
        ("irule 18", 86, "18"),
        ("ARRAY A[2,2]\nMATRIX A = $In(A)", 123, "$In(A)"),
        ("ARRAY A[3,3]\ndata 1,2,3,4,5,6,7,8,9\nread A\nMATRIX A = $In(A)", 123, "$In(A)"),
        ("ARRAY A[2,3]\nMATRIX A = $In(A)", 74, "$In(A)"),
        ("ARRAY A[2,3], B[2,3]\nMATRIX A = A*B", 74, "A*B"),
        ("ARRAY A[2,3], b[2]\nVector b = A*b", 74, "A*b"),
        ("ARRAY u[2], v[3]\nDOT s = u*v", 74, "u*v"),
        ("ARRAY A[2,2]\nMATRIX A = 5", 75, "5"),
        ("ARRAY x[8], y[4]\nFFT F, 8, x, y", 61, "y"),
        ("ARRAY x[8], y[8]\nFFT F, 1, x, y", 72, "1"),
        ("ARRAY A[8,8], y[8]\nFFT F, 8, A, y", 61, "A"),
        ("ARRAY F[3]\ny = func1(1; F)", 44, "F"),
        ("ARRAY A[4]\nSHOW A, 9", 112, "SHOW A, 9"),
        ("write $(-5)", 44, None),
        ("store X = x", 300, "store X = x"),
        ("OUT", 300, "OUT"),
    ],
)
def test_error(script, code, piece):
    found = error_of(script)
    assert found == (code, piece) if piece else found[0] == code


def test_statements_that_would_fill_the_memory_are_refused():
    """Arrays of a fifth of the room each can be declared, but neither transformed nor computed with."""
    n = RecordingHost().values.spare // 5
    declared = f"ARRAY x[{n}], y[{n}], z[{n}]\n"
    assert error_of(f"{declared}FFT F, {n}, x, y") == (40, str(n))
    assert error_of(f"{declared}Vector z = x") == (40, "Vector z = x")


def test_a_huge_array_is_refused():
    assert error_of("ARRAY x[1E+12]") == (40, "x[1E+12]")
    assert error_of("ARRAY x[1E6,1E6]")[0] == 40


def test_misspelt_names_get_a_suggestion():
    for script, close in [("velocity = 1 | y = velocty", "velocity"), ("y = sqr(2)", "sqrt")]:
        with pytest.raises(DesireError) as caught:
            run(script)
        assert caught.value.diagnostics[0].hint == f"did you mean '{close}'?"


def test_a_misspelt_command_gets_a_suggestion():
    with pytest.raises(DesireError) as caught:
        RecordingHost().execute("snapsho")
    assert caught.value.diagnostics[0].hint == "did you mean 'snapshot'?"


def test_problems_of_the_host_get_a_place():
    host = RecordingHost()

    def permit(path, mode):
        from desire_tui.engine.diagnostics import Diagnostic

        raise DesireError(Diagnostic("channel-number", facts={"channel": 1}))

    host.permit = permit
    with pytest.raises(DesireError) as caught:
        host.run("x = 1\nconnect 'f' as input 3")
    problem = caught.value.diagnostics[0]
    assert problem.source.text[slice(*problem.span)] == "connect 'f' as input 3"


def test_messages_are_plain_sentences():
    for key, wording in MESSAGES.items():
        assert not wording.message.endswith("."), key
        assert "Python" not in wording.message, key


def test_errors_in_bodies_name_the_statements_that_led_there():
    text = "FUNCTION f(a) = 1/a\nPROCEDURE p(x; r)\nr = f(x)\nend\nPROCEDURE q(;r)\ncall p(0; r)\nend\ncall q(;y)"
    with pytest.raises(DesireError) as caught:
        run(text)
    problem = caught.value.diagnostics[0]
    assert (problem.code, text[slice(*problem.span)]) == (5, "a")
    assert [text[slice(*p.span)] for p in problem.related] == ["r = f(x)", "call p(0; r)", "call q(;y)"]
