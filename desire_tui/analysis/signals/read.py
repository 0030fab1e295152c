"""What requests about signals have in common: names, options, the part of the run that counts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.analysis.samples import sampled
from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.analysis.request import Request
    from desire_tui.analysis.subject import Subject

    Floats = NDArray[np.float64]

_SAMPLES_LEAST = 8


def names(asked: Request) -> list[str]:
    """Read `x, y, z`."""
    found = [asked.name("a quantity's name")]
    while asked.take(","):
        found.append(asked.name("a quantity's name"))
    return found


def columns(subject: Subject, wanted: Sequence[str], start: float | None) -> tuple[Floats, list[Floats]]:
    """Return times and samples of quantities from a time on. DesireError 521: there are too few."""
    run = sampled(subject, wanted)
    counts = run.t >= (run.t[0] if start is None else start)
    t = run.t[counts]
    if len(t) < _SAMPLES_LEAST:
        where = "" if start is None else f" from t = {start:g} on"
        facts = {"what": f"the run has {len(t)} samples{where}: too few to say anything",
                 "remedy": f"the run goes from {run.t[0]:g} to {run.t[-1]:g}; NN = 1001"}  # fmt: skip
        raise DesireError(Diagnostic("analysis-failed", None, facts, subject.source))
    return t, [run[name][counts] for name in wanted]
