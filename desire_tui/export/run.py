"""A program brought to its first run, as exports need it: the segment, its plan, all numbers at the start."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.api.instance import Instance, LoadOptions
from desire_tui.api.settings import way_of
from desire_tui.engine.data_classes import dataclass
from desire_tui.engine.runtime.delays import Delays
from desire_tui.engine.session.prepared_run import RunStart

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.runtime.plan import RunPlan
    from desire_tui.engine.source import Source
    from desire_tui.engine.values import Values
    from desire_tui.export.formats import Export


@dataclass(frozen=True)
class ExportedRun:
    """What a run begins with. `lags`: of delay lines by their counters; `random`: the state of `ran()`."""

    source: Source
    segment: Segment
    plan: RunPlan
    values: Values
    lags: Mapping[int, int]
    random: int
    parameters: Mapping[str, float]
    """Numbers that the script gives and the run reads."""
    instance: Instance
    """Owns the values."""


def exported_run(export: Export) -> ExportedRun:
    """Bring a program to its first run. DesireError: it has mistakes, or does not come to one."""
    source, settings = export.source, export.settings
    options = LoadOptions(export.segment, export.answers, "reference", export.allow_shell, export.allow_write)
    instance = Instance(source, options)
    way = way_of(tuple(settings), instance)
    if way.slots is None:
        instance.override(dict(settings))
        start = RunStart()
    else:
        start = RunStart(tuple(zip(way.slots, settings.values(), strict=True)), way.follow)
    prepared = instance.prepared
    parameters = dict(prepared.start_values().parameters)
    plan = prepared.planned(start)
    values = prepared.values
    lags = Delays().lags(prepared.segment, plan, values)
    parameters |= {name: value for name, value in settings.items() if name in parameters}
    return ExportedRun(
        source, prepared.segment, plan, values, lags, int(values.random[0]), parameters, instance
    )
