"""`floor`, and what is made of it: located under every rule that controls its steps."""

from __future__ import annotations

import pytest

import desire_tui
from desire_tui.engine.integration.rules import rules_of
from desire_tui.engine.lowered.expressions import Op
from desire_tui.engine.lowered.walk import walk_values
from desire_tui.engine.lowering.operators import COMPOSED
from desire_tui.engine.passes import switching

RULES = rules_of("variable", "multistep", "series")
INTEGRALS = {
    "floor(t/3)": 12.0,
    "ceil(t/3)": 22.0,
    "mod(t, 1.5)": 6 * 1.125 + 0.5,
    "heav(t - 3.25)": 6.75,
    "floor(x)": -5.0,  # x goes from -1.5 to 1.5 in steps that take 5/3, 10/3, 10/3, 5/3
    "mod(x, 1)": 5.0,
}
"""What they add up to from t = 0 to 10."""


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("rule", RULES)
def test_integrals(rule, backend):
    lines = "\n".join(f"d/dt y{k} = {text}" for k, text in enumerate(INTEGRALS))
    names = [f"y{k}" for k in range(len(INTEGRALS))]
    bound = "1e-4" if rule == 7 else "1e-7"  # the step of the rule of first order is in proportion to it
    model = desire_tui.load(
        f"x = -1.5 | TMAX = 10 | DT = 0.01 | NN = 11 | ERMAX = {bound} | irule {rule}\ndrun\nDYNAMIC\n"
        f"d/dt x = 0.3\n{lines}\ndispt {', '.join(names)}\n",
        backend=backend,
    )
    run = model.run(check=True)
    assert [run[name][-1] for name in names] == pytest.approx(list(INTEGRALS.values()), abs=1e-5)


def test_each_alone_is_looked_for():
    """A text without words that switch is not searched: those of functions made of others are among them."""
    for name, expand in COMPOSED.items():
        made = expand(*[Op("x", ()) for _ in range(expand.__code__.co_argcount)])
        if any(isinstance(node, Op) and node.name in switching._SWITCHES for node in walk_values(made)):
            assert name in switching._WORDS
