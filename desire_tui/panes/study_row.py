"""The row below the graph while a study goes on: how far it is, how long it will take, how it is stopped."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.widgets import Label

from desire_tui.panes.run_summary import bar

if TYPE_CHECKING:
    from desire_tui.studies.study import Progress


class StudyRow(Label):
    """Hidden unless a study goes on."""

    DEFAULT_CSS = """
    StudyRow { height: 1; width: 100%; display: none; padding: 0 1; background: $panel; color: $foreground; }
    """

    def __init__(self) -> None:
        super().__init__("", id="study-row", markup=False)

    def show(self, program: str, progress: Progress | None, *, paused: bool) -> None:
        """Say how far a study is; before its first runs `progress` is None."""
        self.display = True
        self.update(study_text(program, progress, paused=paused))

    def hide(self) -> None:
        """There is none any more."""
        self.display = False


def study_text(program: str, progress: Progress | None, *, paused: bool) -> str:
    """Return the row's text, the most important first."""
    state = "paused" if paused else "study"
    keys = "study go, study stop" if paused else "study pause, study stop"
    if progress is None:
        return f"{state} of {program} begins · {keys}"
    parts = [f"{state} {bar(progress.made / progress.runs)} {progress.made:,}/{progress.runs:,} runs"]
    if progress.failed:
        parts.append(f"{progress.failed:,} failed")
    if progress.seconds_left is not None and not paused:
        parts.append(f"{span_text(progress.seconds_left)} left")
    return " · ".join([*parts, keys, program])


def span_text(seconds: float) -> str:
    """Return `8 s`, `12 min`, `3.5 h`."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    minutes = seconds / 60
    return f"{minutes:.0f} min" if minutes < 100 else f"{minutes / 60:.1f} h"
