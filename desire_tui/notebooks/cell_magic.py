"""`%%desire`: a cell that is a program."""

from __future__ import annotations

import sys
from functools import partial
from typing import TYPE_CHECKING, Any

from desire_tui.api.instance import LoadOptions
from desire_tui.api.model import Model
from desire_tui.batch.headless_listener import HeadlessListener
from desire_tui.batch.runner import Runner, RunOptions
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.outputs.results import run_data
from desire_tui.engine.source import Source
from desire_tui.notebooks.cell_error import CellError
from desire_tui.notebooks.cell_options import read_options
from desire_tui.notebooks.live_graph import LiveGraph

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.outputs.results import Result
    from desire_tui.engine.outputs.run import Run
    from desire_tui.notebooks.cell_options import CellOptions
    from desire_tui.notebooks.sliders import SliderPanel


def register(ipython: Any) -> None:
    """Make `%%desire` known to an IPython shell."""
    ipython.register_magic_function(partial(run_cell, ipython), "cell", "desire")


def run_cell(ipython: Any, line: str, cell: str) -> None:
    """Run the cell's program; what it produced becomes the variable `--name`, by default `result`.

    `--set k=3` (as often as wanted) gives parameters other values; `--record y` makes the first run only,
    with more samples, and the variable is that run; `--sliders a=0..5` shows a slider for each parameter
    named, and the variable is the panel; `--timeout S` ends it after S seconds. CellError: what is wrong.
    """
    options = read_options(line)
    source = Source(f"--\n{cell}", "cell")  # lines count as the notebook counts them
    way = _with_sliders if options.sliders else _one_run if options.record else _program
    try:
        ipython.user_ns[options.name] = way(source, options)
    except DesireError as error:
        raise CellError(str(error)) from None
    except KeyboardInterrupt:
        raise CellError("stopped") from None


def _program(source: Source, options: CellOptions) -> Result:
    texts: list[str] = []
    listener = HeadlessListener(texts.append, iter(()), _warn)
    runner = Runner(source, RunOptions(settings=options.settings, timeout=options.timeout), listener)
    graph, session = LiveGraph(), runner.session

    def runs() -> list[Run]:
        return [run_data(record) for record in list(session.runs)]

    def watch() -> None:
        _write(texts)
        graph.grow(runs)

    runner.run(watch)
    _write(texts)
    result = runner.result()
    graph.draw(result.runs, repr(result))
    if runner.was_interrupted:
        raise KeyboardInterrupt
    return result.check()


def _one_run(source: Source, options: CellOptions) -> Run:
    graph = LiveGraph()
    model = Model(source, LoadOptions())
    sys.stdout.write(model.console)
    run = model.run(
        set=options.settings, record=options.record, timeout=options.timeout,
        on_block=lambda block: graph.grow(lambda: [block.run]),
    )  # fmt: skip
    _warn(run.warnings)
    graph.draw([run])
    return run.check()


def _with_sliders(source: Source, options: CellOptions) -> SliderPanel:
    try:
        import ipywidgets  # noqa: F401 - whether it is there
    except ImportError:
        raise CellError("sliders need ipywidgets: pip install 'desire-tui[notebook]'") from None
    from IPython.display import display

    from desire_tui.notebooks.sliders import SliderPanel

    model = Model(source, LoadOptions())
    panel = SliderPanel(model, options.sliders, options.settings, options.record)
    panel.update()
    sys.stdout.write(model.console)
    display(panel)
    return panel


def _write(texts: list[str]) -> None:
    """Pass console text on from the cell's own thread."""
    count = len(texts)
    if count:
        sys.stdout.write("".join(texts[:count]))
        del texts[:count]


def _warn(problems: Sequence[Diagnostic]) -> None:
    if problems:
        sys.stderr.write(f"{DesireError(*problems)}\n")
