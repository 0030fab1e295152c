"""Stash files: time histories kept between runs and sessions (book 1.3.7.3; the form is this project's).

NPY, samples × variables, so that other tools read them. The k-th recovered variable takes the k-th stashed
one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.files import write_bytes
from desire_tui.engine.lowered.statements import GetHistory
from desire_tui.engine.program_files import exists, open_for_program

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import SampleColumn, Segment
    from desire_tui.engine.values import Values


def write_stash(path: Path, histories: NDArray[np.float64]) -> None:
    """Write the file as a whole, or leave the old one. DesireError 106."""
    rows = np.ascontiguousarray(histories)
    # a program may write it after each of many runs: they do not wait for the disk
    write_bytes(path, lambda file: np.save(file, rows, allow_pickle=False), sync=False)


def read_stash(path: Path, wanted: tuple[SampleColumn, ...], segment: Segment) -> NDArray[np.float64]:
    """Return the file's samples × variables. DesireError 92: missing, unreadable or too narrow."""
    where = wanted[0].where.span
    facts: dict[str, object] = {"path": path, "wanted": len(wanted)}
    if not exists(path):
        raise DesireError(Diagnostic("stash-missing", where, facts, segment.source))
    found = _histories(path)
    if found is None:
        raise DesireError(Diagnostic("stash-unreadable", where, facts, segment.source))
    if found.shape[1] < len(wanted):
        facts["found"] = found.shape[1]
        raise DesireError(Diagnostic("stash-narrow", where, facts, segment.source))
    return found


def _histories(path: Path) -> NDArray[np.float64] | None:
    """Return a file's samples × variables; None for a file that is anything else, whatever it says it is."""
    try:
        with open_for_program(path, "rb") as file:
            if np.lib.format.read_magic(file) != (1, 0):
                return None
            shape, by_columns, kind = np.lib.format.read_array_header_1_0(file)
            numbers = np.frombuffer(file.read(), dtype=np.float64)
            if kind != np.float64 or len(shape) != 2 or min(shape, default=0) < 1:
                return None
            return numbers.reshape(shape, order="F" if by_columns else "C")
    except Exception:  # noqa: BLE001 - a header may hold anything, and be refused by anything
        return None


def with_recovery(segment: Segment, samples: int, values: Values) -> tuple[Segment, tuple[int, ...]]:
    """Return the segment with its `recover` line as `get` statements, and the slots to fill.

    The arrays have no name: they are nobody's quantities.
    """
    slots = []
    for column in segment.recover:
        hidden = f"recover {column.name}"
        slots.append(values.array(hidden, (samples,)).slot)
        del values.names[hidden]
    gets = tuple(
        GetHistory(column.slot, slot, samples, segment.counters + number, column.where)
        for number, (column, slot) in enumerate(zip(segment.recover, slots, strict=True))
    )
    changed = replace(segment, body=gets + segment.body, counters=segment.counters + len(gets), recover=())
    return changed, tuple(slots)
