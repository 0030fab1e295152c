"""Random statements give the same on the native and the reference back end."""

from functools import cache

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.codegen.conftest import run

pytestmark = pytest.mark.usefixtures("quick_code_only")

FUNCTIONS = (
    "sin", "cos", "atan", "tanh", "abs", "lim", "sat", "SAT", "deadz", "deadc", "swtch", "sgn", "rect", "tri", "sinc",
    "sigmoid", "SIGMOID", "round", "trnc",
)  # fmt: skip
SETTINGS = settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


@cache
def expressions(names, *, draws=False):
    """Return expressions over `names`, a tuple; made once for each, as making them costs more than drawing from them."""
    leaves = st.one_of(
        st.sampled_from(names),
        st.floats(0.1, 3.0).map(lambda x: f"{x:.4f}"),
        *([st.just("ran()")] if draws else []),
    )

    def grow(inner):
        return st.one_of(
            st.tuples(inner, st.sampled_from("+-*"), inner).map(lambda p: f"({p[0]} {p[1]} {p[2]})"),
            st.tuples(st.sampled_from(FUNCTIONS), inner).map(lambda p: f"{p[0]}({p[1]})"),
            st.tuples(inner, st.integers(2, 5)).map(lambda p: f"sat({p[0]})^{p[1]}"),
            inner.map(lambda x: f"1/(2 + {x}^2)"),
            inner.map(lambda x: f"sqrt(abs({x}))"),
            st.tuples(inner, inner, inner).map(lambda p: f"comp({p[0]}, {p[1]}, {p[2]})"),
            st.tuples(inner, inner).map(lambda p: f"max({p[0]}, {p[1]})"),
        )

    return st.recursive(leaves, grow, max_leaves=8)


def agree(text, arrays=()):
    native, reference = run(text, "native"), run(text, "reference")
    assert native.rows.shape == reference.rows.shape
    np.testing.assert_allclose(native.rows, reference.rows, rtol=1e-9, atol=1e-9)
    for name in arrays:
        np.testing.assert_allclose(native.array(name), reference.array(name), rtol=1e-9, atol=1e-9)


@SETTINGS
@given(st.data(), st.sampled_from([1, 2, 3, 5]))
def test_scalar_programs(data, rule):
    known = ["x", "y", "a", "t"]
    lines = []
    for number in range(data.draw(st.integers(0, 3))):
        lines.append(f"u{number} = {data.draw(expressions(tuple(known), draws=True))}")
        known.append(f"u{number}")
    lines += [f"d/dt {name} = sat({data.draw(expressions(tuple(known)))}) - 0.5*{name}" for name in "xy"]
    lines += [
        "step",
        f"z = z + 0.1*sat({data.draw(expressions(tuple(known)))})",
        "OUT",
        "w = x + z",
        "dispt x, y, w, z",
    ]
    body = "\n".join(lines)
    agree(
        f"irule {rule} | x = 0.3 | y = -0.7 | a = 1.7 | z = 0\nSEED 7\n"
        f"TMAX = 0.5 | DT = 0.02 | NN = 6\ndrun\nDYNAMIC\n{body}\n"
    )


@SETTINGS
@given(st.data(), st.integers(1, 21))
def test_vector_programs(data, n):
    known = ["p", "q", "x", "a", "p{1}", "x{-1}", "q{2}"]
    lines = []
    for target in data.draw(st.lists(st.sampled_from(["r", "s", "p"]), max_size=4)):
        usable = tuple(k for k in known if not k.startswith(f"{target}{{"))  # a shifted target is error 85
        lines.append(f"Vector {target} = sat({data.draw(expressions(usable, draws=True))})")
        known += [name for name in (target, f"{target}{{-1}}") if name not in known]
    lines.append(f"Vectr d/dt x = sat({data.draw(expressions(tuple(known)))}) - 0.3*x")
    lines += ["Vectr delta q = 0.01*x", "DOT d = p*x + q*1", "x1 = x[1]", "dispt d, x1"]
    body = "\n".join(lines)
    agree(
        f"n = {n} | a = 0.9 | SEED 3\nSTATE x[n] | ARRAY p[n], q[n], r[n], s[n]\n"
        "for k = 1 to n | x[k] = 0.1*k - 0.4 | p[k] = ran() | q[k] = 1/k | next\n"
        f"TMAX = 0.3 | DT = 0.05 | NN = 3\ndrun\nDYNAMIC\n{body}\n",
        arrays=("x", "p", "q", "r", "s"),
    )


@SETTINGS
@given(st.data(), st.integers(1, 9), st.integers(1, 9))
def test_matrix_programs(data, m, n):
    draw = data.draw
    scale = draw(st.sampled_from(["0.1", "a", "ran()"]))
    outer = draw(st.sampled_from(["u*v", "u & v"]))
    bounds = draw(st.sampled_from(["", "; -0.3, 0.4", "; -a, a"]))
    mask = draw(st.sampled_from(["", "[M]"]))
    text = (
        f"m = {m} | n = {n} | a = 0.5 | SEED 11\nARRAY W[m,n], M[m,n], V[m,n], u[m], v[n], y[m], z[n], c[m]\n"
        "for i = 1 to m | u[i] = 0.3*i - 1 | for k = 1 to n | V[i,k] = ran() | M[i,k] = i - k | next | next\n"
        "for k = 1 to n | v[k] = 1/k | next\n"
        f"NN = 3\ndrun\nDYNAMIC\nMATRIX W = {mask} {scale}*{outer} {bounds}\nDELTA W = 0.01*V\n"
        "Vector y = W*v + u\nVector z = W%*u - 0.2*v\nVector c = [u] y\nVector c^ = y\n"
        "DOT e = u*W*v\nAVG g = z*v - z*1\ndispt e, g\n"
    )
    agree(text, arrays=("W", "y", "z", "c"))
