"""The table of analyses: desktop commands, `desire NAME …`, Python functions and help are made from it."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.result import Result
    from desire_tui.analysis.subject import Subject


@dataclass(frozen=True)
class Analysis:
    """An analysis: its word, what it does, how a request is written, the module whose `analyse` does it."""

    name: str
    title: str
    summary: str
    form: str
    """How a request is written; empty if there is none."""
    example: str
    """A request that works for the program in its help page."""
    module: str
    may_be_empty: bool = False
    """Whether it can be asked for by its word alone."""

    def run(self, subject: Subject, request: str, progress: Progress) -> Result:
        """Do it. DesireError: what is wrong with the request or the program, or why nothing is found."""
        found: Result = import_module(self.module).analyse(subject, request, progress)
        return found


ANALYSES = (
    Analysis(
        "spectrum", "Spectrum", "Power spectrum of samples (Welch), with its peaks",
        "NAME, … [window SAMPLES] [from TIME]", "x", "desire_tui.analysis.signals.spectrum",
    ),
)  # fmt: skip
BY_NAME = {analysis.name: analysis for analysis in ANALYSES}
