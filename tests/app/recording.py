"""Records the real program in a pseudo-terminal as docs/pictures/desire.gif: `make recording`."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from time import monotonic

import pexpect
import pyte

from .terminal_picture import Frame, save_animation

ROOT = Path(__file__).parents[2]
TARGET = ROOT / "docs" / "pictures" / "desire.gif"
COLUMNS, ROWS = 104, 28
SLOT_SECONDS = 0.08
"""Between two looks at the screen; what changes faster is one frame."""
START_SECONDS = 60.0
HOLD_SECONDS = 2.5
"""How long the last frame stays before the animation begins again."""

PROGRAM = """-- An epidemic: the sick infect the healthy, and recover
healthy = 620 | sick = 10
a = 0.001 | b = 0.07
TMAX = 60 | DT = 0.05 | NN = 601
title 'An epidemic'
drun

DYNAMIC
infected = a*healthy*sick
recovered = b*sick
d/dt healthy = -infected
d/dt sick = infected - recovered
d/dt immune = recovered
dispt healthy, sick, immune
"""
ENTER, SPACE, RIGHT, LEFT, F5, F11, ALT_L = "\r", " ", "\x1b[C", "\x1b[D", "\x1b[15~", "\x1b[23~", "\x1bl"

SCENE: tuple[tuple[str, float, int], ...] = (
    ("", 1.2, 1),  # the program
    (F5, 1.8, 1),  # its curves
    (ALT_L, 1.0, 1),
    (SPACE, 0.5, 1),
    (ENTER, 1.0, 1),  # a slider
    (LEFT, 0.16, 18),  # the curves follow it
    (RIGHT, 0.16, 30),
    (F11, 1.4, 1),  # the examples
    *((letter, 0.2, 1) for letter in "lorenz"),
    ("", 2.0, 1),
)
"""Keys, the seconds for which they are watched, how often."""


@dataclass
class Recorder:
    """A program in a pseudo-terminal, and every frame that it showed."""

    child: pexpect.spawn
    screen: pyte.Screen = field(default_factory=lambda: pyte.Screen(COLUMNS, ROWS))
    frames: list[tuple[float, Frame]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._stream = pyte.ByteStream(self.screen)
        self._began = monotonic()

    def watch(self, seconds: float, *, record: bool = True) -> None:
        """Follow the screen for a while; a frame is kept when it differs from the last one."""
        until = monotonic() + seconds
        while monotonic() < until:
            slot = monotonic() + SLOT_SECONDS
            while (left := slot - monotonic()) > 0:
                try:
                    self._stream.feed(self.child.read_nonblocking(65536, left))
                except pexpect.TIMEOUT:
                    break
            frame = Frame.of(self.screen)
            if record and (not self.frames or frame != self.frames[-1][1]):
                self.frames.append((monotonic() - self._began, frame))

    def wait_for(self, text: str) -> None:
        """Wait until the screen shows a text."""
        until = monotonic() + START_SECONDS
        while not any(text in line for line in self.screen.display):
            assert monotonic() < until, f"never saw {text!r}:\n" + "\n".join(self.screen.display)
            self.watch(SLOT_SECONDS, record=False)


def record(folder: Path) -> list[tuple[float, Frame]]:
    """Play the scene in a folder of its own; return the frames, each with its time in seconds."""
    (folder / "epidemic.src").write_text(PROGRAM, encoding="utf-8")
    places = {f"XDG_{kind}_HOME": str(folder / kind.lower()) for kind in ("CONFIG", "STATE")}
    environment = {
        **os.environ, **places, "HOME": str(folder), "TERM": "xterm-256color", "COLORTERM": "truecolor",
        "PYTHONPATH": str(ROOT), "LANG": "C.UTF-8",
    }  # fmt: skip
    child = pexpect.spawn(
        sys.executable, ["-m", "desire_tui", "epidemic.src"], cwd=folder, env=environment,
        dimensions=(ROWS, COLUMNS),
    )  # fmt: skip
    try:
        recorder = Recorder(child)
        recorder.wait_for("An epidemic")
        recorder.watch(1.0, record=False)
        for keys, seconds, times in SCENE:
            for _ in range(times):
                child.send(keys)
                recorder.watch(seconds)
    finally:
        child.close(force=True)
    return recorder.frames


def main() -> None:
    """Record, and write the animation."""
    folder = Path(tempfile.mkdtemp(prefix="desire-recording-"))
    try:
        frames = record(folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    save_animation(frames, TARGET, HOLD_SECONDS)
    sys.stdout.write(f"{TARGET}: {len(frames)} frames, {TARGET.stat().st_size / 1e6:.1f} MB\n")


if __name__ == "__main__":
    main()
