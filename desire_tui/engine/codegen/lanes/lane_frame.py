"""What code for runs in lock step is called with, and its outermost loop: over the groups of runs."""

from __future__ import annotations

import ctypes


class LaneMemory(ctypes.Structure):
    """What compiled code is called with. Arrays hold numbers for each run of a group side by side."""

    _fields_ = (
        ("values", ctypes.c_uint64),  # address of slot 0
        ("base", ctypes.c_uint64),  # what all runs begin with, for each slot of the code in its order
        ("starts", ctypes.c_uint64),  # (groups, given slots, width)
        ("random", ctypes.c_uint64),  # int64 (groups, width): where the random numbers begin
        ("rows", ctypes.c_uint64),  # (samples, 1 + columns, runs): t, then the columns
        ("arrays", ctypes.c_uint64),  # (groups, elements of all histories, width)
        ("side", ctypes.c_uint64),  # times of clocks, or a `runtime.moments.memory.SideBySide`
        ("group", ctypes.c_int64),  # that is under way
        ("shared", ctypes.c_uint64),  # what groups have in common (`shared_values`)
        ("kept", ctypes.c_int64),  # steps of which it holds something
        ("lags", ctypes.c_uint64),  # int64 lag of each delay line, by counter
        ("counts", ctypes.c_uint64),  # int64 (groups, width): samples
        ("flagged", ctypes.c_uint64),  # int64 (groups, width): not 0: to be made again alone
        ("groups", ctypes.c_int64),
        ("runs", ctypes.c_int64),  # groups·width
        ("t_start", ctypes.c_double),
        ("t_max", ctypes.c_double),
        ("comint", ctypes.c_double),
        ("dt", ctypes.c_double),
        ("nn", ctypes.c_int64),  # communication points of runs without states
        ("every", ctypes.c_int64),  # MM
        ("stop", ctypes.c_int64),  # polled at communication points; set from another thread
    )


def lane_frame(name: str, *, width: int, given: int, elements: int) -> str:
    """Return the function `i32 NAME(ptr LaneMemory)`, which calls NAME.group for each group of runs.

    `width` runs are a group; `given` slots have a start for each run; `elements` are those of all histories.
    """
    loads = [
        line
        for field, kind in _LOADED
        for line in (
            f"  %p.{field} = getelementptr i8, ptr %a, i64 {_offset(field)}",
            f"  %{field} = load {kind}, ptr %p.{field}",
        )
    ]
    return _FRAME.format(
        name=name, loads="\n".join(loads), stop=_offset("stop"), group=_offset("group"), width=width,
        given=given * width, elements=elements * width,
    )  # fmt: skip


def _offset(field: str) -> int:
    return int(getattr(LaneMemory, field).offset)


_LOADED = (
    ("values", "ptr"), ("starts", "ptr"), ("random", "ptr"), ("rows", "ptr"), ("arrays", "ptr"),
    ("counts", "ptr"), ("flagged", "ptr"), ("shared", "ptr"), ("kept", "i64"), ("groups", "i64"),
)  # fmt: skip
_FRAME = """
define i32 @{name}(ptr %a) alignstack(64) #0 {{
entry:
{loads}
  %pstop = getelementptr i8, ptr %a, i64 {stop}
  %pgroup = getelementptr i8, ptr %a, i64 {group}
  br label %next
next:
  %g = phi i64 [ 0, %entry ], [ %g1, %work ]
  %stop = load volatile i64, ptr %pstop
  %ended = icmp ne i64 %stop, 0
  %all = icmp sge i64 %g, %groups
  %over = or i1 %ended, %all
  br i1 %over, label %done, label %work
work:
  %oin = mul i64 %g, {given}
  %olane = mul i64 %g, {width}
  %oarrays = mul i64 %g, {elements}
  %gin = getelementptr double, ptr %starts, i64 %oin
  %gseeds = getelementptr i64, ptr %random, i64 %olane
  %grows = getelementptr double, ptr %rows, i64 %olane
  %garrays = getelementptr double, ptr %arrays, i64 %oarrays
  %gcounts = getelementptr i64, ptr %counts, i64 %olane
  %gflags = getelementptr i64, ptr %flagged, i64 %olane
  store i64 %g, ptr %pgroup
  %unused = call i32 @{name}.group(ptr %a, ptr %values, ptr %gin, ptr %gseeds, ptr %grows, ptr %garrays,
                                   ptr %gcounts, ptr %gflags, ptr %shared, i64 %kept)
  %g1 = add i64 %g, 1
  br label %next
done:
  ret i32 0
}}
"""
