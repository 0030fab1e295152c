"""One run of an instance, as its caller gets it."""

from __future__ import annotations

from math import inf
from time import monotonic
from typing import TYPE_CHECKING

from desire_tui.api.block import Blocks
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.outputs.results import run_data

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.api.block import Block
    from desire_tui.api.instance import Instance
    from desire_tui.engine.outputs.run import Run
    from desire_tui.engine.session.checkpoint import Checkpoint
    from desire_tui.engine.session.prepared_run import RunStart
    from desire_tui.engine.source import Source


def one_run(
    instance: Instance,
    start: RunStart,
    record: tuple[str, ...],
    source: Source,
    *,
    timeout: float | None = None,
    on_block: Callable[[Block], object] | None = None,
    base: Checkpoint | None = None,
    continues: bool = False,
) -> Run:
    """Make a run, from `base` if that is given. DesireError: it cannot begin."""
    prepared, control = instance.prepared, instance.session.control
    control.deadline = inf if timeout is None else monotonic() + timeout
    made, error = prepared.run(start, record, Blocks(on_block, prepared), base, continues=continues)
    if made.ended == "stopped" and monotonic() > control.deadline:
        error = DesireError(Diagnostic("time-limit", None, {"seconds": timeout}, source))
    return run_data(
        made, more=True, program=source.name, state=prepared.state(), error=error,
        warnings=tuple(prepared.warnings),
    )  # fmt: skip
