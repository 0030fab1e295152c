"""Tries inputs of a kind in child processes: an exception, a crash of native code and a hang are all faults."""

from __future__ import annotations

import multiprocessing
import os
import shutil
import signal
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from tests.fuzz import worker
from tests.fuzz.worker import LOG, Fault

if TYPE_CHECKING:
    from multiprocessing.connection import Connection
    from multiprocessing.context import ForkServerProcess

    from tests.fuzz.kinds import Input, Kind

_PROCESSES = multiprocessing.get_context("forkserver")
_PROCESSES.set_forkserver_preload(["tests.fuzz.worker", "desire_tui.engine.session.session"])
"""Processes are copies of one that has imported NumPy and the engine: what takes half a second else."""
_POLL_SECONDS = 0.2
_START_SECONDS = 60.0
"""Importing takes its time on a machine with much to do."""


@dataclass
class Report:
    """What became of a kind's inputs: `faults` has the first input's number of each signature."""

    kind: Kind
    tried: int = 0
    failed: int = 0
    seconds: float = 0.0
    faults: dict[str, tuple[int, Fault]] = field(default_factory=dict)

    def add(self, number: int, fault: Fault) -> None:
        """Count a failure."""
        self.failed += 1
        self.faults.setdefault(fault.signature, (number, fault))


def try_kind(
    kind: Kind, seed: int, *, first: int = 0, count: int | None, seconds: float, patience: float = 1.0
) -> Report:
    """Try inputs until `count` of them or the time is through; `patience`: how much longer each may take."""
    report = Report(kind)
    began = time.monotonic()
    number = first
    while (count is None or number < first + count) and time.monotonic() < began + seconds:
        last = number + kind.renewed_after
        if count is not None:
            last = min(last, first + count)
        number = _stretch(kind, seed, number, last, began + seconds, patience, report)
    report.tried = number - first
    report.seconds = time.monotonic() - began
    return report


def _stretch(
    kind: Kind, seed: int, first: int, last: int, until: float, patience: float, report: Report
) -> int:
    """Try inputs in one process; return the number of the first that was not tried."""
    folder = Path(tempfile.mkdtemp(prefix="desire-fuzz-"))
    at = _PROCESSES.Value("q", -1, lock=False)
    ours, theirs = _PROCESSES.Pipe(duplex=False)
    child = _PROCESSES.Process(target=worker.try_numbers, args=(kind, seed, first, last, at, folder, theirs))
    child.start()
    theirs.close()
    seen, since = -1, time.monotonic()
    try:
        while child.is_alive():
            _take(ours, report)
            now = time.monotonic()
            if at.value != seen:
                seen, since = at.value, now
            elif now - since > patience * (kind.seconds_most if seen >= 0 else _START_SECONDS):
                report.add(max(seen, first), Fault(f"hang {_place(folder, child)}", _log(folder)))
                return max(seen, first) + 1
            if now > until and seen >= 0:
                return max(at.value, first)
        _take(ours, report)
        if at.value < last:
            number = max(at.value, first)
            report.add(number, Fault(f"crash {child.exitcode} {_innermost(folder)}", _log(folder)))
            return number + 1
    finally:
        _end(child)
        ours.close()
        shutil.rmtree(folder, ignore_errors=True)
    return last


def _take(ours: Connection, report: Report) -> None:
    try:
        while ours.poll(_POLL_SECONDS):
            report.add(*ours.recv())
    except EOFError:
        time.sleep(0.01)


def _end(child: ForkServerProcess) -> None:
    if child.is_alive():
        child.kill()
    child.join()


def _place(folder: Path, child: ForkServerProcess) -> str:
    """Let a process that hangs say where."""
    if child.pid is not None:
        os.kill(child.pid, signal.SIGUSR1)
    time.sleep(0.5)
    return _innermost(folder)


def _log(folder: Path) -> str:
    path = folder / LOG
    return path.read_text("utf-8", "replace") if path.exists() else ""


def _innermost(folder: Path) -> str:
    """Return the innermost function of ours on the stack of a thread that did not get on."""
    text = _log(folder)
    _, _, current = text.rpartition("(most recent call first):")
    frames = [line.strip() for line in current.splitlines() if "desire_tui/" in line]
    if not frames:
        return "outside"
    file, _, place = frames[0].partition(", line ")
    name = Path(file.removeprefix("File ").strip('"')).name
    return f"{name}:{place.partition(' in ')[2]}"


class SingleInputs:
    """Tries single inputs, each in a process that the one before has survived."""

    def __init__(self, kind: Kind, seconds_most: float) -> None:
        self._kind, self._seconds = kind, seconds_most
        self._child: ForkServerProcess | None = None
        self._folder = Path()

    def fault(self, made: Input) -> Fault | None:
        """Return how an input fails."""
        if self._child is None:
            self._start()
        assert self._child is not None
        try:
            self._ours.send(made)
            if self._ours.poll(self._seconds):
                found: Fault | None = self._ours.recv()
                return found
            fault = Fault(f"hang {_place(self._folder, self._child)}", _log(self._folder))
        except (EOFError, BrokenPipeError, ConnectionResetError):
            self._child.join(5)
            code = self._child.exitcode
            fault = Fault(f"crash {code} {_innermost(self._folder)}", _log(self._folder))
        self.close()
        return fault

    def _start(self) -> None:
        self._folder = Path(tempfile.mkdtemp(prefix="desire-fuzz-"))
        self._ours, theirs = _PROCESSES.Pipe()
        self._child = _PROCESSES.Process(target=worker.try_inputs, args=(self._kind, self._folder, theirs))
        self._child.start()
        theirs.close()

    def close(self) -> None:
        """End the process."""
        if self._child is not None:
            _end(self._child)
            self._ours.close()
            shutil.rmtree(self._folder, ignore_errors=True)
            self._child = None
