"""The desktop, measured through a pseudo-terminal as a user meets it. `python -m benchmarks.bench_tui [RUNS]`

Prints a table, medians of RUNS (default 3): time until the desktop is ready — a key typed as soon as there is
something to see stands on the screen —, first dot of a curve after `zz` and Enter, frames a second, kilobytes
a frame, key echo during a run with 12 curves (median, worst), the same with a terminal that reads 200 KB/s
only, and the time to leave. Then keys typed into the middle of a program of 1,000 lines: until a key is seen,
and the app's own work for it (processor time of all its threads).
"""

from __future__ import annotations

import os
import re
import select
import statistics
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import pexpect
import pyte

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[1]
COLUMNS, ROWS = 120, 40
RUN_SECONDS = 6.0
ENOUGH_SECONDS = 60.0
SETTLE_SECONDS = 2.0
"""Between the first picture and `zz`: nobody types faster, and the engine is imported meanwhile."""
KEYS = 40
RUNS = 3
SLOW_BYTES_PER_SECOND = 200_000
DOT = re.compile(rb"\xe2[\xa0-\xa3][\x80-\xbf]")
"""A braille pattern, U+2800 … U+28FF, in UTF-8."""
FRAME = b"\x1b[?2026h"


def program(curves: int, t_max: float) -> str:
    """Return sine waves of different heights, about six periods in all."""
    lines = [f"TMAX = {t_max:g} | DT = 0.0001 | NN = 20001", "irule 3 | scale = 1"]
    lines += [
        f"a{n} = 0.9 - 0.07*{n} | x{n} = a{n} | w{n} = {40 / t_max:g}*(1 + 0.02*{n})" for n in range(curves)
    ]
    lines += ["drun", "DYNAMIC"]
    for n in range(curves):
        lines += [f"d/dt x{n} = v{n}", f"d/dt v{n} = -w{n}*w{n}*x{n}"]
    lines.append("dispt " + ", ".join(f"x{n}" for n in range(curves)))
    return "\n".join(lines) + "\n"


def lasting(curves: int, seconds: float) -> str:
    """Return the program so long that its run takes about so many seconds here: curves grow all the time."""
    from desire_tui.engine.session.session import Session
    from desire_tui.engine.source import Source

    session = Session()
    for t_max in (10.0, 100.0):  # the first run also compiles
        session.erun(Source(program(curves, t_max)))
    return program(curves, float(f"{seconds * 100.0 / session.runs[-1].seconds:.3g}"))


