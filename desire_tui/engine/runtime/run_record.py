"""One run as the outside sees it: its settings, its samples as they grow, why it ended."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import SampleColumn, SampleRequest
    from desire_tui.engine.runtime.point_set import PointSet
    from desire_tui.engine.runtime.start_values import StartValues

EndedWord = Literal["running", "tmax", "term", "stopped", "failed"]


@dataclass(eq=False)
class RunRecord:
    """A run. The engine's thread appends; any thread may read: rows below `count` never change.

    `rows` is capacity × (1 + columns): t, then each requested column. It may be *replaced* by a larger array
    as it grows, so take `rows` once and `count` before it.
    """

    number: int
    segment: str | None
    line: int
    requests: tuple[SampleRequest, ...]
    columns: tuple[SampleColumn, ...]
    overlay: bool
    rule: int
    scale: float
    t0: float
    t_max: float
    nn: int
    dt: float
    error_max: float = 0.0
    """ERMAX of rules that look at it, else 0."""
    start: StartValues | None = None
    """Parameters and states as they were when it began."""
    rows: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 1)))
    count: int = 0
    ended: EndedWord = "running"
    end_time: float = 0.0
    steps: int = 0
    rejected: int = 0
    derivative_calls: int = 0
    jacobian_calls: int = 0
    dt_least: float = 0.0
    dt_most: float = 0.0
    order: int = 0
    gap: int = 0
    """1 + the first row with an inf or nan that ended no run; 0: none."""
    seconds: float = 0.0
    compile_seconds: float = 0.0
    message: str = ""
    pictures: list[tuple[NDArray[np.float64], ...]] = field(default_factory=list)
    """What SHOW kept: of each sample a copy of each shown array, in the order of the SHOW statements.

    When there are too many, of every `picture_every`-th sample from the first one, and of the newest.
    """
    picture_every: int = 1
    points: tuple[PointSet, ...] = ()
    """What was measured, to be drawn over its curves."""

    def __post_init__(self) -> None:
        """Give the rows their width: a run that fails at once has none, but columns."""
        if not len(self.rows) and self.rows.shape[1] <= len(self.columns):
            self.rows = np.zeros((0, 1 + len(self.columns)))

    @property
    def t(self) -> NDArray[np.float64]:
        """Sample times so far."""
        count = self.count
        return self.rows[:count, 0]

    @property
    def time_range(self) -> tuple[float, float]:
        """The times that a graph over t shows; a run backward goes from the right to the left."""
        end = self.t0 + self.t_max
        return min(self.t0, end), max(self.t0, end)

    @property
    def slots(self) -> list[int]:
        """Where the columns' variables stand among the quantities."""
        return [column.slot for column in self.columns]

    @property
    def bytes(self) -> int:
        """How much memory its samples and pictures take."""
        return self.rows.nbytes + sum(shown.nbytes for picture in list(self.pictures) for shown in picture)

    def thin(self, rows_most: int) -> None:
        """Keep every n-th sample and the last, and the last picture: enough for a graph."""
        del self.pictures[:-1]
        step = -(-(self.count - 1) // (rows_most - 1))
        if step > 1:
            kept = self.rows[np.r_[0 : self.count - 1 : step, self.count - 1]]
            self.count = min(self.count, len(kept))
            self.rows = kept

    def first_column(self, request: SampleRequest) -> int:
        """Return where a request's variables begin in `columns`, which holds all requests' in turn."""
        before = 0
        for known in self.requests:
            if known is request:
                break
            before += len(known.columns)
        return before

    def values(self, name: str) -> NDArray[np.float64]:
        """Return a requested variable's samples so far; KeyError for a name that was not requested."""
        count = self.count
        for number, column in enumerate(self.columns):
            if column.name == name:
                return self.rows[:count, 1 + number]
        raise KeyError(name)
