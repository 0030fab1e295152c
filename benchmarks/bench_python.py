"""Runs from Python beside the same runs in a loop of the script. `python -m benchmarks.bench_python`

Ratios of medians, measured in turn: 1 is a pass of the script's loop with a `drun` in it. Then what threads
gain, how many there are, whether 2,000 runs live in limited address space, and what the import costs.
"""

from __future__ import annotations

import subprocess
import sys
import threading
from functools import partial
from statistics import median
from time import perf_counter, sleep
from typing import TYPE_CHECKING

import numpy as np

import desire_tui

if TYPE_CHECKING:
    from collections.abc import Callable

ROUNDS = 7
MODELS = {
    "decay, 100 steps": (300, "x = 1 | TMAX = 1 | DT = 0.01 | NN = 101\n", "d/dt x = -k*x\ndispt x\n"),
    "Lorenz, 1,000,000 steps": (
        12,
        "x = 1 | y = 1 | z = 1 | TMAX = 10 | DT = 0.00001 | NN = 101 | irule 3\n",
        "d/dt x = 10*(y - x)\nd/dt y = x*(28 + k - z) - y\nd/dt z = x*y - 2.6667*z\ndispt x\n",
    ),
}
LIMIT = """
import resource, threading
resource.setrlimit(resource.RLIMIT_AS, (16_000_000 * 1024,) * 2)
import desire_tui
text = "k = 1 | x = 1 | TMAX = 1\\ndrun\\nDYNAMIC\\nd/dt x = -k*x\\ndispt x\\n"
model = desire_tui.load(text)
for number in range(1000):
    model.run(k=number)
    assert desire_tui.run(text, set={"k": number}).status == "done"
sessions = [desire_tui.Session() for _ in range(6)]
print(threading.active_count())
"""


def program(name: str, *, loop: bool) -> str:
    count, script, body = MODELS[name]
    starts = "x = 1 | y = 1 | z = 1 | t = 0"
    runs = f"for i = 1 to {count}\nk = i/{count} | {starts}\ndrun\nnext\n" if loop else "drun\n"
    return f"k = 1 | y = 1 | z = 1 | {script}{runs}DYNAMIC\n{body}"


def ratios(works: dict[str, Callable[[], object]]) -> dict[str, float]:
    """Return the median seconds of each work, measured in turn."""
    times: dict[str, list[float]] = {name: [] for name in works}
    for _ in range(ROUNDS):
        for name, work in works.items():
            began = perf_counter()
            work()
            times[name].append(perf_counter() - began)
    return {name: median(found) for name, found in times.items()}


def measure(name: str) -> None:
    text, loop = program(name, loop=False), program(name, loop=True)
    count = MODELS[name][0]
    model, values = desire_tui.load(text), np.arange(1, count + 1) / count

    def threads(count: int, work: Callable[[float], object]) -> None:
        def part(number: int) -> None:
            for k in values[number::count]:
                work(float(k))

        started = [threading.Thread(target=part, args=(number,)) for number in range(count)]
        for thread in started:
            thread.start()
        for thread in started:
            thread.join()

    def whole(k: float) -> object:
        return desire_tui.run(text, set={"k": k})

    works: dict[str, Callable[[], object]] = {
        "a loop in the script": lambda: desire_tui.run(loop),
        "model.run(k=…)": lambda: [model.run(k=k) for k in values],
        "model.sweep(k=[…])": lambda: model.sweep(k=values),
        "model.sweep(k=[…], keep='last')": lambda: model.sweep(k=values, keep="last"),
        "desire_tui.run(text, set=…)": lambda: [whole(k) for k in values],
        "… from 2 threads": lambda: threads(2, whole),
        "… from 4 threads": lambda: threads(4, whole),
    }
    for work in works.values():
        work()
    sleep(0.5)  # fast code
    found = ratios(works)
    base = found["a loop in the script"]
    for what, seconds in found.items():
        print(f"{name:24} {what:34} {1e6 * seconds / count:9.1f} µs a run {seconds / base:8.2f}")


def of_a_process(code: str) -> float:
    began = perf_counter()
    subprocess.run([sys.executable, "-c", code], check=True)
    return perf_counter() - began


def main() -> None:
    before = threading.active_count()
    for name in MODELS:
        measure(name)
    print(f"threads: {threading.active_count()} of which {before} before (compiler, heartbeat)")
    done = subprocess.run([sys.executable, "-c", LIMIT], capture_output=True, text=True, check=False)
    told = done.stdout.strip() or done.stderr.strip().splitlines()[-1]
    print(f"2,000 runs under ulimit -v 16000000: status {done.returncode}, threads {told}")
    codes = ("pass", "import desire_tui")
    starts = {code: partial(of_a_process, code) for code in codes}
    found = ratios(starts)
    own = 1e3 * (found["import desire_tui"] - found["pass"])
    print(f"import desire_tui: {own:.1f} ms beside Python's own start")


if __name__ == "__main__":
    main()
