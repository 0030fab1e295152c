"""Small programs run by either back end, by quick or by fast code."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass

import numpy as np
import pytest

from desire_tui.engine import disk_cache
from desire_tui.engine.codegen import native_model
from desire_tui.engine.codegen.backend import NativeBackend
from desire_tui.engine.codegen.jit import compiler
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.reference.backend import ReferenceBackend
from desire_tui.engine.runtime.run_memory import Ended, RunMemory
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from desire_tui.engine.values import DT, T


@dataclass
class Made:
    """A finished run: its samples, and the values it left behind."""

    rows: np.ndarray
    session: Session
    record: object

    def array(self, name):
        quantity = self.session.values.find(name)
        return np.array(self.session.values.view(quantity))

    def scalar(self, name):
        return self.session.values.cells[self.session.values.find(name).slot]


def run(text, backend="native"):
    """Run a program in a session of its own."""
    session = Session(backend=backend)
    session.erun(Source(text))
    record = session.runs[-1]
    return Made(record.rows[: record.count].copy(), session, record)


@pytest.fixture(params=["quick", "arrays", "registers"])
def storage(request, monkeypatch, quick_code_only):
    """Which code tests run: as compiled first, well compiled as for large models, or out of registers."""
    if request.param == "arrays":
        monkeypatch.setattr(native_model, "SMALL", -1)
    return request.param


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Where compiled code is kept."""
    machine()
    monkeypatch.setattr(disk_cache, "_path", lambda name: str(tmp_path / "cache" / name))
    return tmp_path / "cache"


@pytest.fixture
def compiled(monkeypatch):
    """Levels of the modules compiled from now on."""
    translate, levels = compiler._object_file, []

    def counted(text, level, **how):
        levels.append(level)
        return translate(text, level, **how)

    monkeypatch.setattr(compiler, "_object_file", counted)
    return levels


def memory_for(values, segment, *, t_max, dt, nn, **more):
    """Return a run's memory and the rows that belong to it, as `runtime.simulator` sets them up."""
    rows = np.zeros((nn + 2, 1 + len(segment.columns)))
    counters, lags = np.zeros(8, np.int64), np.zeros(8, np.int64)
    t = values.cells[T]
    values.assign(DT, dt)
    settings = {
        "t_start": t, "t_max": t_max, "comint": t_max / (nn - 1), "t_base": t, "dt_base": dt, "nn": nn, "every": 1,
        "dt_max": t_max / (nn - 1), "dt_min": dt / 16, "error_max": 1e-3, "error_min": 1e-5, "error_one": 1.0,
        "row_limit": nn + 2,
    }  # fmt: skip
    memory = RunMemory(
        values=values.address, rows=rows.ctypes.data, counters=counters.ctypes.data, lags=lags.ctypes.data,
        random=values.random.ctypes.data, **(settings | more),
    )  # fmt: skip
    memory.keep = (rows, counters, lags)
    return memory, rows


def advance_to_end(made, memory):
    """Call until the run ends."""
    while True:
        ended = made.advance(memory)
        if ended is not Ended.RUNNING:
            return ended
        memory.row_limit = memory.row + 1


def improve(made):
    """Compile the fast code now."""
    for _ in made.improve():
        pass


__all__ = ["NativeBackend", "ReferenceBackend", "ctypes"]
