"""Where results go as they come: memory, or a Zarr folder that a later study may go on with."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.studies.dataset import (
    ERROR,
    ERROR_NOTE,
    NOT_MADE,
    attributes,
    by_variable,
    dataset,
    layouts,
    scales,
)
from desire_tui.studies.design import RUN
from desire_tui.studies.plan import boxes
from desire_tui.studies.task import Failures

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from desire_tui.studies.dataset import Layout
    from desire_tui.studies.plan import Plan
    from desire_tui.studies.task import Chunk

_PIECE = 1 << 17
"""Numbers in a file of a Zarr folder, about."""


class Store(Protocol):
    """Takes chunks in any order."""

    failures: Failures

    def missing(self) -> Iterator[tuple[int, int]]:
        """Yield stretches of runs that are not there yet: the first, how many."""
        ...

    def put(self, chunk: Chunk) -> None:
        """Keep what some runs gave."""

    def result(self) -> Any:
        """Return all that is there, as a Dataset."""
        ...


class MemoryStore:
    """Keeps results in memory."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self.failures = Failures()
        self._numbers = {layout.name: np.full(layout.shape, np.nan) for layout in layouts(plan)}
        self._errors = np.full(plan.runs, NOT_MADE, dtype=np.int16)

    def missing(self) -> Iterator[tuple[int, int]]:
        """Yield all runs."""
        yield 0, self._plan.runs

    def put(self, chunk: Chunk) -> None:
        """Keep what some runs gave."""
        first, last = chunk.first, chunk.first + len(chunk.errors)
        inner = len(self._plan.design.shape)
        for layout, part in by_variable(self._plan, chunk.numbers):
            flat = self._numbers[layout.name].reshape(self._plan.runs, *layout.shape[inner:])
            flat[first:last] = part
        self._errors[first:last] = chunk.errors
        self.failures.merge(chunk.failures)

    def numbers(self, layout: Layout) -> NDArray[np.float64]:
        """Return what a quantity is in each run, (runs, numbers): nan where it is not made, or failed."""
        return self._numbers[layout.name].reshape(self._plan.runs, -1)

    def result(self) -> Any:
        """Return a Dataset that shares the memory."""
        return dataset(self._plan, self._numbers, self._errors, self.failures)


