"""`desire study`: a program's runs for many values, from the command line."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from desire_tui.batch.cli_commands import DONE, FAILED, LIMIT, report, source_named
from desire_tui.batch.ending import giving_up_files
from desire_tui.batch.progress import short
from desire_tui.batch.status_line import StatusLine, bar
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.files import read_source
from desire_tui.studies.design import METHODS, Design
from desire_tui.studies.design_forms import over_texts, points_of, sample_texts
from desire_tui.studies.output import check_ending, summary, write
from desire_tui.studies.study import Study
from desire_tui.studies.task import Task

if TYPE_CHECKING:
    from typing import IO

    from desire_tui.engine.source import Source
    from desire_tui.studies.study import Progress


def study_file(name: str, options: dict[str, Any]) -> int:
    """Make a study; returns the exit status: 0 done, 1 it cannot be made or all runs failed, 3 stopped."""
    try:
        output = None if options["output"] is None else Path(options["output"])
        if output is not None:
            check_ending(output)
        store = output if output is not None and output.suffix == ".zarr" else None
        study = planned(source_named(name), options, store)
        if output is not None:
            study.plan.check_disk(output)
        shown = _ProgressLine(sys.stderr) if sys.stderr.isatty() and not options["quiet"] else None
        status = _run(study, options, shown)
        return _tell(study, output, status, quiet=options["quiet"])
    except DesireError as error:
        report(error.diagnostics)
        return FAILED


def planned(source: Source, options: dict[str, Any], store: Path | None = None) -> Study:
    """Return the study that options describe, its runs still to be made. DesireError: it cannot be."""
    seed = options["seed"]
    method = next(known for known in METHODS if known == options["design"])
    design = Design(
        over_texts(options["over"]),
        sample_texts(options["sample"]),
        points_of(options["points"]),
        options["runs"],
        method,
        0 if seed is None else seed,
    )
    task = Task(
        text=source.text,
        name=source.name,
        path=None if source.path is None else str(source.path.absolute()),
        keep=", ".join(options["keep"]),
        names=design.names,
        fixed=tuple(options["settings"].items()),
        seed=seed,
        segment=options["segment"],
        answers=_answers(options.get("answers")),
        backend=options.get("backend", "native"),
        allow_shell=options.get("allow_shell", False),
        allow_write=options.get("allow_write", False),
        fast=options.get("fast", False),
    )
    resume = options.get("resume", False)
    if resume and store is None:
        facts = {"what": "--resume needs a folder to go on with", "remedy": "-o results.zarr"}
        raise DesireError(Diagnostic("study-form", None, facts))
    return Study(task, design, store=store, resume=resume)


def _answers(name: str | None) -> tuple[str, ...]:
    """Return the lines that a script's `input` reads. DesireError 38."""
    return () if name is None else tuple(read_source(Path(name)).text.splitlines())


def _run(study: Study, options: dict[str, Any], shown: _ProgressLine | None) -> int:
    try:
        if options["workers"] is None and options["cluster"] is None:
            study.run(options["threads"], progress=shown)
        else:
            from desire_tui.studies.cluster import cluster_of

            with cluster_of(options["cluster"], options["workers"]) as client:
                study.run(cluster=client, progress=shown)
    except KeyboardInterrupt:
        return LIMIT
    finally:
        if shown is not None:
            shown.clear()
    return DONE


def _tell(study: Study, output: Path | None, status: int, *, quiet: bool) -> int:
    result = study.result()
    if output is not None and output.suffix != ".zarr":
        with giving_up_files():
            write(result, output)
    failures, runs = study.store.failures, study.plan.runs
    for line in failures.lines():
        sys.stderr.write(f"{line}\n")
    if status == LIMIT:
        sys.stderr.write(
            "stopped by the user; what was made is kept\n" if output else "stopped by the user\n"
        )
    if not quiet:
        shape = " × ".join(f"{axis.size} {axis.name}" for axis in study.plan.design.axes)
        made = f"{runs} run{'s' * (runs != 1)}" if study.made == runs else f"{study.made} of {runs} runs"
        sys.stdout.write(f"{made} ({shape}), {failures.count} failed; made {study.way}\n")
        if output is None or output.suffix != ".zarr":
            sys.stdout.write("".join(f"{line}\n" for line in summary(result)))
    return FAILED if status == DONE and failures.count == runs else status


class _ProgressLine:
    """Shows on a terminal how far a study is."""

    def __init__(self, terminal: IO[str]) -> None:
        self._line = StatusLine(terminal)
        self.clear = self._line.clear

    def __call__(self, progress: Progress) -> None:
        """Redraw it."""
        if self._line.is_due:
            failed = f" · {progress.failed} failed" if progress.failed else ""
            self._line.show(
                f"{bar(progress.made / progress.runs)} {short(progress.made)} / {short(progress.runs)} runs"
                f"{failed} · {_span(progress.seconds_left)} left"
            )


def _span(seconds: float | None) -> str:
    if seconds is None:
        return "…"
    if seconds < 100:
        return f"{seconds:.0f} s"
    minutes = seconds / 60
    return f"{minutes:.0f} min" if minutes < 100 else f"{minutes / 60:.1f} h"
