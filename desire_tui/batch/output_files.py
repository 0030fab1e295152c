"""Writes the results of a headless run to files and standard output."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from io import StringIO
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.diagnostics import DesireError, Diagnostic, internal_error
from desire_tui.engine.files import write_bytes, write_file
from desire_tui.engine.outputs.formats import DATA, PICTURES
from desire_tui.engine.outputs.picture_files import write_pictures
from desire_tui.engine.outputs.picture_options import FOR_PAPER
from desire_tui.engine.visible_text import visible

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

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

    def write(self, session: Session, result: Callable[[], Result]) -> tuple[Diagnostic, ...]:
        """Write everything, data first; return what kept files from being written, each on its own.

        Errors 106: a file cannot be written; 40: too much for it. Warning 471: there is no graph.
        """
        problems: list[Diagnostic] = []
        for data in DATA:
            if data.name in self.files:
                with _noting(problems):
                    _check_memory(session, data)
                    _write_data(result(), self.files[data.name], data)
        pictures = [picture for picture in PICTURES if picture.name in self.files]
        graphs = [page for page in session.graphs if not page.is_empty]
        if (pictures or self.plot) and not graphs:
            wanted = [f"--{picture.name}" for picture in pictures] + (["--plot"] if self.plot else [])
            facts = {"files": ", ".join(wanted)}
            problems.append(Diagnostic("graph-missing", facts=facts, severity="warning"))
            return tuple(problems)
        for picture in pictures:
            with _noting(problems):
                _write_pictures(graphs, self.files[picture.name], picture, self.picture)
        if self.plot:
            with _noting(problems):
                _print_plot(graphs[-1])
        return tuple(problems)


@contextmanager
def _noting(problems: list[Diagnostic]) -> Iterator[None]:
    """Keep what is wrong with one output from the others. Lost standard output is nobody's to be told of."""
    try:
        yield
    except DesireError as error:
        problems.extend(error.diagnostics)
    except OSError:
        raise
    except Exception as error:  # noqa: BLE001 - a fault of ours is a message too
        problems.append(internal_error("results were written", error))


def _check_memory(session: Session, data: DataFormat) -> None:
    """DesireError 40: the quantities' way into a file would fill the machine's memory."""
    numbers = sum(quantity.size for quantity in session.values)
    if data.memory * numbers > session.values.spare:
        raise DesireError(Diagnostic("out-of-memory", facts={"elements": numbers}))


def _write_data(result: Result, name: str, data: DataFormat) -> None:
    """Write the samples; points of `plot` into the same file, one of their own, or the only one."""
    only_points = data.write_points is not None and bool(result.plots) and not result.runs
    _write_one(result, name, data, data.write_points if only_points and data.write_points else data.write)
    if data.write_points is not None and result.plots and result.runs and name != STANDARD_OUTPUT:
        path = Path(name)
        points = path.with_name(f"{path.stem}-points{path.suffix}")
        _write_one(result, str(points), data, data.write_points)


def _write_one(
    result: Result, name: str, data: DataFormat, write: Callable[[Result, IO[Any]], object]
) -> None:
    if name == STANDARD_OUTPUT:
        if data.is_text and sys.stdout.isatty():
            text = StringIO()
            write(result, text)
            sys.stdout.write(visible(text.getvalue()))
        else:
            write(result, sys.stdout if data.is_text else sys.stdout.buffer)
        sys.stdout.flush()
        return
    into_file = write_file if data.is_text else write_bytes
    into_file(Path(name), lambda file: write(result, file))


def _write_pictures(
    graphs: Sequence[Graph], name: str, picture: PictureFormat, options: PictureOptions
) -> None:
    """One graph: NAME; several: NAME-1, NAME-2 …, a document's pages; on standard output: the last one."""
    if name == STANDARD_OUTPUT:
        document = picture.document
        sys.stdout.buffer.write(
            document(graphs, options) if document is not None else picture.content(graphs[-1], options)
        )
        sys.stdout.flush()
        return
    path = Path(name)
    if path.suffix.lower() != picture.ending:
        path = path.with_name(path.name + picture.ending)
    write_pictures(graphs, path, options)


def _print_plot(graph: Graph) -> None:
    import shutil

    from desire_tui.engine.outputs.text_plot import text_plot

    columns, rows = shutil.get_terminal_size((80, _PLOT_ROWS + 2))
    rows = max(min(rows - 2, columns // 3), 12)
    sys.stdout.write(text_plot(graph, columns, rows, colored=sys.stdout.isatty()))
    sys.stdout.flush()
