"""`kill -9` at random moments to the desktop in a terminal, while somebody types, saves and runs.

What stood on the screen a moment before must be in the file or in what the next start offers to restore, and the
file must be the old or a saved text, whole.
"""

from __future__ import annotations

import contextlib
import json
import re
import shutil
import signal
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from random import Random

    from tests.app.test_terminal import Terminal

OLD = """\
TMAX = 2E6 | DT = 0.001 | NN = 200001
irule 3 | x = 1
drun
DYNAMIC
d/dt x = v
d/dt v = -x
dispt x, v
"""
LOST_SECONDS = 1.0
"""So much typing may be lost, by the desktop's own clock."""
WRITING_SECONDS = 1.0
"""A checkpoint takes a while to be on the disk."""
EDITOR, TOP, F5, CTRL_S = "\x1b[<0;30;4M\x1b[<0;30;4m", "\x1b[1;5H", "\x1b[15~", "\x13"
_WORD = re.compile(r"\bn(\d{4})\b")
_TYPED = re.compile(r"(-- (n\d{4} )*(n\d{0,4})?|-?-?)\Z")


def generate(rng: Random) -> list[str]:
    """Return what is done every 50 ms: a word typed, a pause, a save or a run; then comes the signal."""
    actions = ["word", *rng.choices(("word", "pause", "save"), (20, 3, 0.7), k=rng.randint(1, 80))]
    if rng.random() < 0.4:  # the keys belong to the graph or the console afterwards
        actions += ["run", *["pause"] * rng.randint(0, 30)]
    return actions


def check(actions: list[str]) -> None:
    """Type, kill, look at the files, start again and restore."""
    from tests.app.test_terminal import Terminal

    folder = Path.cwd()
    shutil.rmtree(folder / "state", ignore_errors=True)
    file = folder / "program.src"
    file.write_text(OLD, "utf-8")
    desktop = Terminal(folder, file.name)
    desktop.until(lambda: file.name in desktop.text and "TMAX" in desktop.text and "F5" in desktop.text)
    desktop.send(EDITOR + TOP + "-- ")
    clock = partial(own_clock, desktop.child.pid)
    seen = _do(desktop, actions, clock)
    killed = clock()
    desktop.child.kill(signal.SIGKILL)
    desktop.child.wait()
    desktop.child.close(force=True)
    _whole(file)
    recovered = _recovered(folder)
    for text in recovered:
        assert text.endswith(OLD), "recovery has another text"
    kept = max((_newest(text) for text in (file.read_text("utf-8"), *recovered)), default=-1)
    must = max((word for when, word in seen if when < killed - LOST_SECONDS - WRITING_SECONDS), default=-1)
    assert kept >= must, f"word {must} was seen long before the signal, {kept} is kept"
    if recovered:
        _restored(folder, file.name, _newest(recovered[0]))
    shutil.rmtree(folder / "state", ignore_errors=True)


def own_clock(pid: int) -> float:
    """Return the time in seconds, without what threads of a process, or we who empty its terminal, waited for a processor.

    A busy machine keeps a process from its work; that is no fault of the process. Where the system does not
    count such waiting, all time counts.
    """
    waited = 0
    for file in (*Path(f"/proc/{pid}/task").glob("*/schedstat"), Path("/proc/thread-self/schedstat")):
        with contextlib.suppress(OSError):  # a thread that has just ended
            waited += int(file.read_text("ascii").split()[1])
    return time.monotonic() - waited / 1e9


def _do(desktop: Terminal, actions: list[str], clock: Callable[[], float]) -> list[tuple[float, int]]:
    """Do it all; return when which word had come to the screen."""
    seen: list[tuple[float, int]] = []
    number = 0
    for action in actions:
        if action == "word":
            desktop.send(f"n{number:04} ")
            number += 1
        elif action in {"save", "run"}:
            desktop.send(CTRL_S if action == "save" else F5)
        desktop.read(0.05)
        seen.append((clock(), _newest(desktop.text)))
    return seen


def _newest(text: str) -> int:
    return max(map(int, _WORD.findall(text)), default=-1)


def _whole(file: Path) -> None:
    text = file.read_text("utf-8")
    assert text.endswith(OLD), "the file is cut"
    assert _TYPED.match(text.removesuffix(OLD)), "the file is neither old nor typed"


def _recovered(folder: Path) -> list[str]:
    found = [json.loads(file.read_text("utf-8")) for file in folder.glob("state/**/recovery-*.json")]
    return [tab["text"] for kept in found for tab in kept["tabs"] if tab["text"] is not None]


def _restored(folder: Path, name: str, newest: int) -> None:
    """Start again: the work is offered, and restored it is on the screen."""
    from tests.app.test_terminal import Terminal

    desktop = Terminal(folder, name, rows=16, columns=900)  # the whole line is seen
    try:
        desktop.until(lambda: "Unsaved work found" in desktop.text)
        desktop.answer("r", "Unsaved work found")
        desktop.until(lambda: _newest(desktop.text) == newest)
    finally:
        desktop.child.close(force=True)
