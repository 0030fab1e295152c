"""`desire_tui.run`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from desire_tui.batch.headless_listener import HeadlessListener
from desire_tui.batch.runner import Runner, RunOptions
from desire_tui.batch.set_option import from_mapping
from desire_tui.engine.files import read_source
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from os import PathLike

    from desire_tui.engine.outputs.results import Result
    from desire_tui.engine.session.session import BackendName


def _ignore(_: object) -> None:
    return


def run_program(
    program: str | PathLike[str],
    *,
    set: Mapping[str, Any] | None = None,  # noqa: A002 - the command line's word
    input: Iterable[str] = (),  # noqa: A002 - the command line's word
    go: bool = False,
    timeout: float | None = None,
    backend: BackendName = "native",
    allow_shell: bool = False,
    allow_write: bool = False,
    quiet: bool = True,
) -> Result:
    """See `desire_tui.run`."""
    is_text = isinstance(program, str) and ("\n" in program or "|" in program)
    source = Source(str(program), "<text>") if is_text else read_source(Path(program))
    show: Callable[[str], object] = _ignore if quiet else sys.stdout.write
    listener = HeadlessListener(show, iter(input), _ignore)
    options = RunOptions(
        settings=from_mapping(set or {}), answer_stops=go, timeout=timeout, backend=backend,
        allow_shell=allow_shell, allow_write=allow_write,
    )  # fmt: skip
    runner = Runner(source, options, listener)
    runner.run()
    return runner.result()
