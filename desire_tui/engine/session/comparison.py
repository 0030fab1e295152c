"""`compare rule n` [X]: the last run once more under another rule, and how far the curves lie apart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.runtime.record import RunRecord
from desire_tui.engine.values import DT, ERMAX

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.session.desk import Desk
    from desire_tui.engine.session.session import Session
    from desire_tui.engine.session.world import World

RULES = (*range(6), *range(7, 17))
_SAME_TIME = 1e-6
"""Of COMINT: samples so near stand at one time."""


@dataclass(frozen=True)
class Change:
    """What the run is repeated with; None: as it was."""

    rule: int | None = None
    dt: float | None = None
    error_max: float | None = None

    @classmethod
    def parse(cls, argument: str) -> Change:
        """Read `rule 4`, `DT 0.001`, `rule 14 ERMAX 1.0E-08`. DesireError 404, 86."""
        words = argument.split()
        found: dict[str, float] = {}
        for word, number in zip(words[::2], words[1::2], strict=False):
            try:
                found["rule" if word == "irule" else word] = float(number)
            except ValueError:
                raise DesireError(Diagnostic("compare-form")) from None
        if not found or 2 * len(found) != len(words) or not found.keys() <= {"rule", "DT", "ERMAX"}:
            raise DesireError(Diagnostic("compare-form"))
        rule = found.get("rule")
        if rule is not None and rule not in RULES:
            raise DesireError(Diagnostic("no-such-rule", facts={"rule": f"{rule:g}"}))
        return cls(None if rule is None else int(rule), found.get("DT"), found.get("ERMAX"))

    def named(self, record: RunRecord) -> str:
        """Return a run's settings of those that change: `rule 3, DT 0.001`."""
        parts = [f"rule {record.rule}"] if self.rule is not None else []
        parts += [f"DT {record.dt:g}"] if self.dt is not None else []
        parts += [f"ERMAX {record.error_max:g}"] if self.error_max is not None else []
        return ", ".join(parts)


def compare_runs(session: Session, world: World, desk: Desk, change: Change) -> str:
    """Return a table: for each displayed variable the largest difference, its time, and the final values.

    Both runs are shown on a page of their own. Everything is put back afterwards: quantities, random
    numbers, positions of histories.
    """
    last = session.runs[-1] if session.runs else None
    if last is None:
        raise DesireError(Diagnostic("no-run"))
    if not last.columns or not last.count:
        raise DesireError(Diagnostic("compare-nothing"))
    program, _ = desk.runnable()
    if world.runs.run_of != (program.source.text, desk.values.generation):
        raise DesireError(Diagnostic("compare-changed"))
    with world.runs.restored():
        other = _repeat(world, desk, last, change)
    page = session.graphs.compare((last, other))
    if page is not None:
        world.graph_changed(page)
    return _table(last, other, change)


def _repeat(world: World, desk: Desk, last: RunRecord, change: Change) -> RunRecord:
    """Run from where the last run began."""
    is_exact = world.runs.start is not None
    world.runs.go_back()
    rule = last.rule if change.rule is None else change.rule
    program, script = desk.runnable()
    segment = desk.segments.lowered(program, script, last.segment, rule)
    if (rule == 0) != (segment.order == 0):
        why = "has differential equations" if segment.order else "has no differential equations"
        raise DesireError(Diagnostic("compare-not-integrated", facts={"what": f"rule {rule}", "why": why}))
    if segment.recover:
        segment = desk.segments.recovering(segment, desk.stash_path)
    for slot, value in ((DT, change.dt), (ERMAX, change.error_max)):
        if value is not None:
            desk.values.assign(slot, value)
    plan = world.runs.simulator.defaults.plan(segment, rule, desk.source, None)
    record = RunRecord(
        number=0, segment=last.segment, line=0, requests=segment.requests, columns=segment.columns,
        overlay=False, rule=plan.rule, scale=plan.scale, t0=plan.t0, t_max=plan.t_max, nn=plan.nn,
        dt=plan.dt, error_max=plan.tolerance,
    )  # fmt: skip
    if not is_exact:
        record.message = "compared with the quantities as they are now: of so large a model no copy is kept"
    try:
        finished = world.runs.simulator.run(
            desk.segments.model(segment, plan.rule), segment, plan, record, _Deaf()
        )
    except DesireError as error:
        facts = {"setting": change.named(record), "reason": error.diagnostics[0].message}
        raise DesireError(Diagnostic("compare-failed", facts=facts)) from error
    if not finished:
        raise Interrupted
    return record


def _table(one: RunRecord, other: RunRecord, change: Change) -> str:
    """Differences at the samples that both runs took (fixed-step rules may take theirs a little late)."""
    first, second = change.named(one), change.named(other)
    width = max(15, len(first) + 2, len(second) + 2)
    at_one, at_other = _common(one, other)
    lines = [f"{first}: {one.steps} steps, {second}: {other.steps} steps"]
    lines.append(f"{'':12s}{'largest':>14s}{'at t':>13s}{first:>{width}s}{second:>{width}s}")
    for name in dict.fromkeys(column.name for column in one.columns):
        a, b = one.values(name), other.values(name)
        difference = np.abs(a[at_one] - b[at_other])
        at = int(np.nanargmax(difference)) if not np.isnan(difference).all() else 0
        t, ends = one.t[at_one][at], f"{a[-1]:{width}.8g}{b[-1]:{width}.8g}"
        lines.append(f"{name:12s}{difference[at]:14.6g}{t:13.6g}{ends}")
    lines += _remarks(one, other, len(at_one))
    return "\n".join(lines) + "\n"


def _remarks(one: RunRecord, other: RunRecord, compared: int) -> list[str]:
    lines = []
    ends = one.t[-1], other.t[-1]
    comint = one.t_max / (one.nn - 1)
    if abs(ends[0] - ends[1]) > _SAME_TIME * comint:
        lines.append(f"the last samples stand at t = {ends[0]:.6g} and t = {ends[1]:.6g}")
    count = min(one.count, other.count)
    if compared < count:
        lines.append(
            f"{count - compared} of {count} samples stand at different times and are not compared: "
            "let TMAX/(NN - 1) be a multiple of DT"
        )
    if other.message:
        lines.append(other.message)
    return lines


def _common(one: RunRecord, other: RunRecord) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the rows of both runs that stand at the same times."""
    a, b = one.t, other.t
    near = np.clip(np.searchsorted(b, a), 1, max(len(b) - 1, 1))
    near = np.minimum(near, len(b) - 1)
    below = np.maximum(near - 1, 0)
    nearest = np.where(np.abs(b[below] - a) <= np.abs(b[near] - a), below, near)
    same = np.abs(b[nearest] - a) <= _SAME_TIME * one.t_max / (one.nn - 1)
    return np.flatnonzero(same), nearest[same]


class _Deaf:
    def block(self, record: RunRecord, first_row: int) -> None:
        """Nobody watches this run."""
