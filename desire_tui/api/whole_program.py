"""`desire_tui.run`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any, TypedDict

from desire_tui.api.arguments import checked_backend, checked_lines, checked_timeout, refuse_name
from desire_tui.api.interrupts import Interrupts
from desire_tui.api.program_source import program_source
from desire_tui.api.repeated_program import repeated_result
from desire_tui.batch.headless_listener import HeadlessListener
from desire_tui.batch.runner import Runner, RunOptions
from desire_tui.batch.set_option import from_mapping

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from os import PathLike

    from desire_tui.engine.outputs.results import Result
    from desire_tui.engine.source import Source


class RunSettings(TypedDict, total=False):
    """Settings of `desire_tui.run`."""

    set: Mapping[str, Any] | None
    input: Iterable[str]
    go: bool
    timeout: float | None
    backend: str
    allow_shell: bool
    allow_write: bool
    quiet: bool
    check: bool


def run_program(program: str | PathLike[str], settings: RunSettings) -> Result:
    """See `desire_tui.run`."""
    for name in settings:
        if name not in RunSettings.__annotations__:
            refuse_name("desire_tui.run", "setting", name, RunSettings.__annotations__)
    source = program_source(program)
    settings = {**settings, "input": checked_lines(settings.get("input", ()))}
    overrides, timeout = from_mapping(settings.get("set") or {}), checked_timeout(settings.get("timeout"))
    backend, quiet = checked_backend(settings.get("backend", "native")), settings.get("quiet", True)
    result = None
    if quiet:
        with Interrupts():
            result = repeated_result(source, backend, overrides, timeout)
    if result is None:
        result = _whole(source, settings, RunOptions(
            settings=overrides, answer_stops=settings.get("go", False), timeout=timeout, backend=backend,
            allow_shell=settings.get("allow_shell", False), allow_write=settings.get("allow_write", False),
        ))  # fmt: skip
    return result.check() if settings.get("check", False) else result


def _whole(source: Source, settings: RunSettings, options: RunOptions) -> Result:
    show: Callable[[str], object] = _ignore if settings.get("quiet", True) else sys.stdout.write
    listener = HeadlessListener(show, iter(settings.get("input", ())), _ignore)
    runner = Runner(source, options, listener)
    runner.run()
    if runner.was_interrupted:
        raise KeyboardInterrupt
    return runner.result()


def _ignore(_: object) -> None:
    return
