"""Desire in a terminal: an interactive simulation IDE for dynamic systems.

    import desire_tui

    result = desire_tui.run("step.src")                  # a file, or the program's text
    result.runs[-1]["x"], result["alpha"]                # samples and final values, NumPy arrays

`Session` gives step by step control.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.version import __version__

if TYPE_CHECKING:
    from os import PathLike

    from desire_tui.engine.outputs.results import Result
    from desire_tui.engine.session.session import Session

__all__ = ["Session", "__version__", "run"]


def run(program: str | PathLike[str], **settings: Any) -> Result:
    """Run a program without a screen and return everything it produced, as NumPy arrays.

    `program` is a file name, or the text of a program (a string with a line end or a `|`). Settings, all
    optional: `set` (mapping of names to numbers, lists or arrays that override the script's own; `"a[2]"`
    names one element), `input` (lines a script's `input` reads), `go` (True answers every STOP), `timeout`
    (seconds), `backend` (`native` or `reference`), `allow_shell`, `allow_write`, `quiet` (False passes
    console text to standard output).

    Nothing is raised for a program's own mistakes: `result.status` is `failed` and `result.problems` say why.
    DesireError 38: the file cannot be read. TypeError: an unknown setting. ValueError: `set` holds what
    is no quantity's name or no number.
    """
    from desire_tui.batch.api import run_program

    return run_program(program, **settings)


def __getattr__(name: str) -> Any:
    if name == "Session":
        from desire_tui.engine.session.session import Session

        return Session
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