class Reader:
    """A terminal that answers what a modern one answers, and may be slow."""

    def __init__(
        self, folder: Path, file: str, bytes_per_second: float | None = None, *, root: Path = ROOT
    ) -> None:
        env = {
            **os.environ, "TERM": "xterm-256color", "COLORTERM": "truecolor", "PYTHONPATH": str(root),
            "XDG_CONFIG_HOME": str(folder / "config"), "XDG_STATE_HOME": str(folder / "state"),
        }  # fmt: skip
        env.pop("TMUX", None)
        self.started = time.perf_counter()
        self.child = pexpect.spawn(
            sys.executable, ["-m", "desire_tui", file], env=env, cwd=str(folder), dimensions=(ROWS, COLUMNS)
        )
        self.child.delaybeforesend = None
        self.screen = pyte.Screen(COLUMNS, ROWS)
        self.stream = pyte.ByteStream(self.screen)
        self.bytes = 0
        self.rate = bytes_per_second
        self._due = time.perf_counter()
        self._answered = False

    def read(self, seconds: float, *, draw: bool = True) -> bytes:
        """Read for so long at most; returns as soon as something came."""
        if self.rate:
            now = time.perf_counter()
            if self._due > now:
                time.sleep(min(self._due - now, seconds))
                if self._due > time.perf_counter():
                    return b""
        ready, _, _ = select.select([self.child.child_fd], [], [], seconds)
        if not ready:
            return b""
        try:
            data = os.read(self.child.child_fd, 2048 if self.rate else 1 << 20)
        except OSError:
            return b""
        if self.rate:
            self._due = max(self._due, time.perf_counter() - 0.01) + len(data) / self.rate
        if not self._answered and b"?2026$p" in data:
            self._answered = True
            self.child.send("\x1b[?2026;2$y")
        self.bytes += len(data)
        if draw:
            self.stream.feed(data)
        return data

    @property
    def work(self) -> float:
        """Processor seconds of the app so far; nan where there is no /proc."""
        try:
            text = Path(f"/proc/{self.child.pid}/stat").read_text(encoding="ascii")
        except OSError:
            return float("nan")
        user, system = text.rsplit(")", 1)[1].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def settle(self, seconds: float) -> None:
        """Read for so long."""
        end = time.perf_counter() + seconds
        while time.perf_counter() < end:
            self.read(0.05)

    def leave(self) -> float:
        """Press Ctrl+Q; returns the seconds until the process is gone."""
        left = time.perf_counter()
        self.child.send("\x11")
        while self.child.isalive() and time.perf_counter() - left < 20:
            self.read(0.05, draw=False)
        away = time.perf_counter() - left
        self.child.close(force=True)
        return away

    @property
    def prompt(self) -> str:
        """The rows at the bottom: the command line is one of them, framed or not."""
        return "\n".join(self.screen.display[-4:])

    def until(self, text: str, patience: float = 60.0) -> float:
        """Read until the screen shows the text; returns the moment."""
        end = time.perf_counter() + patience
        while text not in "\n".join(self.screen.display):
            if time.perf_counter() > end:
                raise TimeoutError(text + "\n" + "\n".join(self.screen.display))
            self.read(0.5)
        return time.perf_counter()


def echo_times(reader: Reader) -> list[float]:
    """Type into the command line during the run; seconds until each letter is seen."""
    times = []
    typed = ""
    for number in range(KEYS):
        letter = "abcdefghij"[number % 10]
        typed += letter
        sent = time.perf_counter()
        reader.child.send(letter)
        while f"> {typed}" not in reader.prompt and time.perf_counter() - sent < 10:
            reader.read(0.2)
        times.append(time.perf_counter() - sent)
        pause = time.perf_counter() + 0.03 + 0.004 * number
        while time.perf_counter() < pause:
            reader.read(0.01)
    return times


@contextmanager
def folder_with(name: str, text: str) -> Iterator[Path]:
    """Make a folder with a program and a configuration: no lists of words over what is typed."""
    with tempfile.TemporaryDirectory(prefix="desire-bench-") as path:
        folder = Path(path)
        (folder / name).write_text(text)
        (folder / "config" / "desire-tui").mkdir(parents=True)
        (folder / "config" / "desire-tui" / "config.toml").write_text("completion_after = 0\n")
        yield folder


def measure(text: str, bytes_per_second: float | None = None) -> dict[str, float]:
    """Run one desktop through its paces."""
    with folder_with("waves.src", text) as folder:
        reader = Reader(folder, "waves.src", bytes_per_second)
        reader.until("waves.src")
        reader.child.send("k")
        while "> k" not in reader.prompt:
            reader.read(0.2)
        ready = time.perf_counter() - reader.started
        reader.child.send("\x7f")
        reader.settle(SETTLE_SECONDS)
        reader.child.send("zz")
        reader.until("> zz")
        sent = time.perf_counter()
        reader.child.send("\r")
        seen = [b""]
        while not DOT.search(seen[-2][-2:] + seen[-1] if len(seen) > 1 else seen[-1]):
            seen.append(reader.read(0.5, draw=False))  # pyte, slower than a terminal, looks afterwards
        first = time.perf_counter() - sent
        reader.stream.feed(b"".join(seen))
        reader.until("running")
        reader.bytes, began = 0, time.perf_counter()
        unseen = []  # pyte is slower than a terminal: it looks at the frames afterwards
        while time.perf_counter() - began < RUN_SECONDS:
            unseen.append(reader.read(0.1, draw=False))
        elapsed = time.perf_counter() - began
        frames = sum(bool(DOT.search(part)) for part in b"".join(unseen).split(FRAME))
        kilobytes = reader.bytes / max(frames, 1) / 1000
        reader.stream.feed(b"".join(unseen))
        echo = echo_times(reader)
        away = reader.leave()
    return {
        "ready s": ready, "first dot s": first, "frames/s": frames / elapsed, "KB/frame": kilobytes,
        "echo median ms": 1000 * statistics.median(echo), "echo worst ms": 1000 * max(echo), "exit s": away,
    }  # fmt: skip


