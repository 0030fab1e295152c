"""Long arrays are computed tile by tile, and their steps by blocks: the numbers are those of whole arrays."""

import numpy as np
import pytest

from desire_tui.engine.codegen.stiff import stiff_model
from desire_tui.engine.codegen.taylor import recurrences
from desire_tui.engine.codegen.taylor.tile_layout import elements_in_tiles
from desire_tui.engine.codegen.threads.pool import thread_pool
from tests.codegen.conftest import run
from tests.taylor.series_of import coefficients

N = 70_001
"""Shared, and no multiple of a tile or a strip."""
REACTIONS = """DYNAMIC
s = sin(3*t)
Vector P = U*V{-2}
Vectr d/dt U = 0.3*(U{1} - 2*U + U{-1}) - P*U + C*s + 0.1*U{3}/(2 + V)
Vectr d/dt V = V{1} - V + P - exp(0.1*U{-1}) + (1 + V)^q + k
Vectr d/dt W = V{2}
"""
REACTIONS_GIVEN = {
    "U": np.sin(np.arange(N) / 7.0),
    "V": 0.5 + 0.4 * np.cos(np.arange(N) / 5.0),
    "W": np.zeros(N),
    "P": np.zeros(N),
    "C": np.linspace(-1.0, 1.0, N),
    "q": -0.7,
    "k": 0.25,
}


def test_tiles_have_the_bits_of_whole_arrays(monkeypatch):
    """Margins and ends included."""
    in_tiles = []

    def asked(program):
        in_tiles.append(elements_in_tiles(program))
        return in_tiles[-1]

    ermax, order = 1e-6, 11
    monkeypatch.setattr(recurrences, "elements_in_tiles", asked)
    found = coefficients(REACTIONS, "quick", REACTIONS_GIVEN, ("U", "V", "W"), ermax)
    monkeypatch.setattr(recurrences, "elements_in_tiles", lambda _program: 0)
    whole = coefficients(REACTIONS, "quick", REACTIONS_GIVEN, ("U", "V", "W"), ermax)
    assert in_tiles == [N]
    for name in "UVW":
        assert (found[name][1 : order + 1] == whole[name][1 : order + 1]).all()
        assert np.abs(found[name][order]).max() > 0.0


HEAT = f"""irule 17 | ERMAX = 1E-7 | TMAX = 4 | DT = 1 | NN = 3
n = {N} | STATE u[n], w[n] | for i = 1 to n | u[i] = sin(k*i) | next
u[5000] = u[5000] + 1
drun
DYNAMIC
Vectr d/dt u = u{{1}} - 2*u + u{{-1}} - 0.1*w
Vectr d/dt w = u
m = u[7000]
dispt m
"""


def everything(found):
    """Return the bits of all states at the end."""
    values = found.session.values
    return [values.view(values.find(name)).tobytes() for name in "uw"]


def test_a_long_heat_equation(monkeypatch):
    """A sine along the rod is an eigenvector: u'' = -c·u' - 0.1·u; far from it is a bump, which tells the steps.

    Bits are the same for any number of threads, and without blocks.
    """
    text = HEAT.replace("k*i", f"{np.pi / (N + 1) * 1000!r}*i")
    pool = thread_pool()
    members, rate = pool.members, 4 * np.sin(np.pi / (N + 1) * 1000 / 2) ** 2
    runs = []
    try:
        for count in (1, 3):
            pool.resize(count)
            found = run(text)
            runs.append((everything(found), found.record.steps))
    finally:
        pool.resize(members)
    monkeypatch.setattr(stiff_model, "share_steps", lambda _taylor, _solver: None)
    whole = run(text)
    assert runs == [(everything(whole), whole.record.steps)] * 2
    fast, slow = np.roots([1.0, rate, 0.1])
    # u = A·e^(fast·t) + B·e^(slow·t) with u(0) = 1, u'(0) = -rate
    a = (-rate - slow) / (fast - slow)
    for row in found.rows:
        exact = a * np.exp(fast * row[0]) + (1 - a) * np.exp(slow * row[0])
        place = np.sin(np.pi / (N + 1) * 1000 * 7000)
        assert row[1] == pytest.approx((exact * place).real, abs=1e-6)


def test_what_is_not_computed_in_tiles():
    """Sums over all elements and far neighbours need whole arrays."""
    far = f"irule 17 | ERMAX = 1E-6 | TMAX = 1 | DT = 1 | NN = 2\nn = {N} | STATE u[n]\nu[1] = 1\ndrun\nDYNAMIC\n"
    found = run(far + "DOT s = u*1\nVectr d/dt u = u{-300} - s*u\nm = u[601]\ndispt m\n")
    # the total x keeps x' = x - x² but for what leaves: 1 stays 1, so u[601] = t²/2·e^(-t)
    assert found.rows[-1, 1] == pytest.approx(0.5 * np.exp(-1.0), rel=1e-6)
