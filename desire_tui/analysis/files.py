"""What an analysis finds as files: tables as CSV, everything as JSON, charts as pictures."""

from __future__ import annotations

import csv
import json
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.files import write_file
from desire_tui.engine.graph.chart_page import begin_page
from desire_tui.engine.graph.pages import GraphPages
from desire_tui.engine.outputs.formats import PICTURES

if TYPE_CHECKING:
    from pathlib import Path
    from typing import IO

    from desire_tui.analysis.result import Result, Table

ENDINGS = (".csv", ".json", *(known.ending for known in PICTURES))


def check_ending(path: Path) -> None:
    """DesireError 520: nothing is written to files of this ending."""
    if path.suffix.lower() not in ENDINGS:
        facts = {"what": f"{path.name} is no file for results", "remedy": f"endings: {', '.join(ENDINGS)}"}
        raise DesireError(Diagnostic("analysis-form", None, facts))


def write(result: Result, path: Path, program: str) -> None:
    """Write a result; several tables go to NAME.csv, NAME-2.csv …, charts likewise.

    DesireError 520: its ending; 106: the file cannot be written; 471: it has nothing for such a file.
    """
    check_ending(path)
    match path.suffix.lower():
        case ".csv":
            for number, table in enumerate(result.tables, 1):
                write_file(_numbered(path, number), partial(_csv, table))
        case ".json":
            write_file(path, lambda file: json.dump(_plain(result, program), file, indent=1))
        case _:
            from desire_tui.engine.outputs.picture_files import write_pictures

            pages = GraphPages()
            graphs = [begin_page(pages, chart, program) for chart in result.charts]
            if not graphs:
                raise DesireError(Diagnostic("graph-missing", facts={"files": path.name}))
            write_pictures(graphs, path)


def _numbered(path: Path, number: int) -> Path:
    return path if number == 1 else path.with_name(f"{path.stem}-{number}{path.suffix}")


def _csv(table: Table, file: IO[str]) -> None:
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(table.columns)
    writer.writerows(table.rows())


def _plain(result: Result, program: str) -> dict[str, Any]:
    tables = {table.title or str(n): dict(table.columns) for n, table in enumerate(result.tables, 1)}
    found = {"program": program, "title": result.title, "is_partial": result.is_partial,
             "values": result.values, "tables": tables, "notes": result.notes}  # fmt: skip
    plain: dict[str, Any] = _jsonable(found)
    return plain


def _jsonable(value: Any) -> Any:
    """Return a value as JSON has it: nan and infinities as null, complex numbers as [real, imaginary]."""
    if isinstance(value, dict):
        return {str(name): _jsonable(item) for name, item in value.items()}
    if isinstance(value, np.ndarray):
        return _jsonable(value.tolist())
    if isinstance(value, list | tuple):
        return [_jsonable(item) for item in value]
    if isinstance(value, np.generic):
        return _jsonable(value.item())
    if isinstance(value, complex):
        return [_jsonable(value.real), _jsonable(value.imag)]
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
