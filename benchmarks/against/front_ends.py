"""What stands around runs: processes, edits and checks, calls from Python, the desktop."""

from __future__ import annotations

import asyncio
import os
import resource
import subprocess
import sys
import tempfile
from functools import partial
from itertools import count
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING

from benchmarks.against.runs import LORENZ, ladder
from benchmarks.against.work import wait_until_idle

if TYPE_CHECKING:
    from collections.abc import Callable

    from benchmarks.against.work import Prepared, Work

_ROTATION = "d/dt x = v\nd/dt v = -w*x\ndispt x, v\n"
PROGRAMS = {
    "hello.src": "write 'hello'\n",
    "small.src": "a = 10 | b = 8/3 | r = 28 | x = 1 | y = 1 | z = 1\nTMAX = 1 | DT = 0.001 | NN = 101\n"
    f"drun\nDYNAMIC\n{LORENZ}\n",
    "ladder.src": f"a = 1000 | b = 1000\nTMAX = 0.01 | DT = 0.0001 | NN = 3\ndrun\nDYNAMIC\n{ladder(700)}\n",
    "stiff.src": "x = 2 | irule 14 | ERMAX = 1e-5\nTMAX = 20 | DT = 0.01 | NN = 101\n"
    "drun\nDYNAMIC\nd/dt x = v\nd/dt v = 30*(1 - x*x)*v - x\ndispt x\n",
    "samples.src": "x = 1\nTMAX = 10 | DT = 0.001 | NN = 10001\ndrun\nDYNAMIC\nd/dt x = -x\ny = 2*x\n"
    "dispt x, y\n",
    "rotation.src": f"TMAX = 10 | DT = 0.01 | NN = 301 | w = 1 | x = 1\ndrun\nDYNAMIC\n{_ROTATION}",
    "long.src": f"w = 1 | x = 1\ndrun\nDYNAMIC\n{_ROTATION}"
    + "".join(f"y{n} = {n}*x\n" for n in range(1000)),
}


def _write_programs() -> None:
    for name, text in PROGRAMS.items():
        Path(name).write_text(text, encoding="utf-8")


# -- processes


def _process(*words: str) -> Prepared:
    _write_programs()
    return lambda: _start(words)


def _desire(*words: str) -> Prepared:
    return _process("-m", "desire_tui", *words)


def _without_stores(program: str) -> Prepared:
    """A first run on a machine: nothing is on disk."""
    _write_programs()

    def work() -> None:
        with tempfile.TemporaryDirectory() as folder:
            _start(("-m", "desire_tui", "run", program), XDG_CACHE_HOME=folder)

    return work


def _edited(command: str) -> Prepared:
    """A command on a program of which one line is different each time."""
    numbers = count(7)

    def work() -> None:
        Path("edited.src").write_text(_edit(next(numbers)), encoding="utf-8")
        _start(("-m", "desire_tui", command, "edited.src"))

    return work


def _start(words: tuple[str, ...], **environment: str) -> None:
    quiet = subprocess.DEVNULL
    subprocess.run([sys.executable, *words], check=True, stdout=quiet, env={**os.environ, **environment})


def _edit(number: int) -> str:
    lines = PROGRAMS["ladder.src"].splitlines()
    place = 100 + number % 997
    lines[place] = lines[place].replace("*(", f"*{number}*(")
    return "\n".join(lines) + "\n"


# -- in this process


def _edits_in_session() -> Prepared:
    from desire_tui.engine.session.session import Session
    from desire_tui.engine.source import Source

    session, numbers = Session(), count(7)
    session.erun(Source(PROGRAMS["ladder.src"], "work"))
    wait_until_idle()
    return lambda: session.erun(Source(_edit(next(numbers)), "work"))


def _check(program: str) -> Prepared:
    from desire_tui.engine.session.static_check import StaticChecker
    from desire_tui.engine.source import Source

    source = Source(PROGRAMS[program], "work")
    return lambda: StaticChecker().check(source, quick=False, seconds=60.0)


def _called(call: Callable[[], Prepared]) -> Prepared:
    """Call once, so that fast code is in where it comes."""
    work = call()
    work()
    wait_until_idle()
    return work


def _run() -> Prepared:
    import desire_tui

    return lambda: desire_tui.run(PROGRAMS["small.src"], set={"r": 27})


def _run_new_text() -> Prepared:
    import desire_tui

    numbers = count(1)
    return lambda: desire_tui.run(PROGRAMS["small.src"].replace("b*z", f"b*z*{next(numbers)}.5"))


def _model_run() -> Prepared:
    import desire_tui

    model = desire_tui.load(PROGRAMS["small.src"])
    return lambda: model.run(r=27)


def _sweep() -> Prepared:
    import desire_tui

    model = desire_tui.load(PROGRAMS["small.src"])
    values = [20 + k / 30 for k in range(300)]
    return lambda: model.sweep(r=values, keep="last")


def _study(threads: int, over: str) -> Prepared:
    import desire_tui

    kept = "z[end], max(x)"
    return lambda: desire_tui.study(PROGRAMS["small.src"], over={"r": over}, keep=kept, threads=threads)