class ZarrStore:
    """Keeps results in a Zarr folder. DesireError 513: it holds another study; it is there already."""

    def __init__(self, plan: Plan, path: Path, *, resume: bool) -> None:
        import zarr

        self._plan, self._path = plan, path
        self.failures = Failures()
        if path.exists():
            if not resume:
                raise DesireError(Diagnostic("study-store-there", None, {"path": str(path)}))
            self._group = self._known(zarr)
            return
        self._group = zarr.open_group(path, mode="w", zarr_format=3)
        self._group.attrs.update({**attributes(plan, self.failures), "study": json.dumps(plan.description())})
        own = tuple(axis.name for axis in plan.design.axes)
        for name, numbers in scales(plan).items():
            self._array(name, numbers.shape, (name,), "f8", np.nan)[:] = numbers
        self._write_drawn()
        for layout in layouts(plan):
            self._array(_file_name(layout.name), layout.shape, layout.dimensions, "f8", np.nan)
        error = self._array(ERROR, plan.design.shape, own, "i2", NOT_MADE)
        error.attrs["long_name"] = ERROR_NOTE

    def _write_drawn(self) -> None:
        """Write what was drawn or listed, piece by piece: there may be more than memory holds."""
        design = self._plan.design
        names = design.drawn_names
        if not names:
            return
        self._group.attrs["coordinates"] = " ".join(names)
        arrays = {name: self._array(name, (design.draws,), (RUN,), "f8", np.nan) for name in names}
        for first in range(0, design.draws, _PIECE):
            count = min(_PIECE, design.draws - first)
            for name, numbers in design.drawn(first, count).items():
                arrays[name][first : first + count] = numbers

    def _array(
        self, name: str, shape: tuple[int, ...], dimensions: tuple[str, ...], kind: str, fill: float
    ) -> Any:
        pieces, room = list(shape), _PIECE
        for k in range(len(shape) - 1, -1, -1):
            pieces[k] = max(min(shape[k], room), 1)
            room //= pieces[k]
        return self._group.create_array(
            name, shape=shape, chunks=tuple(pieces), dtype=kind, fill_value=fill, dimension_names=dimensions
        )

    def _known(self, zarr: Any) -> Any:
        try:
            group = zarr.open_group(self._path, mode="r+")
            told = json.loads(group.attrs["study"])
        except Exception:  # noqa: BLE001 - whatever the library says of a folder that is no store of ours
            raise self._other("it is no study that can be gone on with") from None
        wanted = json.loads(json.dumps(self._plan.description()))
        for name, value in wanted.items():
            if told.get(name) != value:
                raise self._other(_difference(name, told.get(name), value))
        for code, (run, message, count) in json.loads(group.attrs.get("failed runs", "{}")).items():
            self.failures.by_code[int(code)] = run, message, count
        return group

    def _other(self, what: str) -> DesireError:
        return DesireError(Diagnostic("study-store", None, {"path": str(self._path), "what": what}))

    def missing(self) -> Iterator[tuple[int, int]]:
        """Yield stretches of runs that are not there yet."""
        error, shape = self._group[ERROR], self._plan.design.shape
        step = max(_PIECE, 1)
        begin: int | None = None
        for first in range(0, self._plan.runs, step):
            count = min(step, self._plan.runs - first)
            parts = [np.asarray(error[box]).reshape(-1) for box in boxes(first, count, shape)]
            absent = np.concatenate(parts) == NOT_MADE
            edges = np.flatnonzero(np.diff(absent.astype(np.int8), prepend=begin is not None)) + first
            for edge in edges.tolist():
                if begin is None:
                    begin = edge
                else:
                    yield begin, edge - begin
                    begin = None
        if begin is not None:
            yield begin, self._plan.runs - begin

    def put(self, chunk: Chunk) -> None:
        """Write what some runs gave; that they were made is written last."""
        shape, count = self._plan.design.shape, len(chunk.errors)
        placed = [(box, _size(box)) for box in boxes(chunk.first, count, shape)]
        for layout, part in by_variable(self._plan, chunk.numbers):
            self._fill(self._group[_file_name(layout.name)], placed, part)
        self.failures.merge(chunk.failures)
        if chunk.failures.by_code:
            self._group.attrs.update(
                {
                    **attributes(self._plan, self.failures),
                    "failed runs": json.dumps(self.failures.by_code),
                }
            )
        self._fill(self._group[ERROR], placed, chunk.errors)

    @staticmethod
    def _fill(array: Any, placed: list[tuple[tuple[slice, ...], int]], part: Any) -> None:
        begin = 0
        for box, size in placed:
            shape = tuple(one.stop - one.start for one in box)
            array[box] = part[begin : begin + size].reshape(*shape, *part.shape[1:])
            begin += size

    def result(self) -> Any:
        """Return what is there, read from the folder piece by piece as it is used."""
        import xarray as xr

        return xr.open_zarr(self._path, consolidated=False, chunks=None)


def _size(box: tuple[slice, ...]) -> int:
    size = 1
    for one in box:
        size *= one.stop - one.start
    return size


def _file_name(label: str) -> str:
    """Return a variable's name as files may have it: a slash would be a folder."""
    return label.replace("/", "÷")


def _difference(name: str, before: object, now: object) -> str:
    if name == "program":
        return "its program's text is another"
    before_text, now_text = json.dumps(before), json.dumps(now)
    if len(before_text) + len(now_text) > 200:
        return f"its {name} is another"
    return f"its {name} is {before_text}, not {now_text}"
