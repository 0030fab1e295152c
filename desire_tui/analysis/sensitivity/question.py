"""`sensitivity`: what is asked decides between derivatives along the run and indices over whole ranges."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.analysis.request import Request
from desire_tui.analysis.sensitivity.along_run import along_run
from desire_tui.analysis.sensitivity.over_ranges import over_ranges

if TYPE_CHECKING:
    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.result import Result
    from desire_tui.analysis.subject import Subject

EXAMPLE = "sensitivity k, r of x"


def analyse(subject: Subject, request: str, progress: Progress) -> Result:
    """Return sensitivities. DesireError: see `along_run`, `over_ranges`."""
    asked = Request(request, EXAMPLE)
    if asked.take("global"):
        return over_ranges(subject, asked, progress)
    return along_run(subject, asked, progress)
