"""Two solvers behind `interval`: CVODE, and for small systems `integration.bdf` compiled with the rest.

Each offers: begin anew at t; one step to `t_next` at most, with CVODE's flags; its size; how many tries have
failed since it began.
"""

from __future__ import annotations

from typing import Any, Protocol

from desire_tui.engine.codegen.stiff.ir_builder import INT, INT32, REAL, FixedFunction
from desire_tui.engine.integration.bdf.memory import Bdf
from desire_tui.engine.integration.sundials.signatures import ONE_STEP


class Stepper(Protocol):
    """What an interval needs; `solver` is the address in `Problem.solver`."""

    prefix: str

    def restart(self, f: FixedFunction, problem: Any, t: Any, first_step: Any) -> None:
        """Begin anew from the states in `Problem.states`; a first step of 0: the solver looks for one."""

    def step(self, f: FixedFunction, problem: Any, t_next: Any, reached: Any) -> Any:
        """Return the flag; store t in `reached`, the solution in `Problem.states`."""

    def last_step(self, f: FixedFunction, problem: Any) -> Any:
        """Return the last step's size."""

    def failed(self, f: FixedFunction, problem: Any) -> Any:
        """Return the number of tries that failed, whole steps each."""


class CvodeStepper:
    """The library."""

    prefix = "cvode"

    def restart(self, f: FixedFunction, problem: Any, t: Any, first_step: Any) -> None:
        """CVodeReInit."""
        solver = f.get(problem, "solver")
        f.outside("CVodeReInit", INT32, [solver, t, f.get(problem, "vector")])
        f.outside("CVodeSetInitStep", INT32, [solver, first_step])

    def step(self, f: FixedFunction, problem: Any, t_next: Any, reached: Any) -> Any:
        """CVode."""
        solver = f.get(problem, "solver")
        f.outside("CVodeSetStopTime", INT32, [solver, t_next])
        arguments = [solver, t_next, f.get(problem, "vector"), reached, INT32(ONE_STEP)]
        return f.outside("CVode", INT32, arguments)

    def last_step(self, f: FixedFunction, problem: Any) -> Any:
        """CVodeGetLastStep."""
        cell = self._cell(f, REAL)
        f.outside("CVodeGetLastStep", INT32, [f.get(problem, "solver"), cell])
        return f.build.load(cell, typ=REAL)

    def failed(self, f: FixedFunction, problem: Any) -> Any:
        """CVodeGetNumErrTestFails and CVodeGetNumStepSolveFails."""
        total, cell = INT(0), self._cell(f, INT)
        for name in ("CVodeGetNumErrTestFails", "CVodeGetNumStepSolveFails"):
            f.build.store(INT(0), cell)
            f.outside(name, INT32, [f.get(problem, "solver"), cell])
            total = f.build.add(total, f.build.load(cell, typ=INT))
        return total

    @staticmethod
    def _cell(f: FixedFunction, kind: Any) -> Any:
        with f.build.goto_entry_block():  # in a loop an alloca would eat the stack
            return f.build.alloca(kind)


class OwnStepper:
    """`integration.bdf`; `functions` are its functions in the same module."""

    prefix = "own"

    def __init__(self, functions: dict[str, FixedFunction]) -> None:
        self._functions = functions

    def restart(self, f: FixedFunction, problem: Any, t: Any, first_step: Any) -> None:
        """`bdf.step.restart`."""
        self._call(f, "restart", f.get(problem, "solver"), t, first_step)

    def step(self, f: FixedFunction, problem: Any, t_next: Any, reached: Any) -> Any:
        """`bdf.step.advance`."""
        solver = f.get(problem, "solver")
        flag = self._call(f, "advance", solver, t_next)
        f.build.store(f.get(solver, "t", Bdf), reached)
        return f.build.trunc(flag, INT32)

    def last_step(self, f: FixedFunction, problem: Any) -> Any:
        """Read the field."""
        return f.get(f.get(problem, "solver"), "h_last", Bdf)

    def failed(self, f: FixedFunction, problem: Any) -> Any:
        """Read the fields."""
        solver = f.get(problem, "solver")
        tests, corrections = (f.get(solver, name, Bdf) for name in ("failed_tests", "failed_corrections"))
        return f.build.add(tests, corrections)

    def _call(self, f: FixedFunction, name: str, *arguments: Any) -> Any:
        return f.build.call(self._functions[name].function, arguments)
