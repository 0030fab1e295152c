"""The row below the graph while a study or an analysis goes on: how far it is, how it is stopped."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.widgets import Label

from desire_tui.panes.run_summary import bar

if TYPE_CHECKING:
    from desire_tui.studies.study import Progress


class WorkRow(Label):
    """Hidden unless something goes on."""

    DEFAULT_CSS = """
    WorkRow { height: 1; width: 100%; display: none; padding: 0 1; background: $panel; color: $foreground; }
    """

    def __init__(self) -> None:
        super().__init__("", id="work-row", markup=False)

    def show(self, text: str) -> None:
        """Say how far it is."""
        self.display = True
        self.update(text)

    def hide(self) -> None:
        """There is none any more."""
        self.display = False


def study_text(program: str, progress: Progress | None, *, paused: bool) -> str:
    """Return how far a study is, the most important first; before its first runs `progress` is None."""
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


def analysis_text(program: str, title: str, part: float | None, told: str) -> str:
    """Return how far an analysis is."""
    shown = f"{bar(part)} " if part is not None else ""
    return " · ".join(filter(None, (f"{title.lower()} {shown}{told}".rstrip(), "Shift+F10 stops", program)))
