"""Runs a program on a back end and keeps all that can be asked about it afterwards."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.runtime.run_record import RunRecord
    from tests.programs.expectations import Settings

GO_MOST = 50
"""A program that stops more often than this is taken to stop for ever."""


@dataclass
class Outcome:
    """What a program did: console text, runs, quantities, plotted points, and the error that ended it."""

    console: str = ""
    runs: list[RunRecord] = field(default_factory=list)
    quantities: dict[str, np.ndarray | float] = field(default_factory=dict)
    points: int = 0
    error: DesireError | None = None
    warnings: list[Diagnostic] = field(default_factory=list)


class _Console(Listener):
    """Collects the output, types the answers."""

    def __init__(self, answers: list[str]) -> None:
        self.text: list[str] = []
        self.runs: list[RunRecord] = []
        self.warnings: list[Diagnostic] = []
        self._answers = iter(answers)

    def console_text(self, text: str) -> None:
        self.text.append(text)

    def ask(self, prompt: str) -> str:
        del prompt
        try:
            return next(self._answers)
        except StopIteration:
            raise EOFError from None

    def problems(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.warnings += [problem for problem in diagnostics if problem.severity == "warning"]

    def run_started(self, record: RunRecord) -> None:
        self.runs.append(record)


def execute(
    text: str,
    backend: str,
    folder: Path,
    *,
    settings: Settings = (),
    go: bool = False,
    answers: list[str] | None = None,
) -> Outcome:
    """Run a program as `zz` would, in `folder`; with `go`, every STOP is answered. Its error is part of the outcome."""
    console = _Console(answers or [])
    session = Session(console, backend=backend, folder=folder)
    session.override(dict(settings))
    outcome = Outcome()
    try:
        session.erun(Source(text, "program.src"))
        stops = 0
        while go and session.stopped_at is not None and stops < GO_MOST:
            stops += 1
            session.go()
    except DesireError as error:
        outcome.error = error
    outcome.console = "".join(console.text)
    outcome.runs = console.runs
    outcome.warnings = console.warnings
    values = session.values
    for quantity in values:
        if quantity.shape:
            outcome.quantities[quantity.name] = np.array(values.view(quantity))
        elif values.is_defined(quantity):
            outcome.quantities[quantity.name] = values.cells[quantity.slot]
    outcome.points = sum(page.points.count for page in session.graphs)
    return outcome