def _analysis(word: str, program: str, request: str) -> Prepared:
    import desire_tui

    return lambda: desire_tui.analyse(word, PROGRAMS[program], request)


# -- the desktop


def _ready_in_a_terminal() -> Prepared:
    """From the start to the first key seen, in processor time of the desktop."""
    from benchmarks.bench_tui import Reader, folder_with

    def work() -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with folder_with("small.src", PROGRAMS["small.src"]) as folder:
            reader = Reader(folder, "small.src", root=Path(os.environ["PYTHONPATH"]))
            reader.until("small.src")
            reader.child.send("k")
            while "> k" not in reader.prompt:
                reader.read(0.2)
            reader.child.kill(9)
            reader.child.close(force=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    return work


def _on_desktop(program: str, act: Callable[..., object]) -> Prepared:
    """An act on a desktop without a terminal; its start is not measured."""
    _write_programs()

    async def once() -> float:
        from desire_tui.app import DesireApp

        app = DesireApp([Path(program)])
        async with app.run_test(size=(120, 40)) as pilot:
            while not app.is_ready:
                await pilot.pause(0.02)
            return await act(app, pilot)

    return lambda: asyncio.run(once())


async def _type_keys(_app, pilot) -> float:
    await pilot.press("alt+e")
    began = process_time()
    for letter in "abcdefghij" * 2:
        await pilot.press(letter)
    await pilot.pause(0.3)
    return process_time() - began


async def _live_runs(app, pilot) -> float:
    app.do("run.start")
    await pilot.pause(0.5)
    began = process_time()
    for number in range(30):
        app.live_mode.ask({"w": 1 + 0.001 * number}, overlay=False)
        await pilot.pause(0.02)
        while app.engine.is_busy:
            await pilot.pause(0.01)
    return process_time() - began


FRONT_ENDS: dict[str, Work] = {
    "process: import desire_tui": partial(_process, "-c", "import desire_tui"),
    "process: import of its Session": partial(_process, "-c", "import desire_tui; desire_tui.Session"),
    "process: desire --version": partial(_desire, "--version"),
    "process: desire help": partial(_desire, "help", "drun"),
    "process: desire run, hello": partial(_desire, "run", "hello.src"),
    "process: desire run, Lorenz": partial(_desire, "run", "small.src"),
    "process: desire run, stiff": partial(_desire, "run", "stiff.src"),
    "process: desire run, 1401 equations": partial(_desire, "run", "ladder.src"),
    "process: desire run, 1 line of 1401 edited": partial(_edited, "run"),
    "process: desire run, two programs": partial(_desire, "run", "small.src", "stiff.src"),
    "process: desire run, Lorenz, nothing stored": partial(_without_stores, "small.src"),
    "process: desire run, stiff, nothing stored": partial(_without_stores, "stiff.src"),
    "process: desire run, 1401, nothing stored": partial(_without_stores, "ladder.src"),
    "process: desire check, Lorenz": partial(_desire, "check", "small.src"),
    "process: desire check, 1401 equations": partial(_desire, "check", "ladder.src"),
    "process: desire check, 1 line of 1401 edited": partial(_edited, "check"),
    "process: desire run --png": partial(_desire, "run", "small.src", "--png", "a.png"),
    "process: desire run --svg": partial(_desire, "run", "small.src", "--svg", "a.svg"),
    "process: desire run --plot": partial(_desire, "run", "small.src", "--plot"),
    "process: desire run --csv, 10,001 rows": partial(_desire, "run", "samples.src", "--csv", "a.csv"),
    "process: desire run --json, 10,001 rows": partial(_desire, "run", "samples.src", "--json", "a.json"),
    "process: desire run --npz, 10,001 rows": partial(_desire, "run", "samples.src", "--npz", "a.npz"),
    "process: desire spectrum": partial(_desire, "spectrum", "samples.src", "x"),
    "process: desire study": partial(
        _desire, "study", "small.src", "--over", "r=20:30:100", "--keep", "z[end]"
    ),
    "1401 equations, 1 line edited, in a session": _edits_in_session,
    "check: 1401 equations, again": partial(_check, "ladder.src"),
    "check: Lorenz, again": partial(_check, "small.src"),
    "Python: desire_tui.run": partial(_called, _run),
    "Python: desire_tui.run, new text": partial(_called, _run_new_text),
    "Python: model.run": partial(_called, _model_run),
    "Python: model.sweep of 300": partial(_called, _sweep),
    "Python: study of 30 runs": partial(_called, partial(_study, 1, "20:30:30")),
    "Python: study of 1,000 runs": partial(_called, partial(_study, 1, "20:30:1000")),
    "Python: study of 1,000 runs, 2 threads": partial(_called, partial(_study, 2, "20:30:1000")),
    "Python: spectrum": partial(_called, partial(_analysis, "spectrum", "samples.src", "x")),
    "Python: minimise": partial(
        _called, partial(_analysis, "minimise", "small.src", "max(z) over r in [20, 30]")
    ),
    "desktop: ready in a terminal": _ready_in_a_terminal,
    "desktop: 20 keys into 1,000 lines": partial(_on_desktop, "long.src", _type_keys),
    "desktop: 30 live runs": partial(_on_desktop, "rotation.src", _live_runs),
}
