"""Signals at random moments to `desire run`: the exit status says what ended it, and each output file is whole."""

from __future__ import annotations

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from tests.fuzz.corpus import ROOT

if TYPE_CHECKING:
    from random import Random

SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGKILL")
OLD = "what stood there before\n"
PROGRAM = """\
TMAX = {tmax} | DT = 0.001 | NN = {nn} | irule 3 | x = 1
drun
write 'done'
DYNAMIC
d/dt x = v
d/dt v = -x
dispt x, v
"""
PATIENCE_SECONDS = 250
_OURS = re.compile(rb"desire_tui/__main__\.py\", line \d+, in main")
"""In a traceback without this, Python itself was still starting: nobody can catch a signal there."""


def generate(rng: Random) -> list[str]:
    """Return the program, the signal, the moment, and whether the files exist already."""
    nn = rng.choice((11, 10_001, 200_001))
    text = PROGRAM.format(tmax=rng.choice((1, 200, 2000)), nn=nn)
    return [text, rng.choice(SIGNALS), f"{rng.uniform(0, 1.5):.3f}", rng.choice(("old", "new"))]


def check(parts: list[str]) -> None:
    """Start it, wait, send; then look at everything that it left."""
    if len(parts) != 4 or parts[1] not in SIGNALS:
        return
    text, name, moment, before = parts
    folder = Path.cwd()
    for path in folder.iterdir():
        if path.is_file():
            path.unlink()
    (folder / "p.src").write_text(text, "utf-8")
    files = [folder / "r.csv", folder / "r.json"]
    if before == "old":
        for path in files:
            path.write_text(OLD, "utf-8")
    command = [sys.executable, "-m", "desire_tui", "run", "p.src", "--csv", "r.csv", "--json", "r.json"]
    child = subprocess.Popen(
        command,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        stdin=subprocess.DEVNULL,
        preexec_fn=_take_signals,  # noqa: PLW1509 - no thread has been started in this process
    )
    time.sleep(float(moment))
    child.send_signal(getattr(signal, name))
    try:
        _, errors = child.communicate(timeout=PATIENCE_SECONDS)
    finally:
        child.kill()
    number = getattr(signal, name)
    allowed = {0, -number, 128 + number} | ({3, 1} if name != "SIGKILL" else set())
    assert child.returncode in allowed, f"status {child.returncode} after {name}: {errors!r}"
    assert not _OURS.search(errors), f"traceback after {name}: {errors!r}"
    for path in files:
        _whole(path, before)
    if child.returncode == 0:
        assert all(path.read_text("utf-8") != OLD for path in files), "done, and the old file is there"
    if name != "SIGKILL":
        left = {path.name for path in folder.iterdir() if path.is_file()} - {"p.src", "r.csv", "r.json"}
        assert not left, f"left behind after {name}: {left}"


def _take_signals() -> None:
    signal.signal(
        signal.SIGINT, signal.default_int_handler
    )  # the process around ignores it, which is inherited


def _whole(path: Path, before: str) -> None:
    if not path.exists():
        assert before == "new", f"{path.name} is gone"
        return
    text = path.read_text("utf-8")
    if text == OLD and before == "old":
        return
    assert text.endswith("\n") or path.suffix == ".json", f"{path.name} is cut"
    if path.suffix == ".json":
        json.loads(text)
    else:
        rows = list(csv.reader(text.splitlines()))
        assert len({len(row) for row in rows}) == 1, f"{path.name} has rows of different lengths"
