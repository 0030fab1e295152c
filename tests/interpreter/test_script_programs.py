"""Whole scripts with known results: chapter 5's checks, models.md 5, 6.2, 8.3, 8.4."""

from __future__ import annotations

from fractions import Fraction
from math import gcd, pi

import numpy as np
import pytest

from tests.interpreter.stand_in import run


def test_label_and_go_to_sum_to_55():
    assert (
        run("s = 0 | i = 0\nlabel AGAIN\ni = i + 1 | s = s + i\nif i < 10 then | go to AGAIN | proceed")["s"]
        == 55
    )


def test_go_to_a_line_number():
    host = run("10 s = 0\n20 s = s + 1\n30 if s < 7 then | go to 20 | proceed")
    assert host["s"] == 7


def test_for_loop_of_squares_leaves_the_last_value():
    host = run("s = 0\nfor k = 1 to 5\ns = s + k^2\nnext")
    assert (host["s"], host["k"]) == (55, 5)


@pytest.mark.parametrize(
    ("head", "passes", "last"),
    [
        ("for x = 0 to 1 step 0.1", 11, 1.0),
        ("for x = 1 to 2.2 step 0.2", 7, 2.2),
        ("for x = 5 to 1 step -2", 3, 1.0),
        ("for x = 1 to 0", 0, 1.0),
        ("for x = 2 to 2", 1, 2.0),
        ("for x = 0.5 to 3", 3, 2.5),
    ],
)
def test_for_counts_passes_with_a_tolerance(head, passes, last):
    host = run(f"x = 7 | n = 0\n{head}\nn = n + 1\nnext")
    assert host["n"] == passes
    assert host["x"] == pytest.approx(last, abs=1e-12)


def test_for_bounds_are_evaluated_once():
    host = run("n = 3 | k = 0\nfor i = 1 to n\nn = n + 10 | k = k + 1\nnext")
    assert host["k"] == 3


def test_while_finds_a_greatest_common_divisor():
    host = run("a = 1071 | b = 462\nwhile b > 0\nr = a - b*trnc(a/b) | a = b | b = r\nend while")
    assert host["a"] == gcd(1071, 462) == 21


def test_repeat_counts_collatz_steps():
    host = run(
        "n = 27 | k = 0\nrepeat\nif n/2 = trnc(n/2) then\nn = n/2\nelse\nn = 3*n + 1\nproceed\nk = k + 1\nuntil n = 1"
    )
    assert host["k"] == 111


@pytest.mark.parametrize(("a", "b", "c"), [(2, 3, 1), (2, 1, 2), (0, 3, 3), (0, 0, 4)])
def test_nested_ifs_with_and_and_or(a, b, c):
    host = run(
        f"a = {a} | b = {b}\n"
        "if a > 0 and b > a then | c = 1\nelse\n"
        "if a > 0 or b = 3 then\nif a > 0 then | c = 2 | else c = 3 | proceed\nelse | c = 4 | proceed\n"
        "proceed"
    )
    assert host["c"] == c


def test_conditions_nest_with_parentheses_and_not():
    host = run("a = 1 | b = 2 | c = 0\nif not (a = 2 or (b < 1 and a = 1)) and b <> 3 then | c = 1 | proceed")
    assert host["c"] == 1


def test_exit_leaves_the_innermost_loop_only():
    host = run(
        "k = 0\nfor i = 1 to 3\nfor j = 1 to 10\nif j > i then | exit | proceed\nk = k + 1\nnext\nnext"
    )
    assert host["k"] == 1 + 2 + 3


QUAD = """
PROCEDURE quad(a, b, c; r, s)
  D = b*b - 4*a*c
  if D < 0 then | exit | proceed
  r = (-b + sqrt(D))/(2*a) | s = (-b - sqrt(D))/(2*a)
end
"""


def test_procedure_by_value_and_by_reference_with_early_return():
    host = run(QUAD + "a = 99 | u = 5\ncall quad(1, -3, 2; x, y)\ncall quad(1, 0, 1; u, v)")
    assert (host["x"], host["y"]) == (2, 1)
    assert host["a"] == 99  # a dummy is not the program's variable
    assert host["u"] == 5  # returned before it was set
    assert not host.values.is_defined(host.values.names["v"])


