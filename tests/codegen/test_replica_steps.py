"""Whole steps of vector models of replicas give the bits of passes over whole vectors."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.codegen.jit.background import Improver
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.codegen.conftest import improve

HEAD = (
    "n = {n} | k = 3 | a = 0 | STATE x[n], v[n] | ARRAY w[n], s[n], c[n], g[n] | ARRAY f[8] | data -1, 0, 0.5, 1, 3, 1, -2, 0 | read f\n"
    "for i = 1 to n | x[i] = 1 + 0.01*i | w[i] = 0.3 + 0.02*i | next\n"
    "irule {rule} | DT = 0.01 | TMAX = 0.6 | NN = 7 | SEED 3\ndrun\nDYNAMIC\n"
)
SHOWN = "x1 = x[1] | xn = x[n] | vn = v[n] | gn = g[n]\ndispt x1, xn, vn, gn\n"
SPRINGS = "Vector s = sin(x)\nVector c = cos(x)\nVectr d/dt x = v*c\nVectr d/dt v = -w*s - 0.1*v\n"
REPLICAS = {
    "springs": SPRINGS,
    "what all share": "a = sin(t)\nb = a*k\n" + SPRINGS.replace("0.1*v", "b*v*t"),
    "functions": "Vector g = sat(x) + max(v, w) + abs(x)^1.7 + x^3 + tanh(v) + SAT(x - 1)\n"
    + SPRINGS.replace("0.1*v", "0.1*g"),
    "tables": "Vectr d/dt x = v\nVectr d/dt v = -func1(x; f) - 0.1*func1(t; f)*v\n",
    "assigned twice": "Vector g = x\nVector g = g*v\nVectr d/dt x = v\nVectr d/dt v = -w*x - g\n",
    "OUT": "Vector s = sin(x)\nVectr d/dt x = v + g\nVectr d/dt v = -k*s\nOUT\nVector g = 0.1*s + 0.01*gauss(0)\n"
    "k = k*1.01\nx[3] = 1\n",
}
OTHERS = {
    "neighbours": "Vectr d/dt x = v\nVectr d/dt v = x{{1}} - 2*x + x{{-1}}\n",
    "noise": "Vectr d/dt x = v + ran()\nVectr d/dt v = -w*x\n",
    "step": SPRINGS + "step\nk = k + 1\n",
    "term": SPRINGS + "term t - 0.355\n",
    "one element": "a = x[2]\nVectr d/dt x = v\nVectr d/dt v = -a*x\n",
    "what is carried on": "Vectr d/dt x = v + g\nVector g = 0.1*x\nVectr d/dt v = -w*x\n",
    "a number carried on": "Vectr d/dt x = v + a\na = sin(t)\nVectr d/dt v = -w*x\n",
    "what was computed last": "q = s[1]\n" + SPRINGS + "Vector g = q*w\n",
    "another state": "d/dt y = -y\nVectr d/dt x = v\nVectr d/dt v = -w*x*y\n",
    "one number assigned": "Vector s = x\nk = s[2]\nVector g = k*s\nVectr d/dt x = v\nVectr d/dt v = -w*g\n",
}


def both(text: str, monkeypatch: pytest.MonkeyPatch) -> tuple[bool, list[np.ndarray], list[np.ndarray]]:
    """Run a program by passes, then by what it is improved to; say whether steps are taken as a whole."""
    models = []
    found, calls = [], []
    for see in (models.append, improve):
        monkeypatch.setattr(Improver, "add", lambda _, model, see=see: (see(model), models.append(model)))
        session = Session()
        session.erun(Source(text + SHOWN))
        record = session.runs[-1]
        arrays = [np.array(session.values.view(q)) for q in session.values if q.shape]
        found.append([record.rows[: record.count].copy(), *arrays])
        calls.append(record.derivative_calls)
    assert calls[0] == calls[1]
    return models[-1].context.whole_step != 0, found[0], found[1]


@pytest.mark.parametrize(
    ("name", "rule", "n"),
    [
        *((name, 1, 37) for name in REPLICAS),
        ("springs", 2, 16),
        ("springs", 3, 100),
        ("what all share", 5, 5),
    ],
)
def test_the_bits_of_passes_over_vectors(name, rule, n, monkeypatch):
    whole, by_passes, at_once = both(HEAD.format(n=n, rule=rule) + REPLICAS[name], monkeypatch)
    assert whole
    assert by_passes[0][-1, 0] == pytest.approx(0.6)
    for wanted, found in zip(by_passes, at_once, strict=True):
        assert np.array_equal(wanted, found)


@pytest.mark.parametrize("name", OTHERS)
def test_what_keeps_a_model_from_it(name, monkeypatch):
    whole, by_passes, at_once = both((HEAD + OTHERS[name]).format(n=37, rule=1), monkeypatch)
    assert not whole
    assert np.array_equal(by_passes[0], at_once[0])
