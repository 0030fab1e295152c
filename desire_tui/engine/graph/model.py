"""A graph: its frame, and what stands in it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.graph.axes import Axes
from desire_tui.engine.graph.color_keys import color_keys
from desire_tui.engine.graph.measured_curve import without_known
from desire_tui.engine.graph.run_colors import RunColors
from desire_tui.engine.graph.units import units_of, with_units

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from desire_tui.engine.graph.cells import Cells
    from desire_tui.engine.graph.color_keys import Key
    from desire_tui.engine.graph.curve import Curve, Frame
    from desire_tui.engine.graph.study import Study
    from desire_tui.engine.runtime.run_record import RunRecord

    Floats = NDArray[np.float64]

SQUARE_MOST = 0.9
"""Side of the largest square of a picture that shows sizes, in parts of its cell: a gap parts neighbours."""
Fit = Literal["no", "asked", "unset"]
"""Whether a graph is fitted to its curves: `display fit`; `unset`: the program never sets `scale`, and a
curve leaves the scale of 1 that Desire starts with."""
FEW_POINTS = 100
_NAME_LEAST = 4
_LINEAR = Axes()
_GROWTH = 1.02
"""What varies is looked for again when there are so many times as many curves."""


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
        values = self.newest()
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

    def newest(self) -> Floats | None:
        """Return the numbers of the newest picture as they stand; None before the first."""
        if self.record is None:
            return self.values
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
    bands: tuple[tuple[int, int], ...] = ()
    """Pairs of curves between which pictures for paper are filled."""
    cells: Cells | None = None
    """What the sides of its picture stand for, if that is known."""
    program: str = ""
    """File name of the program that made it."""
    texts: dict[str, str] = field(default_factory=dict)
    """What `title`, `xlabel`, `ylabel`, `units` say."""
    fit: Fit = "no"
    has_scale: bool = True
    """Whether its title tells the scale; charts that no run drew have none."""
    axes: Axes = _LINEAR
    erased: int = 0
    """Goes up when something drawn before must go: what a painter has kept is void."""
    run_colors: RunColors = field(default_factory=RunColors)
    _study: tuple[tuple[int, int], Study] | None = field(default=None, init=False)

    def title(self, *, fitted: bool = False, room: int | None = None) -> str:
        """Return the line above the graph: program, run, scale; of a long program's name what has room."""
        name = self.heading or self.program
        runs = "" if self.heading else self.run_name
        scale = ""
        if self.has_scale:
            scale = "fitted" if fitted else f"scale = {self.frame.scale:g}"
        rest = " · ".join(filter(None, (runs, scale)))
        if runs and room is not None and len(rest) > room:
            rest = runs if len(runs) <= room else self.study.run_name
        if not name or not rest:
            return name or rest
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
        units = units_of(self.texts.get("units", ""))
        x, y = (
            self.texts.get("xlabel") or with_units(x, units),
            self.texts.get("ylabel") or with_units(y, units),
        )
        return (x, y) if x and y else None

    @property
    def label(self) -> str:
        """The line below the graph: `x, y vs. t`, with the program's names of the axes."""
        names = self.axis_names
        return self.caption if names is None else f"{names[1]} vs. {names[0]}"

    @property
    def run_name(self) -> str:
        """Which runs are on it, and what varies: `run 3`, `runs 1–5 · c = 0.3 … 1.5`."""
        study = self.study
        return " · ".join(filter(None, (study.run_name, study.span)))

    @property
    def study(self) -> Study:
        """What varies over the runs on it; while many are made, as it was a moment ago."""
        from desire_tui.engine.graph.study import Study

        known, now = self._study, (len(self.curves), self.erased)
        if known is None or not (known[0][1] == now[1] and known[0][0] <= now[0] <= known[0][0] * _GROWTH):
            curves = list(self.curves)
            known = self._study = (
                (len(curves), now[1]),
                Study([curve.record for curve in curves if not curve.measured]),
            )
        return known[1]

    def begin_run(self, curves: Sequence[Curve], ahead: int | None) -> None:
        """Put a run's curves on it, in colours that tell them from those of other runs.

        `ahead`: so many runs follow; None: that is not known.
        """
        colors = self.run_colors
        curves = without_known(curves, self.curves)
        if not self.has_keys or (self.curves and not colors.runs):
            self.curves.extend(curves)  # all of one colour, or the page was begun for something else
            return
        colors.add(curves)
        if colors.widen(ahead):
            self._color_all([*self.curves, *curves])
        else:
            self.curves.extend(colors.colored(curves, colors.runs - 1, own_colors=self.has_own_colors))

    def set_axes(self, axes: Axes) -> None:
        """Lay the values out in another way."""
        self.axes = axes
        self.erased += 1

    def end_runs(self) -> bool:
        """Lay out the colours for the runs there are; returns whether that changed anything."""
        self._study = None
        colors = self.run_colors
        if not colors.widen(0):
            return False
        self._color_all(self.curves)
        return True

    def erase(self) -> None:
        """Take everything off."""
        self.curves, self.shown, self.points = [], [], Points()
        self.run_colors = RunColors()
        self.erased += 1

    def _color_all(self, curves: Sequence[Curve]) -> None:
        self.curves = self.run_colors.colored(curves, 0, own_colors=self.has_own_colors)
        self.erased += 1

    @property
    def keys(self) -> tuple[Key, ...]:
        """Colour keys, each name and colour once; none in graphs of one colour."""
        return color_keys(list(self.curves), self.study) if self.has_keys else ()

    @property
    def point_count(self) -> int:
        """How many points there are that no lines join."""
        return self.points.count + sum(c.count for c in self.curves if not (c.joined or c.measured))

    @property
    def has_few_points(self) -> bool:
        """Whether points that no lines join are so few that single dots would be overlooked."""
        return self.point_count <= FEW_POINTS

    @property
    def is_empty(self) -> bool:
        """Whether nothing has been put on it."""
        return not (self.curves or self.points.count or self.shown)
