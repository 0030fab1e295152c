"""Desire in a terminal: an interactive simulation IDE for dynamic systems; its engine for Python programs.

    import desire_tui

    model = desire_tui.load("lorenz.src")                # a file, or the program's text; compiled once
    run = model.run(r=28, t=(0, 10))                     # one run, with another parameter
    run["t"], run["x"], run.to_dataframe()               # samples as NumPy arrays, as a table

    result = desire_tui.run("study.src")                 # a whole program: all its runs, its final values
    result.runs[-1]["x"], result["alpha"]

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

    from desire_tui.api.model import Model
    from desire_tui.api.whole_program import RunSettings
    from desire_tui.engine.diagnostics import DesireError
    from desire_tui.engine.outputs.results import Result
    from desire_tui.engine.outputs.run import Run
    from desire_tui.engine.session.session import Session

__all__ = ["DesireError", "Model", "Result", "Run", "Session", "__version__", "load", "run"]

_HOMES = {
    "DesireError": "desire_tui.engine.diagnostics",
    "Model": "desire_tui.api.model",
    "Result": "desire_tui.engine.outputs.results",
    "Run": "desire_tui.engine.outputs.run",
    "Session": "desire_tui.engine.session.session",
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


def __getattr__(name: str) -> Any:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    check()
    from importlib import import_module

    return getattr(import_module(home), name)


def __dir__() -> list[str]:
    return sorted(__all__)
