"""From a program's text to the first pass of its segment: what a user waits for behind `zz`.

Goals (performance.md 2): up to 30 lines 10 ms; 1401 equations 25 ms cold, 8 ms after a one-line edit.
*Cold*: every store is empty (lines, statements by shape, lowered expressions, templates), and the text is
new, so that no compiled code fits either. Not counted, because the app does them while the user reads and
types: loading LLVM and the grammar's tables, compiling a rule's loop, which all programs share. *One line
edited*: an earlier program is in the stores; each time another line is different. *Second process*: the
stores are empty, what an earlier process stored of the program is on disk (`engine.warm_start`), that of the
rule's loop too.
`cpu` is this thread's processor time, which other work on the machine does not stretch as it does `wall`; its
parts are those of the best attempt.
"""

from __future__ import annotations

import time
from itertools import pairwise
from statistics import median
from typing import NamedTuple

import numpy as np

from benchmarks.bench_run_speed import ladder as ladder_work
from desire_tui.engine.codegen.backend import NativeBackend
from desire_tui.engine.codegen.compiler_state import CompilerState
from desire_tui.engine.codegen.pieces import kept_pieces, rolled_pieces
from desire_tui.engine.codegen.scalar import rerolling, templates
from desire_tui.engine.lowering import lowering_cache
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.runtime.run_memory import RunMemory
from desire_tui.engine.source import Source
from desire_tui.engine.syntax import shapes
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.syntax.parsed_lines import forget_lines
from desire_tui.engine.values import DT, T, Values
from desire_tui.engine.warm_start.engine_digest import engine_digest
from desire_tui.engine.warm_start.program_start import program_start

Program = tuple[str, tuple[str, ...], tuple[str, ...]]
"""Text, parameters, states."""
ATTEMPTS = 11
_SMALL = """
DYNAMIC
d/dt x = {0}*a*(y - x)
d/dt y = x*(r - z) - y
d/dt z = x*y - b*z
{1}
dispt x, y, z
"""


def lorenz(number: int) -> Program:
    """Three equations."""
    return _SMALL.format(number + 1, ""), ("a", "b", "r"), ("x", "y", "z")


def thirty_lines(number: int) -> Program:
    """The same with 24 defined variables that enter the equations."""
    lines = [f"u{k} = {number + 1}.5*sin(x + {k}) + u{k - 1}*y" if k else "u0 = a" for k in range(24)]
    text = _SMALL.format(number + 1, "").replace("DYNAMIC\n", "DYNAMIC\n" + "\n".join(lines) + "\n")
    return text.replace("- b*z", "- b*z - 0.001*u23"), ("a", "b", "r"), ("x", "y", "z")


def ladder(number: int) -> Program:
    """1401 equations; `number` makes every line new."""
    text = "DYNAMIC" + ladder_work().program.split("DYNAMIC")[1]
    text = text.replace("= a*(", f"= {number + 2}*a*(").replace("= b*(", f"= {number + 3}*b*(")
    states = tuple(line.split()[1] for line in text.splitlines() if line.startswith("d/dt"))
    return text, ("a", "b"), states


def edited_ladder(number: int) -> Program:
    """One line of an earlier program is different."""
    text, parameters, states = ladder(0)
    lines = text.splitlines()
    place = 200 + 37 * number
    lines[place] = lines[place].replace("a*(", f"{number + 7}*a*(").replace("b*(", f"{number + 7}*b*(")
    return "\n".join(lines) + "\n", parameters, states


def forget_everything() -> None:
    """Empty the stores that later programs profit from."""
    forget_lines()
    shapes.forget()
    lowering_cache.forget()
    kept_pieces.forget()
    rolled_pieces.forget()
    for store in (rerolling._shapes, templates._templates):  # nobody else wants them empty
        store.clear()


class Attempt(NamedTuple):
    """Milliseconds: the stages' and all their processor time, and the clock's."""

    parse: float
    analyse: float
    compile: float
    cpu: float
    wall: float


def measure(backend: NativeBackend, program: Program, *, stored: bool = False) -> Attempt:
    """Measure parse, analysis, compiling, and all to the end of the first pass.

    `stored`: as a session does with a large program, which it finds on disk if it was measured before.
    """
    text, parameters, states = program
    values = Values()
    for name in (*states, *parameters):  # the session lays states out in the order of their d/dt lines
        values.assign(values.scalar(name).slot, 1.0)
    values.assign(T, 0.0)
    values.assign(DT, 0.01)
    wall = time.perf_counter()
    marks = [time.thread_time()]
    start = program_start(Source(text)) if stored else None
    parsed = start.own[0] if start is not None else parse(Source(text))
    marks.append(time.thread_time())
    if start is not None:
        segment = start.lowered(parsed, None, values, start.own[1], 3)
    else:
        segment = lower(parsed, None, values)
    marks.append(time.thread_time())
    model = backend.model(segment, 3, values)
    marks.append(time.thread_time())
    rows = np.zeros((4, 1 + len(segment.columns)))
    memory = RunMemory(
        values=values.address, rows=rows.ctypes.data,
        t_max=1.0, comint=0.01, dt_base=0.01, nn=101, every=1, row_limit=1,
    )  # fmt: skip
    model.advance(memory)
    marks.append(time.thread_time())
    wall = time.perf_counter() - wall
    assert memory.row == 1
    if start is not None:
        start.keep(segment, model)
    stages = [b - a for a, b in pairwise(marks[:4])]
    return Attempt(*(1e3 * s for s in (*stages, marks[4] - marks[0], wall)))


def main() -> None:
    backend = _backend(keep=False)
    measure(backend, ladder(0))  # loads LLVM, the grammar's tables and the loop of rule 3
    columns = ("parse", "analyse", "compile", "cpu", "median", "wall", "median", "goal")
    print(f"{'milliseconds, best':32} " + " ".join(f"{c:>7}" for c in columns))
    for name, make, cold, goal in (
        ("3 equations, cold", lorenz, True, 10),
        ("27 lines, cold", thirty_lines, True, 10),
        ("1401 equations, cold", ladder, True, 25),
        ("1401 equations, one line edited", edited_ladder, False, 8),
    ):
        found = []
        if not cold:
            measure(backend, ladder(0))
        for number in range(1, ATTEMPTS + 1):
            if cold:
                forget_everything()
            found.append(measure(backend, make(number)))
        _show(name, found, goal)
    found = []
    for _ in range(ATTEMPTS + 1):
        forget_everything()
        engine_digest.cache_clear()
        found.append(measure(_backend(keep=True), ladder(1), stored=True))
    _show("1401 equations, second process", found[1:], 10)


def _backend(*, keep: bool) -> NativeBackend:
    """Return a back end that compiles nothing in the background."""
    state = CompilerState(keep=keep)
    state.improver.add = lambda work: None  # type: ignore[method-assign]  # noqa: ARG005  # measured alone
    return NativeBackend(state)


def _show(name: str, found: list[Attempt], goal: int) -> None:
    best = min(found, key=lambda attempt: attempt.cpu)
    walls = [attempt.wall for attempt in found]
    figures = (*best[:4], median(attempt.cpu for attempt in found), min(walls), median(walls))
    print(f"{name:32} " + " ".join(f"{f:7.1f}" for f in figures) + f" {goal:7d}", flush=True)


if __name__ == "__main__":
    main()
