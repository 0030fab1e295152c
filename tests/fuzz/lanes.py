"""Models of scalars and small vectors run in lock step and one by one: the same bits, the same errors."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING
from zlib import crc32

import numpy as np

from desire_tui.engine.diagnostics import DesireError
from desire_tui.studies.chunk import program_of
from desire_tui.studies.task import Task

if TYPE_CHECKING:
    from random import Random

RUNS = 11
"""A group of eight and a part of another."""
FUNCTIONS = [
    "sin", "cos", "tanh", "exp", "abs", "sqrt", "sat", "SAT", "lim", "deadz", "deadc", "swtch", "sgn", "rect", "tri",
    "sigmoid", "SIGMOID", "round", "trnc", "ln",
]  # fmt: skip
HEAD = """\
ARRAY f[8] | data -1, 0, 0.5, 1, 3, 1, -2, 0 | read f
k = 1 | r = 0.5 | a = 0 | b = 0.1 | c = 0 | d = 0 | e = 0 | u = 0 | h = 0 | g = 0 | SEED 4
p = 0 | w = 0 | ARRAY D[40], E[9], S[5], G[30] | for i = 1 to 9 | G[i] = i | E[i] = -i | next
STATE Y[5] | ARRAY V[5], U[5], M[5,5] | for i = 1 to 5 | Y[i] = 0.1*i | U[i] = 1 - 0.3*i | for j = 1 to 5 | M[i,j] = 0.1*i - 0.07*j | next | next
"""
KEPT = "a[end], b[end], c[end], mean(a), d[end], e[end], u[end], h[end], t[end], max(q), p[end], mean(w)"


def generate(rng: Random) -> str:
    """Return a program; its first line, a comment, says what varies."""
    return _Maker(rng).program()


def check(text: str) -> None:
    """Run it both ways and compare."""
    names = tuple(text.partition("\n")[0].removeprefix("-- ").split())
    states = [name for name in "xyz" if f"d/dt {name} " in text]
    keep = ", ".join([KEPT, *(f"{name}[end], mean({name})" for name in states)])
    task = Task(text, "<fuzz>", None, keep, names, seed=crc32(text.encode()) % 5)
    rows = np.random.default_rng(crc32(text.encode())).uniform(-1, 2, (RUNS, len(names)))
    try:
        together, alone = program_of(task), program_of(replace(task, lanes=False))
    except DesireError:
        return
    assert "in lock step" in together.way_taken, together.way_taken
    one, other = (program.chunk(0, rows, lambda: False) for program in (together, alone))
    assert np.array_equal(one.errors, other.errors), (one.errors, other.errors)
    differs = ~((one.numbers == other.numbers) | (np.isnan(one.numbers) & np.isnan(other.numbers)))
    assert not differs.any(), f"runs, numbers {np.argwhere(differs)[:5].tolist()}"


class _Maker:
    def __init__(self, rng: Random) -> None:
        self._rng = rng
        self._states = ["x", "y", "z"][: rng.randint(0, 3)]
        self._vectors = bool(self._states) and rng.random() < 0.5
        self._names = ["a", "b", "c", "k", "r", "t", "h", "p", "w", *self._states]

    def program(self) -> str:
        rng = self._rng
        lines = [f"d/dt {state} = -{state} + sat({self._value(2)})" for state in self._states]
        if self._vectors:
            lines.append(f"Vectr d/dt Y = -Y + sat({self._vector_value(2)})")
        lines += self._block(2)
        histories = [
            f"delay p = D({self._value(1)}, 0.35)", f"tdelay w = E({self._value(1)}, 0.05)", "store S = b",
            "get w = G",
        ]  # fmt: skip
        lines += [line for line in histories if rng.random() < 0.2]
        if rng.random() < 0.4:
            lines.append(f"term t - {rng.choice(['0.37*k', '0.5', 'r - a', '7'])}")
        if rng.random() < 0.4:
            lines += ["step", *self._block(1)]
        if rng.random() < 0.4:
            lines += ["OUT", *self._block(1, ["d", "e"])]
        if rng.random() < 0.3:
            lines += [f"SAMPLE {rng.randint(2, 4)}", *self._block(1, ["u"])]
        times = f"TMAX = 2 | DT = {rng.choice(['0.02', '0.03', '2/11'])} | " if self._states else ""
        settings = f"{times}irule {rng.choice([1, 2, 3, 5])} | NN = 12 | MM = {rng.choice([1, 1, 3])}\n"
        starts = "".join(f"{state} = 0.3\n" for state in self._states)
        body = "\n".join([*lines, "q = a + b"])
        return f"-- {rng.choice(['k r', 'a', 'k x' if self._states else 'k'])}\n{HEAD}{settings}{starts}drun\nDYNAMIC\n{body}\n"

    def _block(self, depth: int, targets: list[str] | None = None) -> list[str]:
        rng, targets = self._rng, targets or ["a", "b", "c"]
        lines: list[str] = []
        for _ in range(rng.randint(1, 3)):
            kind = rng.random()
            if self._vectors and kind < 0.25:
                lines.append(
                    f"Vector V = sat({self._vector_value(2)})"
                    if rng.random() < 0.7
                    else f"a = V[{rng.randint(1, 5)}]"
                )
            elif kind < 0.55 or depth <= 0:
                value = f"sat({self._value(2)})" if rng.random() < 0.8 else f"{rng.choice(targets)} + 0.1"
                lines.append(f"{rng.choice(targets)} = {value}")
            elif kind < 0.85:
                lines += [f"if {self._value(1)}", *self._block(depth - 1, targets)]
                if rng.random() < 0.5:
                    lines += ["else", *self._block(depth - 1, targets)]
                lines.append("end if")
            else:
                lines.append(f"trkhld h, g = {self._value(1)}, {self._value(1)}")
        return lines

    def _vector_value(self, depth: int) -> str:
        rng = self._rng
        kind = rng.random()
        if depth <= 0 or kind < 0.25:
            return rng.choice(
                ["V", "U", "Y", "U{1}", "Y{-1}", "M*Y", "M%*U", "ran()", "gauss(0)", self._value(0)]
            )
        one, other = self._vector_value(depth - 1), self._vector_value(depth - 1)
        if kind < 0.6:
            return f"(({one}) {rng.choice('+-*')} ({other}))"
        return f"{rng.choice(FUNCTIONS)}({one})" if kind < 0.9 else f"max({one}, {other})"

    def _value(self, depth: int) -> str:
        rng = self._rng
        kind = rng.random()
        if depth <= 0 or kind < 0.25:
            return rng.choice(self._names) if rng.random() < 0.7 else f"{rng.uniform(-2, 2):.2f}"
        one, other = self._value(depth - 1), self._value(depth - 1)
        if kind < 0.6:
            return f"({one} {rng.choice('+-*')} {other})"
        if kind < 0.65:
            return f"{one}/(1.5 + abs({other}))"
        if kind < 0.85:
            return f"{rng.choice(FUNCTIONS)}({one})"
        if kind < 0.9:
            return f"{rng.choice(['max', 'min'])}({one}, {other})"
        if kind < 0.93:
            return f"({one})^{rng.choice([2, 3])}"
        if kind < 0.95:
            return rng.choice(["ran()", "gauss(0)"])
        return f"func1({one}; f)" if kind < 0.97 else f"({one} > {other})"
