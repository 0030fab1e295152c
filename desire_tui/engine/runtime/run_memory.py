"""What a run knows between two native calls: one C structure that both back ends read and write.

A back end's `advance(memory)` runs language.md 8.2 from where `memory` stands until `row_limit` rows of
samples are written, `stop` is set, the run ends, or a fault shows. Everything it needs to go on later is
here or in the values (states, t, DT, hold variables), so that one back end may take over from another at
any return.
"""

from __future__ import annotations

import ctypes
from enum import IntEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.lowered.statements import Where
    from desire_tui.engine.runtime.headway import Standstill


class Phase(IntEnum):
    """Where `advance` goes on."""

    AT_POINT = 0
    """At a communication point: pass(COMM, STEP) comes next."""
    IN_STEP = 1
    """Inside a communication interval at a step's start: pass(-, STEP) comes next."""
    ENDED = 2
    AFTER_POINT = 3
    """Behind a communication point whose row filled the rows: the first step of the interval comes next.
    The values are as sampled; k1 is kept by the back end that ran the pass, which must also be the one to
    go on."""


class Ended(IntEnum):
    """Why `advance` came back."""

    RUNNING = 0
    """`row_limit` reached; call again."""
    TMAX = 1
    TERM = 2
    """`term` number `which` fired."""
    STOPPED = 3
    """`stop` was set; memory is in a state from which the run can be resumed."""
    NOT_FINITE = 4
    """State number `which` (or column number -1 - `which`, one that states depend on) is inf or nan."""
    DEADLOCK = 5
    """Variable step: error 94, state number `which`."""
    SOLVER = 6
    """CVODE gave up: `which` is its flag."""
    STALLED = 7
    """A step of DT would not take t any further; variable step: state number `which` asks for it."""
    CHATTERS = 8
    """A switch went to and fro and held t up; the model puts what it is into the memory's `culprit`."""
    ZENO = 9
    """Event number `which` comes ever faster."""
    FULL = 10
    """The room for histories of delays is used up: the model makes it larger and goes on."""
    NO_HEADWAY = 11
    """The run would not end in days: the memory's `standstill` says why."""


class RunMemory(ctypes.Structure):
    """The structure. Pointers are addresses; times are in the program's unit."""

    _fields_ = (
        ("values", ctypes.c_uint64),  # address of slot 0
        ("rows", ctypes.c_uint64),  # address of the sample rows: t, then the requested columns
        ("counters", ctypes.c_uint64),  # int64 positions of store/get/delay lines
        ("lags", ctypes.c_uint64),  # int64 lag of each delay line, by counter
        ("random", ctypes.c_uint64),  # address of Values.random
        ("histories", ctypes.c_uint64),  # what `delay(x, tau)` remembers, and the function that looks it up
        ("look_up", ctypes.c_uint64),
        ("work", ctypes.c_uint64),  # scratch of the back end
        ("t_start", ctypes.c_double),
        ("t_max", ctypes.c_double),  # TMAX
        ("comint", ctypes.c_double),
        ("t_base", ctypes.c_double),  # t = t_base + k * dt_base while DT is constant
        ("dt_base", ctypes.c_double),
        ("dt_max", ctypes.c_double),
        ("dt_min", ctypes.c_double),
        ("error_max", ctypes.c_double),
        ("error_min", ctypes.c_double),
        ("error_absolute", ctypes.c_double),
        (
            "error_one",
            ctypes.c_double,
        ),  # added to |x| where rules 4, 7, 8 take a test difference relative to it
        ("dt_least", ctypes.c_double),  # smallest and largest step taken
        ("dt_most", ctypes.c_double),
        ("late_dt", ctypes.c_double),  # DT before code behind `step` made it small (rules 4, 7, 8) …
        ("late_hold", ctypes.c_int64),  # … and for how many steps it must not grow
        ("k", ctypes.c_int64),
        ("point", ctypes.c_int64),  # index of the next communication point, 0 … nn-1
        (
            "points_before",
            ctypes.c_int64,
        ),  # communication points of earlier, continued runs (SAMPLE counts on)
        ("joined", ctypes.c_int64),  # 1: this run continues one; store/get/delay skip its first point
        ("nn", ctypes.c_int64),
        ("every", ctypes.c_int64),  # MM
        ("checked", ctypes.c_int64),  # CHECKN
        ("row", ctypes.c_int64),  # rows written
        ("row_limit", ctypes.c_int64),  # come back when `row` gets there
        ("gap", ctypes.c_int64),  # 1 + the first row with an inf or nan that is no fault; 0: none
        ("steps", ctypes.c_int64),
        ("rejected", ctypes.c_int64),
        ("derivative_calls", ctypes.c_int64),
        ("jacobian_calls", ctypes.c_int64),
        ("which", ctypes.c_int64),
        ("phase", ctypes.c_int32),
        ("stop", ctypes.c_int32),  # polled at every step; set from another thread
        ("order", ctypes.c_int32),  # last order of a variable-order rule
        ("begun", ctypes.c_int32),  # 1: what happens at the run's start has been done
        ("suspect", ctypes.c_int32),  # SOLVER: number of the state that it is about
    )
    culprit: tuple[str, Where] | None = None
    """CHATTERS: the switch's name and place."""
    standstill: Standstill | None = None
    """NO_HEADWAY: what is known of it."""
