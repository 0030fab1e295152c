"""Where the results of a headless run go."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.results import Result
    from desire_tui.engine.session.session import Session

STANDARD_OUTPUT = "-"
_PLOT_ROWS = 24
_COPY, _TEXT = 1, 16
"""Numbers' worth of memory that a number takes on its way into a file: copied, and as text in one piece."""


@dataclass(frozen=True)
class OutputFiles:
    """Files asked for on the command line; `-` is standard output."""

    png: str | None = None
    svg: str | None = None
    pdf: str | None = None
    csv: str | None = None
    json: str | None = None
    npz: str | None = None
    plot: bool = False

    @property
    def takes_stdout(self) -> bool:
        """Whether standard output belongs to a file, so that console text has to go elsewhere."""
        return STANDARD_OUTPUT in (self.png, self.svg, self.pdf, self.csv, self.json, self.npz)

    def write(self, session: Session, result: Callable[[], Result]) -> None:
        """Write everything.

        DesireError 106: something cannot be written; 471: no graph for a picture; 40: too much for a file.
        """
        for kind in ("png", "svg", "pdf"):
            name = getattr(self, kind)
            if name is not None:
                _pictures(session, name, f".{kind}")
        if self.csv is not None:
            from desire_tui.engine.outputs.data_files import write_csv

            _needs_room(session, _COPY)
            _text(self.csv, lambda file: write_csv(result(), file))
        if self.json is not None:
            from desire_tui.engine.outputs.data_files import as_json

            _needs_room(session, _TEXT)
            _text(self.json, lambda file: file.write(as_json(result())))
        if self.npz is not None:
            _needs_room(session, _COPY)
            _archive(self.npz, result())
        if self.plot:
            _plot(session)


def _needs_room(session: Session, each: int) -> None:
    """Refuse to copy quantities that would fill the machine's memory."""
    numbers = sum(quantity.size for quantity in session.values)
    if each * numbers > session.values.spare:
        raise DesireError(Diagnostic("out-of-memory", facts={"elements": numbers}))


def _text(name: str, write) -> None:  # type: ignore[no-untyped-def]  # noqa: ANN001
    from desire_tui.engine.files import write_file

    if name == STANDARD_OUTPUT:
        write(sys.stdout)
        sys.stdout.flush()
    else:
        write_file(Path(name), write)


def _archive(name: str, result: Result) -> None:
    from desire_tui.engine.files import write_bytes
    from desire_tui.engine.outputs.data_files import write_npz

    if name == STANDARD_OUTPUT:
        write_npz(result, sys.stdout.buffer)
        sys.stdout.buffer.flush()
    else:
        write_bytes(Path(name), lambda file: write_npz(result, file))


def _pages(session: Session) -> list[Graph]:
    pages = [page for page in session.graphs if not page.is_empty]
    if not pages:
        raise DesireError(Diagnostic("no-graph"))
    return pages


def _pictures(session: Session, name: str, ending: str) -> None:
    """One graph: NAME; several: NAME-1, NAME-2 …; on standard output: the last one."""
    from desire_tui.engine.outputs.picture_file import picture_of, write_picture

    pages = _pages(session)
    if name == STANDARD_OUTPUT:
        sys.stdout.buffer.write(picture_of(pages[-1], ending[1:]))
        sys.stdout.buffer.flush()
        return
    path = Path(name)
    if path.suffix.lower() != ending:
        path = path.with_name(path.name + ending)
    if len(pages) == 1:
        write_picture(pages[0], path)
        return
    for number, page in enumerate(pages, 1):
        write_picture(page, path.with_name(f"{path.stem}-{number}{path.suffix}"))


def _plot(session: Session) -> None:
    import shutil

    from desire_tui.engine.outputs.text_plot import text_plot

    columns, rows = shutil.get_terminal_size((80, _PLOT_ROWS + 2))
    rows = max(min(rows - 2, columns // 3), 12)
    sys.stdout.write(text_plot(_pages(session)[-1], columns, rows, colored=sys.stdout.isatty()))
    sys.stdout.flush()
