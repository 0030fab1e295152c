"""A session at one moment, for status bars and progress lines."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from desire_tui.engine.runtime.run_record import RunRecord


class State(Enum):
    """What the session is doing."""

    IDLE = "idle"
    SCRIPT = "script"
    """Walking the script."""
    COMPILING = "compiling"
    RUNNING = "running"
    """Inside a simulation run."""
    PAUSED = "paused"
    """Ctrl-C; `resume` or `end` goes on."""
    STOPPED = "stopped"
    """At a STOP, or tracing; `go` goes on."""
    ASKING = "waiting for input"


@dataclass(frozen=True, slots=True)
class Status:
    """A snapshot; cheap to make, safe to ask for from any thread.

    `run` counts the runs since the program started; times are in the program's unit; `steps_per_second` is
    the mean over the run that is going on or the last one, in steps per real second.
    """

    state: State
    run: int
    segment: str | None
    t: float
    t0: float
    t_max: float
    steps: int
    steps_per_second: float
    rule: int
    dt: float
    program: str
    """Name of the active program's source, empty without one."""
    edited: bool = False
    """The program in memory changed since the script stopped: `go` is refused."""
    record: RunRecord | None = None
    """The run that goes on, or the last one: its counters, and why and when it ended."""

    runs: int | None = None
    """How many runs there will be in all, where the script's loops show it."""

    @property
    def run_text(self) -> str:
        """`3 of 5`, or `3` where the end is not known or there is but one run."""
        return f"{self.run} of {self.runs}" if self.runs is not None and self.runs > 1 else f"{self.run}"

    @property
    def progress(self) -> float:
        """Part of TMAX that the run has covered, 0 … 1."""
        return min(max((self.t - self.t0) / self.t_max, 0.0), 1.0) if self.t_max else 0.0
