"""Samples of a run that an analysis looks at."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.analysis.subject import Subject
    from desire_tui.engine.outputs.run import Run


def sampled(subject: Subject, names: Iterable[str], *, t: tuple[float, float] | None = None) -> Run:
    """Make the program's run and return its samples of these quantities besides its own.

    DesireError: a name is not there; the run failed.
    """
    run = subject.model.run(set=subject.settings, record=tuple(names), t=t)
    if run.error is not None:
        raise run.error
    if len(run.t) < 4:
        facts = {"what": f"the run has {len(run.t)} samples: too few to say anything", "remedy": "NN = 1001"}
        raise DesireError(Diagnostic("analysis-failed", None, facts, subject.source))
    return run
