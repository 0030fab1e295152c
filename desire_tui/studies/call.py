"""`desire_tui.study`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

from desire_tui.api.arguments import checked_backend, refuse_name
from desire_tui.api.program_source import program_source
from desire_tui.batch.set_option import from_mapping
from desire_tui.engine.diagnostics import closest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from os import PathLike

    from desire_tui.studies.study import Progress, Study


class StudySettings(TypedDict, total=False):
    """Settings of `desire_tui.study`."""

    over: Mapping[str, Any] | None
    sample: Mapping[str, Any] | None
    points: Any
    runs: int | None
    design: str
    seed: int | None
    keep: str | Iterable[str]
    set: Mapping[str, Any] | None
    segment: str | None
    input: Iterable[str]
    threads: int | None
    workers: int | None
    cluster: Any
    store: str | PathLike[str] | None
    resume: bool
    progress: Callable[[Progress], object] | None
    backend: str
    fast: bool
    allow_shell: bool
    allow_write: bool


def planned(program: str | PathLike[str], settings: StudySettings) -> Study:
    """Return a study whose runs are still to be made."""
    from desire_tui.studies.design import METHODS, Design
    from desire_tui.studies.design_forms import over_mapping, points_of, sample_mapping
    from desire_tui.studies.study import Study
    from desire_tui.studies.task import Task

    for name in settings:
        if name not in StudySettings.__annotations__:
            refuse_name("desire_tui.study", "setting", name, StudySettings.__annotations__)
    source = program_source(program)
    wanted = settings.get("design", "random")
    method = next((known for known in METHODS if known == wanted), None)
    if method is None:
        near = closest(str(wanted), METHODS)
        told = f"did you mean {near!r}?" if near else f"there are {', '.join(map(repr, METHODS))}"
        raise ValueError(f"design={wanted!r} is unknown; {told}")
    seed = settings.get("seed")
    design = Design(
        over_mapping(settings.get("over")),
        sample_mapping(settings.get("sample")),
        points_of(settings.get("points")),
        settings.get("runs"),
        method,
        0 if seed is None else seed,
    )
    keep = settings.get("keep", "")
    task = Task(
        text=source.text,
        name=source.name,
        path=None if source.path is None else str(source.path.absolute()),
        keep=keep if isinstance(keep, str) else ", ".join(keep),
        names=design.names,
        fixed=tuple(from_mapping(settings.get("set") or {}).items()),
        seed=seed,
        segment=settings.get("segment"),
        answers=tuple(settings.get("input", ())),
        backend=checked_backend(settings.get("backend", "native")),
        allow_shell=settings.get("allow_shell", False),
        allow_write=settings.get("allow_write", False),
        fast=settings.get("fast", False),
    )
    store = settings.get("store")
    return Study(
        task, design, store=None if store is None else Path(store), resume=settings.get("resume", False)
    )


def run_study(program: str | PathLike[str], settings: StudySettings) -> Any:
    """See `desire_tui.study`."""
    made = planned(program, settings)
    threads, workers, cluster = settings.get("threads"), settings.get("workers"), settings.get("cluster")
    for name, count in (("threads", threads), ("workers", workers)):
        if count is not None and (not isinstance(count, int) or count < 1):
            raise ValueError(f"{name}={count!r}: a whole number, 1 or more")
    progress = settings.get("progress")
    if workers is None:
        made.run(threads, cluster, progress)
    else:
        from desire_tui.studies.cluster import cluster_of

        with cluster_of(cluster, workers) as client:
            made.run(cluster=client, progress=progress)
    return made.result()
