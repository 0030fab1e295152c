"""The formats that results are written in: a new one is an entry here and its writer."""

from __future__ import annotations

from typing import IO, TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.outputs.picture_options import PictureOptions
    from desire_tui.engine.outputs.results import Result


# Every start of the program reads this list: what draws and writes is imported when it is needed, and these
# are plain classes, since dataclasses take a millisecond each to define


class OutputFormat:
    """A file format. `name` is its option of `desire run`, `ending` of its files' names, with the dot."""

    def __init__(self, name: str, title: str, about: str, ending: str | None = None) -> None:
        self.name, self.title, self.about = name, title, about
        self.ending = f".{name}" if ending is None else ending


class PictureFormat(OutputFormat):
    """A format for graphs: `content` returns what the file of one holds.

    `document`: what a file of several holds, a page each; None: the format has no pages.
    """

    def __init__(
        self,
        name: str,
        title: str,
        about: str,
        content: Callable[[Graph, PictureOptions], bytes],
        document: Callable[[Sequence[Graph], PictureOptions], bytes] | None = None,
    ) -> None:
        super().__init__(name, title, about)
        self.content, self.document = content, document


class DataFormat(OutputFormat):
    """A format for everything that a program produced.

    `write` gets a text file if `is_text`, else a binary one. `write_points` writes the points of `plot`
    where a file holds one table, so that they need one of their own. `memory`: how many numbers' worth of
    memory a number takes on its way into the file. `needs`: a module that comes with the extra `data`.
    """

    def __init__(
        self,
        name: str,
        title: str,
        about: str,
        write: Callable[[Result, IO[Any]], object],
        *,
        is_text: bool = False,
        memory: int,
        write_points: Callable[[Result, IO[Any]], object] | None = None,
        ending: str | None = None,
        needs: str | None = None,
    ) -> None:
        super().__init__(name, title, about, ending)
        self.write, self.write_points, self.is_text, self.memory = write, write_points, is_text, memory
        self.needs = needs


def _picture(kind: str) -> Callable[[Graph, PictureOptions], bytes]:
    def content(graph: Graph, options: PictureOptions) -> bytes:
        from desire_tui.engine.outputs.matplotlib_figure import picture_of

        return picture_of(graph, kind, options)

    return content


def _pages(graphs: Sequence[Graph], options: PictureOptions) -> bytes:
    from desire_tui.engine.outputs.matplotlib_figure import pdf_of

    return pdf_of(graphs, options)


def _csv(result: Result, file: IO[str]) -> None:
    from desire_tui.engine.outputs.csv_file import write_csv

    write_csv(result.runs, file)


def _csv_points(result: Result, file: IO[str]) -> None:
    from desire_tui.engine.outputs.csv_file import write_points

    write_points(result.plots, file)


def _json(result: Result, file: IO[str]) -> None:
    from desire_tui.engine.outputs.json_file import as_json

    file.write(as_json(result))


def _npz(result: Result, file: IO[bytes]) -> None:
    from desire_tui.engine.outputs.npz_file import write_npz

    write_npz(result, file)


def _parquet(result: Result, file: IO[bytes]) -> None:
    from desire_tui.engine.outputs.parquet_file import write_parquet

    write_parquet(result, file)


def _parquet_points(result: Result, file: IO[bytes]) -> None:
    from desire_tui.engine.outputs.parquet_file import write_points

    write_points(result, file)


def _netcdf(result: Result, file: IO[bytes]) -> None:
    from desire_tui.engine.outputs.netcdf_file import write_netcdf

    write_netcdf(result, file)


PNG = PictureFormat(
    "png", "PNG", "Write the graph as PNG; several graphs: F-1.png, F-2.png …", _picture("png")
)
CSV = DataFormat(
    "csv", "CSV", "Write all samples: one row each, columns run, t, names ….", _csv, is_text=True, memory=1,
    write_points=_csv_points,
)  # fmt: skip

PICTURES = (
    PNG,
    PictureFormat("svg", "SVG", "Write the graph as SVG.", _picture("svg")),
    PictureFormat("pdf", "PDF", "Write the graphs as PDF, a page each.", _picture("pdf"), _pages),
)
DATA = (
    CSV,
    # the whole text is made in one piece
    DataFormat("json", "JSON", "Write everything the program produced.", _json, is_text=True, memory=16),
    DataFormat(
        "npz", "NPZ", "Write samples (1/t, 1/x … of run 1) and final values for numpy.load.", _npz,
        memory=1,
    ),
    DataFormat(
        "parquet", "Parquet", "Write the table of --csv for pandas, Polars, DuckDB ….", _parquet, memory=4,
        write_points=_parquet_points, needs="pyarrow",
    ),
    DataFormat(
        "netcdf", "NetCDF", "Write samples, parameters and points for xarray, MATLAB ….", _netcdf, memory=4,
        ending=".nc", needs="scipy",
    ),
)  # fmt: skip
FORMATS: tuple[OutputFormat, ...] = (*PICTURES, *DATA)


def endings(formats: Sequence[OutputFormat]) -> str:
    """Return the endings as a sentence names them: `.png, .svg or .pdf`."""
    *others, last = (known.ending for known in formats)
    return f"{', '.join(others)} or {last}" if others else last
