"""Desire in a terminal: an interactive simulation IDE for dynamic systems; its engine for Python programs.

    import desire_tui

    model = desire_tui.load("lorenz.src")                # a file, or the program's text; compiled once
    run = model.run(r=28, t=(0, 10))                     # one run, with another parameter
    run["t"], run["x"], run.to_dataframe()               # samples as NumPy arrays, as a table

    result = desire_tui.run("study.src")                 # a whole program: all its runs, its final values
    result.runs[-1]["x"], result["alpha"]

    found = desire_tui.study("torpedo.src", over={"UC": [0.2, 0.25, 0.3]}, keep="x[end], max(y)")

`Session` executes statement by statement. docs/python.md describes all of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.systems import check
from desire_tui.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterable
    from os import PathLike
    from typing import Unpack

    from desire_tui.analysis.calls import AnalysisSettings
    from desire_tui.analysis.result import Result as Analysed
    from desire_tui.api.model import Model
    from desire_tui.api.simulation import Simulation, Snapshot
    from desire_tui.api.whole_program import RunSettings
    from desire_tui.engine.diagnostics import DesireError
    from desire_tui.engine.outputs.results import Result
    from desire_tui.engine.outputs.run import Run
    from desire_tui.engine.session.session import Session
    from desire_tui.studies.call import StudySettings

__all__ = [
    "DesireError",
    "Model",
    "Result",
    "Run",
    "Session",
    "Simulation",
    "Snapshot",
    "__version__",
    "analyse",
    "load",
    "run",
    "study",
]

_HOMES = {
    "DesireError": "desire_tui.engine.diagnostics",
    "Model": "desire_tui.api.model",
    "Result": "desire_tui.engine.outputs.results",
    "Run": "desire_tui.engine.outputs.run",
    "Session": "desire_tui.engine.session.session",
    "Simulation": "desire_tui.api.simulation",
    "Snapshot": "desire_tui.api.simulation",
}
"""Where the exported classes are; imported when they are first asked for."""


def load(
    program: str | PathLike[str],
    *,
    segment: str | None = None,
    input: Iterable[str] = (),  # noqa: A002 - the command line's word
    backend: str = "native",
    allow_shell: bool = False,
    allow_write: bool = False,
) -> Model:
    """Read a program, do what its script does before its first `drun`, compile that run; return it.

    `program` is a file name, or the text of a program (a string with a line end or a `|`). `segment` names
    the labelled segment whose run is meant, `input` holds the lines that the script's `input` reads.
    DesireError: what is wrong with the program, with file, line and column.
    """
    check()
    from desire_tui.api.model import load

    return load(
        program,
        segment=segment,
        input=input,
        backend=backend,
        allow_shell=allow_shell,
        allow_write=allow_write,
    )


def run(program: str | PathLike[str], **settings: Unpack[RunSettings]) -> Result:
    """Run a whole program without a screen and return everything it produced, as NumPy arrays.

    `program` is a file name, or the text of a program (a string with a line end or a `|`). Settings, all
    optional: `set` (mapping of names to numbers, lists or arrays that override the script's own; `"a[2]"`
    names one element), `input` (lines a script's `input` reads), `go` (True answers every STOP), `timeout`
    (seconds), `backend` (`native` or `reference`), `allow_shell`, `allow_write`, `quiet` (False passes
    console text to standard output), `check` (True raises what ended the program early).

    Without `check` nothing is raised for a program's own mistakes: `result.status` is `failed`, and
    `result.error` and `result.problems` say why. DesireError 38: the file cannot be read. TypeError: an
    unknown setting. ValueError: `set` holds what is no quantity's name or no number, another setting what it
    cannot be. KeyboardInterrupt: Ctrl-C.
    """
    check()
    from desire_tui.api.whole_program import run_program

    return run_program(program, settings)


def study(program: str | PathLike[str], **settings: Unpack[StudySettings]) -> Any:
    """Run a program for many values of its quantities; return what is kept of each run, an xarray Dataset.

    `program` is a file name, or the text of a program (a string with a line end or a `|`). What varies:
    `over` (mapping of names to values: a grid), `sample` (names to distributions, `"normal(40, 4)"` or frozen
    ones of scipy.stats; `runs` says how often, `design` how: `random`, `latin`, `sobol`), `points` (a table:
    a CSV file, a DataFrame, a mapping of names to lists). `keep` says what is kept of each run:
    `"x[end], max(x), t[x<1], y@0:2:0.1"`. All others are optional: `seed` (run k draws from (seed, k) alone;
    a study of one run with the program's own SEED is the program), `set` (values for all runs), `segment`,
    `input` (as of `load`), `threads`, `workers` (processes of a local cluster), `cluster` (a
    `distributed.Client` or a scheduler's address), `store` (a Zarr folder, filled as results come), `resume`
    (go on with what is there), `progress` (called with how far it has come; False ends the study), `fast`,
    `backend`, `allow_shell`, `allow_write`.

    A run that fails is nan, with the error's number in the variable `error`. DesireError, before the first
    run: a name that the program does not have, something that is not written as it has to be, no runs, or
    more than memory or disk can hold. TypeError, ValueError: of the call. docs/studies.md describes it.
    """
    from desire_tui.studies.call import run_study

    return run_study(program, settings)


def analyse(
    analysis: str,
    program: str | PathLike[str],
    request: str = "",
    **settings: Unpack[AnalysisSettings],
) -> Analysed:
    """Ask something of a program beyond its curves; `desire_tui.spectrum(program, "x")` is the same, shorter.

    `analysis` is its word (docs/after-the-curve.md lists them), `program` a file name or a program's text,
    `request` what is asked, as on the command line. Settings, all optional: `set` (mapping of names to
    numbers that override the script's own), `data` (a CSV file of measurements, or several), `segment`,
    `input` (as of `load`), `progress` (called as `progress(part, told, so_far)`; False ends it, and what
    there is by then is returned), `backend`, `allow_shell`, `allow_write`.

    The result has `values` by name (`result["frequency"]` too), `tables`, `charts` and `notes`; printed it
    is what a terminal shows. DesireError: the request or the program is wrong, or nothing was found.
    """
    check()
    from desire_tui.analysis.calls import run_analysis

    return run_analysis(analysis, program, request, settings)


def load_ipython_extension(ipython: Any) -> None:
    """Add the cell magic `%%desire` to IPython: `%load_ext desire_tui`."""
    from desire_tui.notebooks.cell_magic import register

    register(ipython)


def __getattr__(name: str) -> Any:
    home = _HOMES.get(name)
    if home is None and not name.startswith("_"):
        from functools import partial

        from desire_tui.analysis.registry import BY_NAME

        if name in BY_NAME:
            return partial(analyse, name)
    if home is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    check()
    from importlib import import_module

    return getattr(import_module(home), name)


def __dir__() -> list[str]:
    return sorted(__all__)
