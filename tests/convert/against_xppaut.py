"""Converted programs against XPPAUT itself: `python -m tests.convert.against_xppaut FILE.ode …`

Needs `xppaut` (Debian has it, with examples in /usr/share/doc/xppaut/examples/ode). Each file is integrated
three times: by XPPAUT as it stands (`-silent`), by XPPAUT with half the step and small tolerances (its distance
from the first is XPPAUT's own error), and as a converted Desire program. A file agrees if every state stays, at all times, within
three times that error of the second, or within 1e-5 of the state's size, which is about what
XPPAUT's output files (single precision) resolve. Files with random numbers only have to run.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import desire_tui
from desire_tui.convert.names import NameTable, names_of
from desire_tui.convert.xppaut.reader import read_ode
from desire_tui.convert.conversion import convert
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.files import read_source

SECONDS = 60.0
FINER = ",toler=1e-9,atoler=1e-9"
RESOLVED = 1e-5
"""Of a state's size: what single precision and XPPAUT's interpolation of flags leave."""


def by_xppaut(path: Path, more: str = "") -> np.ndarray:
    """Return XPPAUT's samples: the time, states, auxiliary quantities in columns."""
    text = re.sub(r"^\s*only\s.*$", "", read_source(path).text, flags=re.MULTILINE | re.IGNORECASE)
    with TemporaryDirectory() as name:
        folder = Path(name)
        for beside in path.parent.glob("*.tab"):
            (folder / beside.name).write_bytes(beside.read_bytes())
        done = re.search(r"^\s*d(one)?\s*$", text, re.MULTILINE | re.IGNORECASE)
        head = text[: done.start()] if done else text
        file = folder / "model.ode"
        file.write_text(f"{head.rstrip()}\n{more}\ndone\n")
        subprocess.run(["xppaut", file.name, "-silent", "-internset", "0", "-outfile", "output.dat"], cwd=folder, timeout=SECONDS,
                       capture_output=True, check=False)  # fmt: skip
        output = folder / "output.dat"
        if not output.exists():
            raise ValueError("XPPAUT wrote nothing")
        return np.loadtxt(output, ndmin=2)


def compared(path: Path) -> str:
    """Return how a file fares, in a line that begins with `agrees`, `runs`, `DIFFERS`, `not converted`, `XPPAUT`."""
    source = read_source(path)
    try:
        conversion = convert(source)
    except DesireError as error:
        return f"not converted: {error.message}"
    if not conversion.complete:
        first = next(problem for problem in conversion.problems if problem.severity == "error")
        return f"not converted, line {first.line}: {first.message}"
    model = read_ode(source)
    names = NameTable(names_of(model))
    states = [names(state.name) for state in model.states]
    try:
        run = desire_tui.load(conversion.text).run(record=[*states, "t"], timeout=SECONDS)
    except (DesireError, ValueError, TypeError) as error:
        return f"DIFFERS: the program does not run: {str(error).splitlines()[0]}"
    if run.error is not None:
        return f"DIFFERS: the run ends: {str(run.error).splitlines()[0]}"
    if re.search(r"\b(white|ran|gauss)\(", conversion.text):
        return f"runs (random): {len(states)} states to t = {run.t[-1]:g}"
    step = model.settings.step
    try:
        theirs = by_xppaut(path)
        finer = theirs
        if model.settings.rule:
            factor = round(abs(theirs[1, 0] - theirs[0, 0]) / step) if len(theirs) > 1 else 1
            finer = by_xppaut(path, f"@ dt={step / 2!r},nout={2 * max(1, factor)}{FINER}")
    except (ValueError, subprocess.TimeoutExpired) as reason:
        return f"XPPAUT fails: {reason}"
    return _verdict(run, states, theirs, finer)


def _verdict(run, states: list[str], theirs: np.ndarray, finer: np.ndarray) -> str:
    ours = np.column_stack([run[state] for state in states])
    rows = [int(np.argmin(abs(run.t - t))) for t in theirs[:, 0]]
    near = np.array(
        [abs(run.t[row] - t) < 1e-4 * max(1.0, abs(t)) for row, t in zip(rows, theirs[:, 0], strict=True)]
    )
    count = min(len(theirs), len(finer))
    used = np.flatnonzero(near[:count])
    if len(used) < 2:
        return "DIFFERS: no common times"
    worst = (0.0, "", 0.0)
    for column, state in enumerate(states, 1):
        size = max(float(np.max(abs(theirs[used, column]))), 1e-30)
        own = np.maximum.accumulate(abs(theirs[used, column] - finer[used, column]))
        off = abs(ours[np.array(rows)[used], column - 1] - finer[used, column])
        ratio = off / (3 * own + RESOLVED * size)
        at = int(np.argmax(ratio))
        if not ratio[at] <= worst[0]:
            worst = (float(ratio[at]), state, float(theirs[used[at], 0]))
    verdict = "agrees" if worst[0] <= 1 else "DIFFERS"
    return f"{verdict}: {len(states)} states, {len(used)} of {len(theirs)} times, worst {worst[1]} {worst[0]:.2g} at t = {worst[2]:g}"


def main(names: list[str]) -> int:
    """Compare files; return 1 if one differs."""
    results = {}
    for name in names:
        results[name] = compared(Path(name))
        print(f"{Path(name).name}: {results[name]}", flush=True)
    kinds = ("agrees", "runs", "DIFFERS", "not converted", "XPPAUT")
    counts = {kind: sum(line.startswith(kind) for line in results.values()) for kind in kinds}
    print(", ".join(f"{kind} {count}" for kind, count in counts.items()))
    return 1 if counts["DIFFERS"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
