"""Warnings about curves with gaps: what became inf or nan in a run without ending it (language.md 9.8)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.problems import at_statement
from desire_tui.engine.runtime.run_faults import defining, described

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Where
    from desire_tui.engine.runtime.run_record import RunRecord


def gap_warnings(segment: Segment, record: RunRecord) -> tuple[Diagnostic, ...]:
    """Return a warning for each line whose variables have such samples: their names, the first time."""
    if not record.gap:
        return ()
    rows = record.rows[record.gap - 1 : record.count]
    found: dict[Where, tuple[int, float, list[str]]] = {}
    for number, column in enumerate(segment.columns, 1):
        gaps = ~np.isfinite(rows[:, number])
        first = int(np.argmax(gaps))
        if not gaps[first]:
            continue
        where = defining(segment, column.slot) or column.where
        row, value, names = found.get(where, (first, float(rows[first, number]), []))
        if first < row:
            row, value = first, float(rows[first, number])
        if column.name not in names:
            names.append(column.name)
        found[where] = row, value, names
    warnings = []
    for where, (row, value, names) in found.items():
        shown = ", ".join(f"'{name}'" for name in names)
        facts: dict[str, object] = {"names": shown, "what": described(value), "t": float(rows[row, 0])}
        problem = at_statement("sample-not-finite", facts, segment, where)
        warnings.append(replace(problem, severity="warning"))
    return tuple(warnings)
