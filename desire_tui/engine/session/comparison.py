"""`compare rule n` [X]: the last run once more under another rule, and how far the curves lie apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.runtime.record import RunRecord

if TYPE_CHECKING:
    from desire_tui.engine.session.desk import Desk
    from desire_tui.engine.session.session import Session
    from desire_tui.engine.session.world import World


def compare_rules(session: Session, world: World, desk: Desk, rule: int) -> str:
    """Return a table: for each displayed variable the largest difference, its time, and the final values.

    Everything is put back afterwards: quantities, random numbers, positions of histories.
    """
    if not session.runs:
        raise DesireError(Diagnostic("no-run"))
    last = session.runs[-1]
    names = list(dict.fromkeys(column.name for column in last.columns))
    if not names or not last.count:
        raise DesireError(Diagnostic("compare-nothing"))
    with world.restored():
        world.reset()
        program, script = desk.runnable()
        segment = desk.segments.lowered(program, script, last.segment, rule)
        if segment.recover:
            segment = desk.segments.recovering(segment, desk.stash_path)
        plan = world.simulator.defaults.plan(segment, rule, desk.source, None)
        record = RunRecord(
            number=0, segment=last.segment, line=0, requests=segment.requests, columns=segment.columns,
            overlay=False, rule=plan.rule, scale=plan.scale, t0=plan.t0, t_max=plan.t_max, nn=plan.nn,
            dt=plan.dt,
        )  # fmt: skip
        world.simulator.run(desk.segments.model(segment, plan.rule), segment, plan, record, _Deaf())
    return _table(last, record, names)


def _table(one: RunRecord, other: RunRecord, names: list[str]) -> str:
    """Differences at the samples that both runs took (fixed-step rules may take theirs a little late)."""
    count = min(one.count, other.count)
    lines = [f"rule {one.rule}: {one.steps} steps, rule {other.rule}: {other.steps} steps"]
    lines.append(f"{'':12s}{'largest':>14s}{'at t':>13s}{f'rule {one.rule}':>15s}{f'rule {other.rule}':>15s}")
    for name in names:
        a, b = one.values(name)[:count], other.values(name)[:count]
        difference = np.abs(a - b)
        at = int(np.nanargmax(difference)) if np.isfinite(difference).any() else 0
        lines.append(f"{name:12s}{difference[at]:14.6g}{one.t[at]:13.6g}{a[-1]:15.8g}{b[-1]:15.8g}")
    return "\n".join(lines) + "\n"


class _Deaf:
    def block(self, record: RunRecord, first_row: int) -> None:
        """Nobody watches this run."""