def test_procedure_references_elements_and_whole_arrays():
    host = run(
        "PROCEDURE fill(k; x, A)\nx = 10*k | A[k] = x + 1\nend\n"
        "ARRAY a[3], b[3], c[4]\nfor i = 1 to 3\ncall fill(i; a[i], b)\nnext\ncall fill(4; q, c)"
    )
    assert host["a"].tolist() == [10, 20, 30]
    assert host["b"].tolist() == [11, 21, 31]
    assert host["c"].tolist() == [0, 0, 0, 41]


def test_procedures_may_call_others_and_pass_references_on():
    host = run(
        "PROCEDURE inc(;r)\nr = r + 1\nend\nPROCEDURE twice(;s)\ncall inc(;s) | call inc(;s)\nend\nx = 3\ncall twice(;x)"
    )
    assert host["x"] == 5


def test_a_new_reference_counts_as_zero_on_its_own_right_side():
    host = run("PROCEDURE add(;r)\nr = r + 5\nend\ncall add(;x) | call add(;x)")
    assert host["x"] == 10


def test_functions_take_whole_arrays_and_shadow_names():
    host = run(
        "FUNCTION look(x, T) = func1(x; T) + T[1]\nFUNCTION twice(x) = 2*look(x, F)\nARRAY F[4]\n"
        "data 0, 1, 10, 20\nread F\nx = 100 | a = look(0.5, F) | b = twice(1)"
    )
    assert (host["a"], host["b"], host["x"]) == (15, 40, 100)


def test_j_is_free_until_the_first_complex_line():
    host = run("s = 0\nfor j = 1 to 3 | s = s + j | next\nCOMPLEX z\nz = 2*j")
    assert (host["s"], host["z"]) == (6, 2j)


def test_functions_use_program_variables_when_called_and_nest():
    host = run("FUNCTION f(x$) = c*x$ + 1\nx$ = 77 | c = 2 | a = f(f(3))\nc = 10 | b = f(1)")
    assert (host["a"], host["b"], host["x$"]) == (15, 11, 77)


def test_a_new_target_counts_as_zero():
    assert run("X = X + 5000")["X"] == 5000


def test_overlays_share_numbers():
    host = run("ARRAY x1[2] + x2[3] = x, W[2,3] = v\nx2[1] = 7 | W[2,1] = 5 | v[1] = 3")
    assert host["x"].tolist() == [0, 0, 7, 0, 0]
    assert host["v"].tolist() == [3, 0, 0, 5, 0, 0]
    assert host["W"][0, 0] == 3


def test_ten_dimensions_are_row_major():
    host = run("ARRAY T[1,2,1,2,1,2,1,2,1,2] = v\nT[1,2,1,1,1,2,1,2,1,1] = 9")
    assert host["v"][0b10110] == 9


def test_data_items_are_expressions_evaluated_when_read():
    host = run("data 1, 2*3; w\nw = 4\nread a, b, c\nrestore\nw = 8 | read d, e, f")
    assert [host[n] for n in "abcdef"] == [1, 6, 4, 1, 6, 8]


def test_data_fill_arrays_by_rows_and_restore_finds_labels_and_lines():
    host = run(
        "10 data 1,2\nlabel L\n20 data 3,4\n30 data 5,6\nARRAY A[2,2]\nread A\nrestore L | read x\nrestore 30 | read y"
    )
    assert host["A"].tolist() == [[1, 2], [3, 4]]
    assert (host["x"], host["y"]) == (3, 5)


