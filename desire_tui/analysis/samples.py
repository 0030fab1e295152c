"""Samples of a run that an analysis looks at."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.analysis.subject import Subject
    from desire_tui.engine.outputs.run import Run


def sampled(subject: Subject, names: Iterable[str]) -> Run:
    """Make the program's run and return its samples of these quantities besides its own.

    DesireError: a name is not there; the run failed.
    """
    run = subject.model.run(set=subject.settings, record=tuple(names))
    if run.error is not None:
        raise run.error
    return run