def long_program() -> str:
    """Return a ladder of 1,000 lines; line 500 is there to be typed into."""
    lines = ["TMAX = 1 | DT = 0.001 | NN = 11", "drun", "DYNAMIC"]
    lines += [f"d/dt x{n} = -x{n} + 0.5*x{max(n - 1, 1)}" for n in range(1, 997)]
    lines.insert(499, "here = ")
    return "\n".join([*lines, ""])


def measure_editor() -> dict[str, float]:
    """Type into the middle of a long program."""
    with folder_with("long.src", long_program()) as folder:
        reader = Reader(folder, "long.src")
        reader.until("long.src")
        reader.settle(SETTLE_SECONDS)
        reader.child.send("line 500\r")
        reader.until("here =")
        for key in ("\x1be", "\x1b[F"):  # to the editor, to the line's end
            reader.child.send(key)
            reader.settle(0.3)
        reader.settle(SETTLE_SECONDS)
        work, times, typed = reader.work, [], ""
        for number in range(KEYS):
            typed += "abcdefghij"[number % 10]
            sent = time.perf_counter()
            reader.child.send(typed[-1])
            while f"here = {typed}" not in "\n".join(reader.screen.display):
                reader.read(0.2)
            times.append(time.perf_counter() - sent)
            reader.settle(0.1)
        work = reader.work - work
        reader.child.kill(9)
        reader.child.close(force=True)
    return {
        "key median ms": 1000 * statistics.median(times), "key worst ms": 1000 * max(times),
        "work a key ms": 1000 * work / KEYS,
    }  # fmt: skip


WANTED = {
    "ready s": "≤ 0.6", "first dot s": "≤ 0.1", "frames/s": "≥ 28", "KB/frame": "≤ 6",
    "echo median ms": "≤ 50", "echo worst ms": "≤ 150", "exit s": "≤ 1",
    "key median ms": "≤ 50", "key worst ms": "≤ 150", "work a key ms": "≤ 12",
}  # fmt: skip


def main() -> None:
    """Print the table."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else RUNS
    cases = {"4 curves": (4, None), "12 curves": (12, None), "12, 200 KB/s": (12, SLOW_BYTES_PER_SECOND)}
    texts = {curves: lasting(curves, ENOUGH_SECONDS) for curves in (4, 12)}
    results: dict[str, list[dict[str, float]]] = {name: [] for name in (*cases, "1,000 lines")}
    for _ in range(runs):
        for name, (curves, rate) in cases.items():
            results[name].append(measure(texts[curves], rate))
        results["1,000 lines"].append(measure_editor())
    load = os.getloadavg()[0]
    print(
        f"The desktop at {COLUMNS}×{ROWS} through a pseudo-terminal, medians of {runs} "
        f"({os.cpu_count()} cores, load {load:.1f})"
    )
    print(f"{'':16s}{'wanted':>10s}" + "".join(f"{name:>15s}" for name in results))
    for key, wanted in WANTED.items():
        row = (
            f"{statistics.median(one[key] for one in all_of):15.3g}" if key in all_of[0] else " " * 15
            for all_of in results.values()
        )
        print(f"{key:16s}{wanted:>10s}" + "".join(row))


if __name__ == "__main__":
    main()