def test_inverse_and_linear_equations_are_exact_fractions():
    host = run(
        "ARRAY A[4,4], B[4,4], E[4,4], b[4], x[4], r[4]\n"
        "data 1,3,50,3; 2,3,0,-1; 0,-1,2,0; -90,0,1,3; 2,3,5,-7\nread A, b\n"
        "MATRIX B = $In(A) | Vector x = B*b | Vector r = A*x - b | MATRIX E = A*B"
    )
    inverse = [
        [Fraction(n, 6349) for n in (19, -165, -438, -74)],
        [Fraction(n, 907) for n in (24, 78, -601, 2)],
        [Fraction(n, 907) for n in (12, 39, 153, 1)],
        [Fraction(n, 6349) for n in (542, -5041, -13497, -106)],
    ]
    assert host["B"] == pytest.approx(np.array(inverse, dtype=float), rel=1e-11)
    solution = [Fraction(-2129, 6349), Fraction(-2737, 907), Fraction(899, 907), Fraction(-80782, 6349)]
    assert host["x"] == pytest.approx([float(s) for s in solution], rel=1e-11)
    assert np.abs(host["r"]).max() < 1e-11
    assert host["E"] == pytest.approx(np.eye(4), abs=1e-12)


def test_rotation_there_and_back():
    host = run(
        "ARRAY A[2,2], x[2], y[2]\nc = cos(0.5) | s = sin(0.5)\n"
        "A[1,1] = c | A[1,2] = -s | A[2,1] = s | A[2,2] = c | x[1] = 1 | x[2] = 2\n"
        "for k = 1 to 3 | Vector x = A*x | next\ny[1] = x[1] | y[2] = x[2]\nfor k = 1 to 3 | Vector y = A%*y | next"
    )
    assert host["x"] == pytest.approx([-1.924252772, 1.13896939], abs=1e-8)
    assert host["y"] == pytest.approx([1, 2], abs=1e-14)


def test_complex_arithmetic_of_the_book():
    host = run(
        "COMPLEX z, c, ww, Z[2,3]\nff = 2.11 | c = 1000\nww = 23.444 - j*ff\nc = c + 1 + j*2 | z = ff*c - ff + [2, ff - 1] - Z[1,2]"
    )
    assert host["z"] == pytest.approx(2112 + 5.33j)
    assert host["ww"] == 23.444 - 2.11j


def test_complex_functions():
    host = run(
        "COMPLEX z\nz = expj(PI/2) | a = Cabs(3 + 4*j) | b = Arg(j) | c = Re([1,2]) + 10*Im([1,2])\nz = exp(j*PI/2)*Conjug(j)"
    )
    assert (host["a"], host["b"], host["c"]) == (5, pi / 2, 21)
    assert host["z"] == pytest.approx(1)


def test_frequency_response_of_a_series_circuit():
    host = run(
        "R = 1000 | L = 1 | C = 1.0E-06\nCOMPLEX Z\nfor w = 100 to 10000 step 50\n"
        "Z = R + j*(w*L - 1/(w*C))\nplot log(w) - 3, 0.0002*Cabs(Z) - 0.999, 14\nplot Z/10000, 12\nnext"
    )
    points = [c for c in host.calls if c[0] == "plot"]
    assert len(points) == 2 * 199
    assert points[0] == ("plot", pytest.approx(-1), pytest.approx(0.0002 * 9950.376877 - 0.999), 14)
    assert points[-1][1:] == (pytest.approx(0.1), pytest.approx(0.99), 12)


def test_conformal_mapping_by_products():
    host = run("COMPLEX z\ny = 0.9\nz = 0.4 + j*y\nplot z*z\nplot z*z*z\nplot z^3")
    _, x2, y2, _ = host.calls[0]
    assert (x2, y2) == (pytest.approx(-0.65), pytest.approx(0.72))
    assert host.calls[1][1:3] == (pytest.approx(-0.908), pytest.approx(-0.297))
    assert host.calls[2] == host.calls[1]


def test_integers_are_rounded_and_literals_read():
    host = run("INTEGER i, d[2]\ni = 2.7 | d[2] = -2.5\na = &17370 | b = &&FC2 | c = &&FFFF")
    assert (host["i"], host["d"][1]) == (3, -3)
    assert (host["a"], host["b"], host["c"]) == (7928, 4034, -1)


def test_adding_a_tenth_a_million_times_shows_round_off():
    host = run("s = 0\nfor k = 1 to 1000000 | s = s + 0.1 | next")
    assert host["s"] == pytest.approx(100000.0000013329, abs=1e-9)


