"""The script interpreter beside plain Python doing the same. `python -m benchmarks.bench_script_speed`

Columns: what is repeated, time for each pass of the loop, time without the empty loop, expression
nodes a second, and the time the same statement takes in a Python function with local variables.
"""

from __future__ import annotations

import math
import time

from desire_tui.engine.interpreter.interpreter import Interpreter
from desire_tui.engine.source import Source
from desire_tui.engine.structure.structure import structure
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import Values

PASSES = 200_000
SETUP = (
    "x = 1.5 | y = 2.5 | a = 3 | ARRAY A[1000], M[30,30]\nFUNCTION f(u) = u*u + 1\n"
    "PROCEDURE p(u; r)\nr = u + 1\nend\n"
)
CASES = (  # statement, expression nodes, the same in Python
    ("", 0, "pass"),
    ("z = k", 1, "z = k"),
    ("z = a*x + y*(x - a)/3 + k*k*x - y + a*a", 21, "z = a*x + y*(x - a)/3 + k*k*x - y + a*a"),
    ("z = sin(x) + exp(-y)*sqrt(a)", 9, "z = math.sin(x) + math.exp(-y)*math.sqrt(a)"),
    ("A[1 + k/1000] = A[7] + k", 7, "A[int(k/1000)] = A[6] + k"),
    ("M[2, 3] = M[3, 2] + x", 3, "M[33] = M[62] + x"),
    ("if k > a then | z = 1 | else | z = 2 | proceed", 4, "z = 1 if k > a else 2"),
    ("z = f(k)", 6, "z = f(k)"),
    ("call p(k; z)", 5, "z = p(k)"),
)


class Quiet:
    """A host that nothing is asked of."""

    rule = 1

    def interrupted(self) -> bool:
        return False


def interpreted(statement: str) -> float:
    """CPU seconds for PASSES passes."""
    program = parse(Source(f"{SETUP}for k = 1 to {PASSES}\n{statement}\nnext\n", "speed"))
    assert not program.problems, statement
    interpreter = Interpreter(program, structure(program), Values(), Quiet())
    began = time.process_time()
    interpreter.run()
    return time.process_time() - began


def in_python(statement: str) -> float:
    """CPU seconds for PASSES passes of a Python loop."""
    names: dict[str, object] = {"math": math}
    body = (
        "def f(u): return u*u + 1\ndef p(u): return u + 1\n"
        f"def run():\n x, y, a, z, A, M = 1.5, 2.5, 3.0, 0.0, [0.0]*1000, [0.0]*900\n"
        f" for i in range({PASSES}):\n  k = float(i)\n  {statement}\n"
    )
    exec(body, names)
    began = time.process_time()
    names["run"]()  # type: ignore[operator]
    return time.process_time() - began


def main() -> None:
    print(f"{'statement':48} {'µs/pass':>8} {'own µs':>8} {'nodes/s':>10} {'Python µs':>10}")
    empty = 0.0
    for statement, nodes, python in CASES:
        seconds = min(interpreted(statement) for _ in range(3))
        empty = empty or seconds
        own = max(seconds - empty, 1e-12)
        speed = f"{nodes * PASSES / own / 1e6:8.1f} M" if nodes else ""
        yardstick = min(in_python(python) for _ in range(3))
        per = 1e6 / PASSES
        shown = statement or "(empty loop)"
        print(f"{shown:48} {seconds * per:8.2f} {own * per:8.2f} {speed:>10} {yardstick * per:10.2f}")


if __name__ == "__main__":
    main()
