"""Native solvers for models of many sizes."""

from __future__ import annotations

from typing import TYPE_CHECKING
from weakref import WeakSet

from desire_tui.engine.codegen.stiff import solver_routines
from desire_tui.engine.codegen.stiff.solver_routines import SIZES_KEPT, SolverRoutines

if TYPE_CHECKING:
    import pytest


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
