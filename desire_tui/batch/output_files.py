"""Writes the results of a headless run to files and standard output."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.files import write_bytes, write_file
from desire_tui.engine.outputs.formats import DATA, PICTURES
from desire_tui.engine.outputs.picture_files import write_pictures
from desire_tui.engine.outputs.picture_options import FOR_PAPER
from desire_tui.engine.visible_text import visible

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.formats import DataFormat, PictureFormat
    from desire_tui.engine.outputs.picture_options import PictureOptions
    from desire_tui.engine.outputs.results import Result
    from desire_tui.engine.session.session import Session

STANDARD_OUTPUT = "-"
_PLOT_ROWS = 24


@dataclass(frozen=True)
class OutputFiles:
    """Files asked for on the command line, by the format's name; `-` is standard output."""

    files: Mapping[str, str] = field(default_factory=dict)
    plot: bool = False
    """Whether the last graph is to be printed as text."""
    picture: PictureOptions = FOR_PAPER

    @property
    def takes_stdout(self) -> bool:
        """Whether standard output belongs to a file, so that console text has to go elsewhere."""
        return STANDARD_OUTPUT in self.files.values()

    def write(self, session: Session, result: Callable[[], Result]) -> None:
        """Write everything.

        DesireError 106: something cannot be written; 471: no graph for a picture; 40: too much for a file.
        """
        for picture in PICTURES:
            if picture.name in self.files:
                _write_pictures(session, self.files[picture.name], picture, self.picture)
        for data in DATA:
            if data.name in self.files:
                _check_memory(session, data)
                _write_data(result(), self.files[data.name], data)
        if self.plot:
            _print_plot(session)


def _check_memory(session: Session, data: DataFormat) -> None:
    """DesireError 40: the quantities' way into a file would fill the machine's memory."""
    numbers = sum(quantity.size for quantity in session.values)
    if data.memory * numbers > session.values.spare:
        raise DesireError(Diagnostic("out-of-memory", facts={"elements": numbers}))


def _write_data(result: Result, name: str, data: DataFormat) -> None:
    if name == STANDARD_OUTPUT:
        if data.is_text and sys.stdout.isatty():
            text = StringIO()
            data.write(result, text)
            sys.stdout.write(visible(text.getvalue()))
        else:
            data.write(result, sys.stdout if data.is_text else sys.stdout.buffer)
        sys.stdout.flush()
        return
    write = write_file if data.is_text else write_bytes
    write(Path(name), lambda file: data.write(result, file))


def _write_pictures(session: Session, name: str, picture: PictureFormat, options: PictureOptions) -> None:
    """One graph: NAME; several: NAME-1, NAME-2 …; on standard output: the last one."""
    graphs = _graphs(session)
    if name == STANDARD_OUTPUT:
        sys.stdout.buffer.write(picture.content(graphs[-1], options))
        sys.stdout.flush()
        return
    path = Path(name)
    if path.suffix.lower() != picture.ending:
        path = path.with_name(path.name + picture.ending)
    write_pictures(graphs, path, options)


def _print_plot(session: Session) -> None:
    import shutil

    from desire_tui.engine.outputs.text_plot import text_plot

    columns, rows = shutil.get_terminal_size((80, _PLOT_ROWS + 2))
    rows = max(min(rows - 2, columns // 3), 12)
    sys.stdout.write(text_plot(_graphs(session)[-1], columns, rows, colored=sys.stdout.isatty()))
    sys.stdout.flush()


def _graphs(session: Session) -> list[Graph]:
    graphs = [page for page in session.graphs if not page.is_empty]
    if not graphs:
        raise DesireError(Diagnostic("no-graph"))
    return graphs
