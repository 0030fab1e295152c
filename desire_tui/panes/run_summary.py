"""A run in one line, as much of it as there is room for: how far it is, and what it did when it is over."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.session.status import State, Status

if TYPE_CHECKING:
    from desire_tui.engine.runtime.run_record import RunRecord

BAR_CELLS = 10
SEPARATOR = " · "
_EIGHTHS = " ▏▎▍▌▋▊▉█"
_ENDS = {
    "tmax": "TMAX reached at t = {t:.6g}",
    "term": "ended by term at t = {t:.6g}",
    "stopped": "ended by you at t = {t:.6g}",
    "failed": "failed at t = {t:.6g}",
    "running": "t = {t:.6g}",
}


def run_text(status: Status | None, room: int) -> str:
    """Return what is known of the run; the least important parts go first when there is no room."""
    if status is None or (status.state is State.IDLE and not status.run):
        return ""
    going = status.state in (State.RUNNING, State.PAUSED)
    parts = _going(status) if going else _over(status)
    while len(parts) > 1 and len(SEPARATOR.join(parts)) > room:
        parts.pop()
    return SEPARATOR.join(parts)[: max(room, 0)]


def _going(status: Status) -> list[str]:
    parts = [
        f"{status.state.value} {status.run_text}",
        f"{bar(status.progress)} t {status.t:.4g}/{status.t0 + status.t_max:.4g}",
        f"{speed(status.steps_per_second)} steps/s",
        f"DT {status.dt:.3g}",
        f"rule {status.rule}",
    ]
    if status.record is not None:
        parts += _costs(status.record)
    return parts


def _over(status: Status) -> list[str]:
    busy = [] if status.state is State.IDLE else [status.state.value]
    record = status.record
    if record is None:
        return [*busy, f"rule {status.rule}"]
    return [
        *busy,
        f"run {record.number}: {_ENDS[record.ended].format(t=record.end_time)}",
        f"{speed(record.steps)} steps",
        *_costs(record),
        f"DT {_range(record)}",
        *([f"order {record.order}"] if record.order else []),
        f"rule {record.rule}",
        f"{speed(status.steps_per_second)} steps/s",
    ]


def _costs(record: RunRecord) -> list[str]:
    """Rejected steps and Jacobians only where a rule can have them."""
    costs = []
    if record.rejected or record.dt_least != record.dt_most:
        costs.append(f"{speed(record.rejected)} rejected")
    costs.append(f"{speed(record.derivative_calls)} derivatives")
    if record.jacobian_calls:
        costs.append(f"{speed(record.jacobian_calls)} Jacobians")
    return costs


def _range(record: RunRecord) -> str:
    if record.dt_least == record.dt_most or not record.dt_most:
        return f"{record.dt_most or record.dt:.3g}"
    return f"{record.dt_least:.3g} … {record.dt_most:.3g}"


def bar(progress: float) -> str:
    """Return a bar of `BAR_CELLS` cells; `progress` 0 … 1."""
    eighths = round(progress * BAR_CELLS * 8)
    full, part = divmod(eighths, 8)
    return ("█" * full + (_EIGHTHS[part] if part else "")).ljust(BAR_CELLS, "·")


def speed(number: float) -> str:
    """Return a number with its thousands as k, M, G."""
    for unit in ("", "k", "M"):
        if abs(number) < 1000:
            return f"{number:.3g} {unit}".rstrip()
        number /= 1000
    return f"{number:.3g} G"