def test_fft_of_a_pulse():
    n = 16384
    host = run(f"n = {n} | ARRAY x[n+3], y[n]\nfor i = 1 to 20 | x[i] = 1 | next\nFFT F, n, x, y")
    x, y = host["x"], host["y"]
    for element, re, im in [
        (1, 20, 0),
        (2, 19.99981837, -0.07286374808),
        (411, 0.9805256976, -12.6952614),
        (820, -0.004843198825, -0.000770705232),
        (1000, 2.935661579, -1.596024184),
    ]:
        assert (x[element - 1], y[element - 1]) == (pytest.approx(re, rel=1e-9), pytest.approx(im, rel=1e-8))
    host.execute("FFT I, n, x, y")
    assert x[:20] == pytest.approx(np.ones(20), abs=1e-13)
    assert np.abs(x[20:]).max() < 1e-13


def test_fft_of_two_real_arrays():
    host = run(
        "ARRAY x[512], y[512], u[512], v[512]\nfor i = 1 to 4 | x[i] = 1 | y[i+5] = 1 | next\nFFT R, 512, x, y, u, v"
    )
    x, y, u, v = (host[name] for name in "xyuv")
    assert (x[1], u[1], y[1], v[1]) == pytest.approx(
        (3.998945905, -0.07361998975, 3.986905908, -0.3186997526)
    )
    assert (x[64], u[64], y[64], v[64]) == pytest.approx((1, -2.41421356, 1, 2.41421356))


def test_cyclical_convolution_with_its_nyquist_bin():
    host = run(
        "n = 512 | ARRAY x[n], y[n]\nfor i = 1 to 120 | x[i] = 1 | y[100+i] = 1.5 | next\nFFT C, n, x, y"
    )
    x = host["x"]
    expected = {100: 0, 101: 1.5, 160: 90, 220: 180, 221: 178.5, 339: 1.5, 340: 0}
    for element, value in expected.items():
        assert x[element - 1] == pytest.approx(value, abs=1e-10)
    assert x.sum() == pytest.approx(21600)
    assert np.abs(host["y"]).max() < 1e-10


def test_dot_products_and_norms():
    host = run(
        "ARRAY x[4], A[4,4], y[4], e[4]\ndata 1,2,3,4; 1,3,50,3; 2,3,0,-1; 0,-1,2,0; -90,0,1,3\nread x, A\n"
        "DOT a = x*1 | DOT b = x*x | DOT c = x*A*x | DOT d = x*1 - x*x + x*A%*x | AVG m = x*x\n"
        "Vector y = A%*x\nVector e = exp(x) | DOT s = e*1"
    )
    assert [host[n] for n in "abcdm"] == [10, 30, -111, -131, 7.5]
    assert host["y"].tolist() == [-355, 6, 60, 13]
    assert host["s"] == pytest.approx(84.79102488)


def test_matrix_assignments():
    host = run(
        "ARRAY A[2,3], B[3,2], C[2,2], I[3,3], T[2,3]\ndata 1,2,3,4,5,6\nread A\n"
        "MATRIX B = A% | MATRIX C = 2*A*B - C | MATRIX I = 1 | MATRIX T = $Tr(B)*I | MATRIX A = 0"
    )
    assert host["B"].tolist() == [[1, 4], [2, 5], [3, 6]]
    assert host["C"].tolist() == [[28, 64], [64, 154]]
    assert host["T"].tolist() == [[1, 2, 3], [4, 5, 6]]
    assert not host["A"].any()


def test_a_target_on_the_right_is_computed_first():
    host = run("ARRAY A[2,2], x[2]\ndata 0,1,1,1, 1,1\nread A, x\nMATRIX A = A*A | Vector x = A*x + x")
    assert host["A"].tolist() == [[1, 1], [1, 2]]
    assert host["x"].tolist() == [3, 4]


def test_redeclaring_the_same_shape_zeroes():
    host = run("ARRAY x[3]\nx[2] = 5\nARRAY x[3]\ny = x[2]")
    assert host["y"] == 0
