"""`dump run`: what a run did, in a few lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.runtime.run_record import RunRecord

WHY = {
    "running": "still going on",
    "tmax": "TMAX reached",
    "term": "ended by term",
    "stopped": "ended by the user",
    "failed": "failed",
}


def run_report(record: RunRecord) -> str:
    """Return settings, counts and times of a run, one fact a line."""
    name = f" {record.segment}" if record.segment else ""
    lines = [
        f"run {record.number}{name}: rule {record.rule}, {WHY[record.ended]}",
        f"t          {record.t0:g} to {record.end_time:g} (TMAX = {record.t_max:g})",
        f"samples    {record.count} of NN = {record.nn}",
        f"steps      {record.steps}, rejected {record.rejected}",
        f"derivatives {record.derivative_calls}, Jacobians {record.jacobian_calls}",
    ]
    if record.dt_most > 0.0:
        lines.append(f"DT         {record.dt_least:g} to {record.dt_most:g} (first {record.dt:g})")
    if record.order:
        lines.append(f"order      {record.order} at the end")
    rate = record.steps / record.seconds if record.seconds > 0 else 0.0
    lines.append(f"seconds    {record.seconds:.6f} running, {record.compile_seconds:.6f} compiling")
    lines.append(f"steps/s    {rate:.4g}")
    if record.message:
        lines.append(record.message)
    return "\n".join(lines) + "\n"
