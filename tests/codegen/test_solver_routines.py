"""Native solvers for models of many sizes."""

from __future__ import annotations

from weakref import WeakSet

import pytest

from desire_tui.engine.codegen.jit.background import Improver
from desire_tui.engine.codegen.stiff import solver_routines, stiff_model
from desire_tui.engine.codegen.stiff.solver_routines import SIZES_KEPT, SolverRoutines
from tests.integration.stiff_programs import run

SHORT_RUNS = """
irule 14 | ERMAX = 1e-4 | DT = 1e-3 | TMAX = 1 | NN = 2 | x = 1
for k = 1 to 4 | drunr | next
DYNAMIC
d/dt x = -x
dispt x
"""


class Code:
    pass


def test_code_for_many_sizes_is_forgotten_and_the_last_ones_are_kept(monkeypatch: pytest.MonkeyPatch):
    alive: WeakSet[Code] = WeakSet()
    made = []

    def kept_code(name: str) -> Code:
        code = Code()
        alive.add(code)
        made.append(name)
        return code

    monkeypatch.setattr(solver_routines, "kept_code", kept_code)
    monkeypatch.setattr(solver_routines, "_found", lambda code, *, own: code)
    routines = SolverRoutines()
    for n in range(1, 200):
        routines.fast(n, own=True)
    assert len(alive) <= 2 * SIZES_KEPT + 2
    count = len(made)
    for n in range(200 - SIZES_KEPT, 200):
        routines.first(n, own=True)
    assert len(made) == count


def test_what_one_process_has_compiled_the_next_one_finds(monkeypatch: pytest.MonkeyPatch):
    """Well compiled, for all numbers of states, before the first run: a short process has it, too."""
    SolverRoutines().first(3, own=True)
    monkeypatch.setattr(solver_routines, "compile_and_keep", None)
    another = SolverRoutines()
    assert another.first(3, own=True) == another.first(4, own=True)


@pytest.mark.parametrize(("worth", "wanted"), [(10**9, 0), (1, 1)])
def test_code_for_one_number_of_states_is_begun_behind_many_steps(worth, wanted, monkeypatch):
    monkeypatch.setattr(stiff_model, "STEPS_WORTH_OWN_CODE", worth)
    begun = []
    add = Improver.add
    monkeypatch.setattr(Improver, "add", lambda self, work: (begun.append(work), add(self, work)))
    run(SHORT_RUNS)
    assert sum(isinstance(work, stiff_model.StiffModel) for work in begun) == wanted
