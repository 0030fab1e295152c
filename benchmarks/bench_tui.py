"""The desktop, measured through a pseudo-terminal as a user meets it. `python -m benchmarks.bench_tui`

Prints a table: time until the desktop is ready, first dot after `zz`, frames a second, kilobytes a frame,
key echo during a run with 12 curves (median, worst), the same with a terminal that reads 200 KB/s only,
and the time to leave.
"""

from __future__ import annotations

import os
import re
import select
import statistics
import sys
import tempfile
import time
from pathlib import Path

import pexpect
import pyte

ROOT = Path(__file__).parents[1]
COLUMNS, ROWS = 120, 40
RUN_SECONDS = 6.0
ENOUGH_SECONDS = 60.0
SETTLE_SECONDS = 2.0
"""Between the first picture and `zz`: nobody types faster, and the engine is imported meanwhile."""
KEYS = 40
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
    from desire_tui.engine.session import Session
    from desire_tui.engine.source import Source

    session = Session()
    for t_max in (10.0, 100.0):  # the first run also compiles
        session.erun(Source(program(curves, t_max)))
    return program(curves, float(f"{seconds * 100.0 / session.runs[-1].seconds:.3g}"))


class Reader:
    """A terminal that answers what a modern one answers, and may be slow."""

    def __init__(self, folder: Path, file: str, bytes_per_second: float | None = None) -> None:
        env = {
            **os.environ, "TERM": "xterm-256color", "COLORTERM": "truecolor", "PYTHONPATH": str(ROOT),
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
    def prompt(self) -> str:
        """The row of the command line."""
        return self.screen.display[ROWS - 2]

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


def measure(curves: int, bytes_per_second: float | None = None) -> dict[str, float]:
    """Run one desktop through its paces."""
    with tempfile.TemporaryDirectory(prefix="desire-bench-") as name:
        folder = Path(name)
        (folder / "waves.src").write_text(lasting(curves, ENOUGH_SECONDS))
        (folder / "config" / "desire-tui").mkdir(parents=True)
        (folder / "config" / "desire-tui" / "config.toml").write_text("completion_after = 0\n")
        reader = Reader(folder, "waves.src", bytes_per_second)
        ready = reader.until("waves.src") - reader.started
        settle = time.perf_counter() + SETTLE_SECONDS
        while time.perf_counter() < settle:
            reader.read(0.1)
        reader.child.send("zz")
        reader.until("> zz")
        sent = time.perf_counter()
        reader.child.send("\r")
        seen = b""
        while not DOT.search(seen):
            seen = (seen + reader.read(0.5))[-1 << 16 :]
        first = time.perf_counter() - sent
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
        left = time.perf_counter()
        reader.child.send("\x11")
        while reader.child.isalive() and time.perf_counter() - left < 20:
            reader.read(0.05, draw=False)
        away = time.perf_counter() - left
        reader.child.close(force=True)
    return {
        "ready s": ready, "first dot s": first, "frames/s": frames / elapsed, "KB/frame": kilobytes,
        "echo median ms": 1000 * statistics.median(echo), "echo worst ms": 1000 * max(echo), "exit s": away,
    }  # fmt: skip


WANTED = {
    "ready s": "≤ 0.6", "first dot s": "≤ 0.1", "frames/s": "≥ 20", "KB/frame": "≤ 6",
    "echo median ms": "≤ 50", "echo worst ms": "≤ 150", "exit s": "≤ 1",
}  # fmt: skip


def main() -> None:
    """Print the table."""
    cases = {"4 curves": (4, None), "12 curves": (12, None), "12, 200 KB/s": (12, SLOW_BYTES_PER_SECOND)}
    results = {name: measure(*case) for name, case in cases.items()}
    load = os.getloadavg()[0]
    print(
        f"The desktop at {COLUMNS}×{ROWS} through a pseudo-terminal ({os.cpu_count()} cores, load {load:.1f})"
    )
    print(f"{'':16s}{'wanted':>10s}" + "".join(f"{name:>15s}" for name in results))
    for key, wanted in WANTED.items():
        print(f"{key:16s}{wanted:>10s}" + "".join(f"{result[key]:15.3g}" for result in results.values()))


if __name__ == "__main__":
    main()
