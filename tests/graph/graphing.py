"""Runs made of given samples, put on pages."""

from __future__ import annotations

import numpy as np

from desire_tui.engine.graph.pages import GraphPages
from desire_tui.engine.lowered.segment import SampleColumn, SampleRequest
from desire_tui.engine.lowered.statements import Where
from desire_tui.engine.runtime.run_record import RunRecord
from desire_tui.engine.source import Span

PLACE = Where(Span(0, 0))


def record_of(kind, t, data, *, scale=1.0, rule=1, more=()):
    """Return the record of a run whose request `kind` shows `data` (name -> samples)."""
    columns = tuple(SampleColumn(name, 20 + i, PLACE) for i, name in enumerate(data))
    requests = (*more, SampleRequest(kind, columns))
    record = RunRecord(
        1, None, 1, requests, tuple(c for r in requests for c in r.columns), False, rule, scale,
        float(t[0]), float(t[-1] - t[0]), len(t), 0.1,
    )  # fmt: skip
    extra = [np.full(len(t), 77.0) for r in more for _ in r.columns]
    record.rows = np.column_stack([t, *extra, *data.values()])
    record.count = len(t)
    return record


def page_of(kind, t, data, *commands, scale=1.0, rule=1):
    """Return a page that shows a run, after some display commands such as "N-18"."""
    pages = GraphPages()
    displayed(pages, *commands, scale=scale)
    return pages.begin_run(record_of(kind, np.asarray(t, dtype=float), data, scale=scale, rule=rule))


def displayed(pages, *commands, scale=1.0):
    for command in commands:
        pages.display(command[0], [float(command[1:])] if command[1:] else [], scale)
