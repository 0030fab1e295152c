"""What an analysis finds: tables and charts, notes in words, and numbers by name for programs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from desire_tui.engine.graph.chart import Chart

_GAP = "  "
_ROWS_SHOWN = 40


@dataclass(frozen=True)
class Table:
    """Columns by name, all of the same length: numbers or words."""

    title: str
    columns: Mapping[str, Sequence[Any]]
    is_listed: bool = True
    """False: for files only, a terminal does not show it."""

    def rows(self) -> Iterator[tuple[Any, ...]]:
        """Yield its rows."""
        return zip(*self.columns.values(), strict=True)

    def lines(self) -> list[str]:
        """Return it as text, numbers flush right; of very many rows the first and the last."""
        names = list(self.columns)
        cells = [[_cell(value) for value in column] for column in self.columns.values()]
        widths = [max(map(len, [name, *column])) for name, column in zip(names, cells, strict=True)]
        right = [any(not isinstance(v, str) for v in column) for column in self.columns.values()]

        def line(row: Sequence[str]) -> str:
            parts = [
                text.rjust(width) if flush else text.ljust(width)
                for text, width, flush in zip(row, widths, right, strict=True)
            ]
            return _GAP.join(parts).rstrip()

        rows = [line(row) for row in zip(*cells, strict=True)]
        if len(rows) > _ROWS_SHOWN:
            half = _ROWS_SHOWN // 2
            rows[half:-half] = [f"… {len(rows) - 2 * half} more"]
        return [*([self.title] if self.title else []), line(names), *rows]


def _cell(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:.6g}" if isinstance(value, float) else str(value)


class LiveChart(Protocol):
    """Charts that follow what is done on the desktop, within some ten milliseconds."""

    def moved(self, values: Mapping[str, float]) -> Chart:
        """Return the chart with the sliders at these values."""
        ...

    def started(self, x: float, y: float) -> Chart:
        """Return the chart with an orbit that begins at a place of it."""
        ...


@dataclass
class Result:
    """Of one analysis of one program.

    `values` holds numbers and arrays by name: what Python programs and `--json` get.
    `is_partial`: it was stopped by the user before its end.
    """

    title: str
    values: dict[str, Any] = field(default_factory=dict)
    tables: list[Table] = field(default_factory=list)
    charts: list[Chart] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    is_partial: bool = False
    live: LiveChart | None = None
    """What redraws the first chart when a slider is moved or an orbit is begun."""

    def lines(self) -> list[str]:
        """Return what a terminal shows of it."""
        told = [f"{self.title} (stopped: what was found so far)" if self.is_partial else self.title]
        for table in filter(lambda table: table.is_listed, self.tables):
            told += table.lines()
        return told + self.notes

    def __getitem__(self, name: str) -> Any:
        """Return a number or an array by name. KeyError: it is not there."""
        return self.values[name]

    def __repr__(self) -> str:
        return "\n".join(self.lines())
