"""The process that tries inputs: what it dies of is seen by the one that started it."""

from __future__ import annotations

import faulthandler
import os
import signal
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

    from tests.fuzz.kinds import Input, Kind

LOG = "traceback.log"


@dataclass(frozen=True)
class Fault:
    """How an input failed; two with the same `signature` are taken for the same fault."""

    signature: str
    detail: str


def fault_of(kind: Kind, made: Input) -> Fault | None:
    """Check an input in this process."""
    try:
        kind.module.check(made)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001 - any exception is a finding
        frames = traceback.extract_tb(error.__traceback__)
        own = [frame for frame in frames if "desire_tui" in frame.filename] or frames
        place = f"{Path(own[-1].filename).name}:{own[-1].name}"
        words = str(error)[:80] if isinstance(error, AssertionError) else ""
        return Fault(f"{type(error).__name__} {place} {_without_digits(words)}", traceback.format_exc())
    return None


def _without_digits(words: str) -> str:
    return "".join("#" if c.isdigit() else c for c in words)


def prepare(folder: Path) -> None:
    """Work in `folder`, with nothing of the user's but the cache; a crash or `SIGUSR1` writes a traceback beside it."""
    work = folder / "work"
    work.mkdir(exist_ok=True)
    os.chdir(work)
    os.environ.setdefault("XDG_CACHE_HOME", str(Path.home() / ".cache"))  # parse tables take seconds to make
    for name in ("CONFIG", "STATE", "DATA"):
        os.environ[f"XDG_{name}_HOME"] = str(folder / name.lower())
    os.environ["HOME"] = str(work)
    for name in ("TMUX", "NO_COLOR", "VISUAL", "EDITOR"):
        os.environ.pop(name, None)
    log = (folder / LOG).open("w")
    faulthandler.enable(log)
    faulthandler.register(signal.SIGUSR1, log)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides
    null = os.open(os.devnull, os.O_RDWR)
    for standard in (0, 1, 2):
        os.dup2(null, standard)


def try_numbers(
    kind: Kind, seed: int, first: int, last: int, at: Any, folder: Path, parent: Connection
) -> None:
    """Try inputs, showing the parent by `at` which one it is, and sending faults with their numbers."""
    prepare(folder)
    _ = kind.module  # imports and, at the very first start, parse tables are no input's time
    parse(Source("x = 1", "t"))
    for number in range(first, last):
        at.value = number
        fault = fault_of(kind, kind.generate(seed, number))
        if fault is not None:
            parent.send((number, fault))
    at.value = last
    parent.close()
    os._exit(0)  # threads that a fault left behind would keep it


def try_inputs(kind: Kind, folder: Path, parent: Connection) -> None:
    """Answer each input with its fault, until the parent is gone."""
    prepare(folder)
    while True:
        try:
            made = parent.recv()
        except EOFError:
            os._exit(0)
        parent.send(fault_of(kind, made))
