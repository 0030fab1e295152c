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
from typing import TYPE_CHECKING

import numpy as np

import desire_tui
from desire_tui.convert.conversion import convert
from desire_tui.convert.program_text import program_text
from desire_tui.convert.xppaut.reader import read_ode
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.files import read_source

if TYPE_CHECKING:
    from desire_tui.engine.outputs.run import Run

SECONDS = 60.0
_IDLE = re.compile(r"^[ \t]*(only\s.*|set\s[^}]*\})", re.MULTILINE | re.IGNORECASE)
"""Lines that change what `-silent` writes: it runs each `set` by itself."""
FINER = ",toler=1e-9,atoler=1e-9"
RESOLVED = 1e-5
"""Of a state's size: what single precision and XPPAUT's interpolation of flags leave."""


def by_xppaut(path: Path, more: str = "") -> np.ndarray:
    """Return XPPAUT's samples: the time, states, auxiliary quantities in columns."""
    text = _IDLE.sub("", read_source(path).text)
    with TemporaryDirectory() as name:
        folder = Path(name)
        for beside in path.parent.glob("*.tab"):
            (folder / beside.name).write_bytes(beside.read_bytes())
        done = re.search(r"^\s*d(one)?\s*$", text, re.MULTILINE | re.IGNORECASE)
        head = text[: done.start()] if done else text
        file = folder / "model.ode"
        file.write_text(f"{head.rstrip()}\n{more}\ndone\n")
        subprocess.run(["xppaut", file.name, "-silent", "-outfile", "output.dat"], cwd=folder, timeout=SECONDS,
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
    solved = {root.name for root in model.roots}  # those XPPAUT's output has not
    compared_states = [state.name for state in model.states if state.name not in solved]
    model.settings.ordinates = tuple(compared_states)
    model.settings.abscissa = None
    text, renamed = program_text(model)
    states = [renamed.get(name, name) for name in compared_states]
    result = desire_tui.run(text, timeout=SECONDS)
    if result.error is not None or not result.runs:
        return f"DIFFERS: the program does not run: {str(result.error).splitlines()[0]}"
    run = result.runs[-1]
    if re.search(r"\b(white|ran|gauss)\(", conversion.text):
        return f"runs (random): {len(states)} states to t = {run.t[-1]:g}"
    step = model.settings.step or 1.0
    try:
        theirs = by_xppaut(path)
        finer = theirs
        if model.settings.rule:
            factor = round(abs(theirs[1, 0] - theirs[0, 0]) / step) if len(theirs) > 1 else 1
            finer = by_xppaut(path, f"@ dt={step / 2!r},nout={2 * max(1, factor)}{FINER}")
    except (ValueError, subprocess.TimeoutExpired) as reason:
        return f"XPPAUT fails: {reason}"
    return _verdict(run, states, theirs, finer)


def _verdict(run: Run, states: list[str], theirs: np.ndarray, finer: np.ndarray) -> str:
    """Compare at the times that all have, up to where XPPAUT's own error is a tenth of a state's size."""
    times = theirs[:, 0]
    rows, near = _at(run.t, times)
    finer_rows, finer_near = _at(finer[:, 0], times)
    used = np.flatnonzero(near & finer_near)
    finer = finer[finer_rows]
    width = len(states) + 1
    size = np.maximum(np.max(abs(theirs[used, 1:width]), axis=0), 1e-30)
    own = np.maximum.accumulate(abs(theirs[used, 1:width] - finer[used, 1:width]))
    lost = np.flatnonzero((own > 0.1 * size).any(axis=1))
    count = int(lost[0]) if len(lost) else len(used)
    if count < 2:
        return f"XPPAUT is beyond comparison: {len(used)} common times, own error at once a tenth"
    off = abs(np.column_stack([run[state] for state in states])[rows[used]] - finer[used, 1:width])
    ratio = (off / (3 * own + RESOLVED * size))[:count]
    worst = np.unravel_index(int(np.argmax(np.nan_to_num(ratio, nan=np.inf))), ratio.shape)
    verdict = "agrees" if ratio[worst] <= 1 else "DIFFERS"
    return (
        f"{verdict}: {len(states)} states, {count} of {len(times)} times, worst {states[worst[1]]} "
        f"{ratio[worst]:.2g} of the bound at t = {times[used[worst[0]]]:g}"
    )


def _at(t: np.ndarray, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows of `t` nearest to some times, and whether they are these times (in single precision)."""
    rows = np.array([int(np.argmin(abs(t - one))) for one in times])
    return rows, abs(t[rows] - times) < 1e-6 * np.maximum(1.0, abs(times))


def main(names: list[str]) -> int:
    """Compare files; return 1 if one differs."""
    results = {}
    for name in names:
        results[name] = compared(Path(name))
        sys.stdout.write(f"{Path(name).name}: {results[name]}\n")
        sys.stdout.flush()
    kinds = ("agrees", "runs", "DIFFERS", "not converted", "XPPAUT")
    counts = {kind: sum(line.startswith(kind) for line in results.values()) for kind in kinds}
    sys.stdout.write(", ".join(f"{kind} {count}" for kind, count in counts.items()) + "\n")
    return 1 if counts["DIFFERS"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
