"""`desire_tui.study`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

from desire_tui.api.arguments import (
    checked_backend,
    checked_count,
    checked_function,
    checked_lines,
    checked_mapping,
    refuse_name,
)
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
    seed = checked_count("seed", settings.get("seed"), 0)
    design = Design(
        over_mapping(checked_mapping("over", settings.get("over"))),
        sample_mapping(checked_mapping("sample", settings.get("sample"))),
        points_of(settings.get("points")),
        checked_count("runs", settings.get("runs")),
        method,
        0 if seed is None else seed,
    )
    keep = settings.get("keep", "")
    if not hasattr(keep, "__iter__"):
        raise TypeError(f"keep is a text or a list of texts, 'x[end], max(x)', not {keep!r}")
    task = Task(
        text=source.text,
        name=source.name,
        path=None if source.path is None else str(source.path.absolute()),
        keep=keep if isinstance(keep, str) else ", ".join(keep),
        names=design.names,
        fixed=tuple(from_mapping(checked_mapping("set", settings.get("set"))).items()),
        seed=seed,
        segment=settings.get("segment"),
        answers=checked_lines(settings.get("input", ())),
        backend=checked_backend(settings.get("backend", "native")),
        allow_shell=settings.get("allow_shell", False),
        allow_write=settings.get("allow_write", False),
        fast=settings.get("fast", False),
    )
    store, resume = settings.get("store"), settings.get("resume", False)
    if store is not None and Path(store).suffix != ".zarr":
        raise ValueError(f"store={str(store)!r} is a folder that Zarr fills: end its name with .zarr")
    if resume and store is None:
        raise ValueError("resume=True goes on with a store: give store='results.zarr'")
    return Study(task, design, store=None if store is None else Path(store), resume=resume)


def run_study(program: str | PathLike[str], settings: StudySettings) -> Any:
    """See `desire_tui.study`."""
    threads = checked_count("threads", settings.get("threads"))
    workers, cluster = checked_count("workers", settings.get("workers")), settings.get("cluster")
    progress = settings.get("progress")
    checked_function("progress", progress)
    made = planned(program, settings)
    if workers is None:
        made.run(threads, cluster, progress)
    else:
        from desire_tui.studies.cluster import cluster_of

        with cluster_of(cluster, workers) as client:
            made.run(cluster=client, progress=progress)
    return made.result()
