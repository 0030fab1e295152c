"""From a program's text to the first pass of its segment: what a user waits for behind `zz`.

Goals (performance.md): up to 30 lines 10 ms; 1401 scalar equations 100 ms cold, 30 ms after a one-line edit.
LLVM is loaded before (the app does that while the user types). Every cold figure is of a text never seen
before.
`cpu` is the thread's processor time, which other work on the machine does not stretch.
"""

from __future__ import annotations

import time
from statistics import median
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.bench_run_speed import ladder as ladder_work
from desire_tui.engine.analysis import lower
from desire_tui.engine.codegen import NativeBackend
from desire_tui.engine.runtime.memory import RunMemory
from desire_tui.engine.source import Source
from desire_tui.engine.syntax import parse
from desire_tui.engine.values import DT, T, Values

if TYPE_CHECKING:
    from collections.abc import Callable

_SMALL = """
DYNAMIC
d/dt x = {0}*a*(y - x)
d/dt y = x*(r - z) - y
d/dt z = x*y - b*z
{1}
dispt x, y, z
"""


def lorenz(number: int) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    """Three equations."""
    return _SMALL.format(number + 1, ""), ("a", "b", "r"), ("x", "y", "z")


def thirty_lines(number: int) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    """The same with 24 defined variables that enter the equations."""
    lines = [f"u{k} = {number + 1}.5*sin(x + {k}) + u{k - 1}*y" if k else "u0 = a" for k in range(24)]
    text = _SMALL.format(number + 1, "").replace("DYNAMIC\n", "DYNAMIC\n" + "\n".join(lines) + "\n")
    return text.replace("- b*z", "- b*z - 0.001*u23"), ("a", "b", "r"), ("x", "y", "z")


def ladder(number: int) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    """1401 equations; `number` makes every line new."""
    text = "DYNAMIC" + ladder_work().program.split("DYNAMIC")[1]
    text = text.replace("= a*(", f"= {number + 2}*a*(").replace("= b*(", f"= {number + 3}*b*(")
    states = tuple(line.split()[1] for line in text.splitlines() if line.startswith("d/dt"))
    return text, ("a", "b"), states


def edited_ladder(number: int) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    """One line of an earlier program is different."""
    text, parameters, states = ladder(0)
    lines = text.splitlines()
    place = 200 + 37 * number
    lines[place] = lines[place].replace("a*(", f"{number + 7}*a*(").replace("b*(", f"{number + 7}*b*(")
    return "\n".join(lines) + "\n", parameters, states


def measure(
    backend: NativeBackend, make: Callable[[int], tuple[str, tuple[str, ...], tuple[str, ...]]], number: int
) -> list[float]:
    """Return milliseconds of parse, analysis, compiling, all up to the first pass; and all in CPU time."""
    text, parameters, states = make(number)
    values = Values()
    for name in (*states, *parameters):  # the session lays states out in the order of their d/dt lines
        values.assign(values.scalar(name).slot, 1.0)
    values.assign(T, 0.0)
    values.assign(DT, 0.01)
    cpu = time.thread_time()
    marks = [time.perf_counter()]
    program = parse(Source(text))
    marks.append(time.perf_counter())
    segment = lower(program, None, values)
    marks.append(time.perf_counter())
    model = backend.model(segment, 3, values)
    marks.append(time.perf_counter())
    rows = np.zeros((4, 1 + len(segment.columns)))
    memory = RunMemory(
        values=values.address, rows=rows.ctypes.data, t_max=1.0, comint=0.01, dt_base=0.01, nn=101, every=1,
        row_limit=1,
    )  # fmt: skip
    model.advance(memory)
    marks.append(time.perf_counter())
    assert memory.row == 1
    done = time.thread_time() - cpu
    steps = [marks[1] - marks[0], marks[2] - marks[1], marks[3] - marks[2], marks[4] - marks[0], done]
    return [1e3 * s for s in steps]


def main() -> None:
    backend = NativeBackend()
    backend.improver.add = lambda _work: None  # type: ignore[method-assign]  # measured alone
    time.sleep(1.0)
    parse(Source("DYNAMIC\nd/dt x = 1\n"))
    measure(backend, ladder, 0)
    print(f"{'milliseconds':32} {'parse':>7} {'analyse':>8} {'compile':>8} {'all':>7} {'cpu':>7} {'goal':>5}")
    for name, make, repeats, goal in (
        ("3 equations", lorenz, 9, 10),
        ("27 lines", thirty_lines, 9, 10),
        ("1401 equations, cold", ladder, 5, 100),
        ("1401 equations, one line edited", edited_ladder, 9, 30),
    ):
        found = [measure(backend, make, number + 1) for number in range(repeats)]
        parts = [median(run[i] for run in found) for i in range(5)]
        print(f"{name:32} " + " ".join(f"{p:7.1f}" for p in parts) + f" {goal:6d}", flush=True)


if __name__ == "__main__":
    main()
