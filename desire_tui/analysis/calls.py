"""The analyses for Python programs: `desire_tui.analyse("spectrum", "model.src", "x")`."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

from desire_tui.analysis.progress import unwatched
from desire_tui.analysis.registry import BY_NAME
from desire_tui.analysis.subject import Subject
from desire_tui.api.arguments import checked_backend, checked_lines, refuse_name
from desire_tui.api.program_source import program_source
from desire_tui.batch.set_option import from_mapping
from desire_tui.engine.diagnostics import closest

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.result import Result


class AnalysisSettings(TypedDict, total=False):
    """Settings of `desire_tui.analyse`."""

    set: Mapping[str, Any] | None
    data: str | PathLike[str] | Iterable[str | PathLike[str]]
    segment: str | None
    input: Iterable[str]
    progress: Progress | None
    backend: str
    allow_shell: bool
    allow_write: bool


def run_analysis(name: str, program: str | PathLike[str], request: str, settings: AnalysisSettings) -> Result:
    """See `desire_tui.analyse`."""
    for setting in settings:
        if setting not in AnalysisSettings.__annotations__:
            refuse_name("desire_tui.analyse", "setting", setting, AnalysisSettings.__annotations__)
    analysis = BY_NAME.get(name)
    if analysis is None:
        near = closest(name, BY_NAME)
        told = f"did you mean {near!r}?" if near else f"there are {', '.join(BY_NAME)}"
        raise ValueError(f"there is no analysis {name!r}; {told}")
    data = settings.get("data", ())
    subject = Subject(
        program_source(program),
        settings=from_mapping(settings.get("set") or {}),
        segment=settings.get("segment"),
        answers=checked_lines(settings.get("input", ())),
        backend=checked_backend(settings.get("backend", "native")),
        data=(Path(data),) if isinstance(data, str | PathLike) else tuple(map(Path, data)),
        allow_shell=settings.get("allow_shell", False),
        allow_write=settings.get("allow_write", False),
    )
    return analysis.run(subject, request, settings.get("progress") or unwatched)
