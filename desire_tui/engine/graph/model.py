"""A graph: its frame, and what stands in it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.engine.graph.color_keys import color_keys

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from desire_tui.engine.graph.color_keys import Key
    from desire_tui.engine.runtime.run_record import RunRecord

    Floats = NDArray[np.float64]

SQUARE_MOST = 0.9
"""Side of the largest square of a picture that shows sizes, in parts of its cell: a gap parts neighbours."""
Fit = Literal["no", "asked", "unset"]
"""Whether a graph is fitted to its curves: `display fit`; `unset`: the program never sets `scale`, and a
curve leaves the scale of 1 that Desire starts with."""
FEW_POINTS = 100
_NAME_LEAST = 4
FrameKind = Literal["dispt", "dispxy", "DISPXY", "plot", "picture"]


@dataclass(frozen=True, slots=True)
class Frame:
    """The window of program values that a graph shows: `left … right` by `bottom … top`."""

    kind: FrameKind
    left: float
    right: float
    bottom: float
    top: float
    scale: float


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """One curve of one run; its samples grow while the run goes on.

    `frame` is the window of its own run: in a graph shared by runs (`display 2`) every curve keeps the scale
    it was made with, as ink on a screen does. `joined`: neighbouring samples are joined by lines; maps
    (dispxy without `d/dt`) are clouds of dots.
    """

    name: str
    x_name: str
    color: int
    record: RunRecord
    y_column: int
    x_column: int
    frame: Frame
    thickness: int = 1
    joined: bool = True

    @property
    def count(self) -> int:
        """Samples so far."""
        return self.record.count

    def samples(self, start: int = 0, stop: int | None = None) -> tuple[Floats, Floats]:
        """Abscissas and ordinates of samples `start … stop - 1` (default: all so far), in program units."""
        count = self.record.count
        rows = self.record.rows
        stop = count if stop is None else min(stop, count)
        return rows[start:stop, self.x_column], rows[start:stop, self.y_column]


@dataclass(slots=True, eq=False)
class Points:
    """Points of an interpreter plot, in program units; rows below `count` never change."""

    rows: Floats = field(default_factory=lambda: np.empty((256, 2)))
    colors: NDArray[np.uint8] = field(default_factory=lambda: np.empty(256, dtype=np.uint8))
    count: int = 0

    def add(self, x: float, y: float, color: int) -> None:
        """Append a point."""
        if self.count == len(self.rows):
            self.rows = np.concatenate([self.rows, np.empty_like(self.rows)])
            self.colors = np.concatenate([self.colors, np.empty_like(self.colors)])
        self.rows[self.count] = x, y
        self.colors[self.count] = color
        self.count += 1

    def so_far(self) -> tuple[Floats, Floats, NDArray[np.uint8]]:
        """x, y and colour numbers."""
        count = self.count
        return self.rows[:count, 0], self.rows[:count, 1], self.colors[:count]


@dataclass(frozen=True, slots=True, eq=False)
class ShownArray:
    """A picture made by SHOW: values of `name` as rows of `columns` elements, largest magnitude `scale`.

    `record` and `number` name the run that makes a film of it (`record.pictures`); `values` stands alone.
    `by_size`: each element is a square in its cell, whose area is its magnitude.
    """

    name: str
    columns: int
    scale: float
    values: Floats | None = None
    record: RunRecord | None = None
    number: int = 0
    by_size: bool = False

    def latest(self) -> Floats | None:
        """Return the newest picture, rows × columns, filled up with nan; None before the first."""
        values = self.values if self.record is None else self._newest()
        if values is None:
            return None
        rows = -(-len(values) // self.columns)
        picture = np.full(rows * self.columns, np.nan)
        picture[: len(values)] = values
        return picture.reshape(rows, self.columns)

    def sides(self, values: Floats) -> Floats:
        """Return the side of each element's square, largest 1, with its sign: the area is the magnitude."""
        parts = np.clip(values / (self.scale or 1.0), -1.0, 1.0)
        return np.sign(parts) * np.sqrt(np.abs(parts))

    def _newest(self) -> Floats | None:
        assert self.record is not None
        films = self.record.pictures
        return films[-1][self.number] if films else None


@dataclass(eq=False)
class Graph:
    """One page: frame and caption of its newest run; curves, points and pictures in drawing order."""

    number: int
    frame: Frame
    caption: str = ""
    net: int | None = 7
    white: bool = False
    has_own_colors: bool = False
    """Whether the program says which colours to use; pictures of others are made for paper."""
    thickness: int = 1
    has_keys: bool = True
    curves: list[Curve] = field(default_factory=list)
    points: Points = field(default_factory=Points)
    shown: list[ShownArray] = field(default_factory=list)
    program: str = ""
    """File name of the program that made it."""
    texts: dict[str, str] = field(default_factory=dict)
    """What `title`, `xlabel`, `ylabel` say."""
    fit: Fit = "no"
    erased: int = 0
    """Goes up when something drawn before must go: what a painter has kept is void."""

    def title(self, *, fitted: bool = False, room: int | None = None) -> str:
        """Return the line above the graph: program, run, scale; of a long program's name what has room."""
        name = self.heading or self.program
        parts = [
            "" if self.heading else self.run_name,
            "fitted" if fitted else f"scale = {self.frame.scale:g}",
        ]
        rest = " · ".join(filter(None, parts))
        if not name:
            return rest
        spare = len(name) if room is None else room - len(rest) - len(" · ")
        if spare >= len(name):
            return f"{name} · {rest}"
        return f"{name[: spare - 1]}… · {rest}" if spare > _NAME_LEAST else rest

    @property
    def heading(self) -> str:
        """What the program calls its graph by `title`."""
        return self.texts.get("title", "")

    @property
    def axis_names(self) -> tuple[str, str] | None:
        """Names of abscissa and ordinate; None for pairs (DISPXY) and others that have none."""
        y, _, x = self.caption.partition(" vs. ")
        if " vs. " in x:
            y = x = ""
        x, y = self.texts.get("xlabel") or x, self.texts.get("ylabel") or y
        return (x, y) if x and y else None

    @property
    def label(self) -> str:
        """The line below the graph: `x, y vs. t`, with the program's names of the axes."""
        names = self.axis_names
        return self.caption if names is None else f"{names[1]} vs. {names[0]}"

    @property
    def run_name(self) -> str:
        """Which runs are on it: `run 3`, `runs 1–5`; nothing for curves made without a run."""
        numbers = [curve.record.number for curve in self.curves if curve.record.number]
        if not numbers:
            return ""
        first, last = min(numbers), max(numbers)
        return f"run {last}" if first == last else f"runs {first}–{last}"

    @property
    def keys(self) -> tuple[Key, ...]:
        """Colour keys, each name and colour once; none in graphs of one colour."""
        return color_keys(self.curves) if self.has_keys else ()

    @property
    def has_few_points(self) -> bool:
        """Whether points that no lines join are so few that single dots would be overlooked."""
        return self.points.count + sum(c.count for c in self.curves if not c.joined) <= FEW_POINTS

    @property
    def is_empty(self) -> bool:
        """Whether nothing has been put on it."""
        return not (self.curves or self.points.count or self.shown)
