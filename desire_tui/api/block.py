"""A run's samples while it goes on, block by block."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.api.interrupts import callers_code

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.outputs.run import Run
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.session.prepared_run import PreparedRun


class Block:
    """New samples of a run that goes on: a mapping from names to arrays, `t` among them."""

    def __init__(self, record: RunRecord, first: int) -> None:
        self._record, self._first = record, first

    @property
    def t(self) -> NDArray[np.float64]:
        """Times of the samples."""
        return self["t"]

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        record = self._record
        samples = record.t if name == "t" else record.values(name)
        return samples[self._first :].copy()

    @property
    def run(self) -> Run:
        """The run as far as it has come."""
        from desire_tui.engine.outputs.results import run_data

        return run_data(self._record, more=True)

    def keys(self) -> list[str]:
        """Return the names of what is recorded."""
        return ["t", *dict.fromkeys(column.name for column in self._record.columns if column.name != "t")]

    def __iter__(self) -> Any:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.keys())


class Blocks:
    """Hands blocks of samples on; False ends the run."""

    def __init__(self, on_block: Callable[[Block], object] | None, prepared: PreparedRun) -> None:
        self._on_block, self._prepared = on_block, prepared

    def block(self, record: RunRecord, first_row: int) -> None:
        """Note new samples."""
        if self._on_block is None:
            return
        with callers_code():
            answer = self._on_block(Block(record, first_row))
        if answer is False:
            self._prepared.end()
