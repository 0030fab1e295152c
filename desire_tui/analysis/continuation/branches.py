"""What continuation finds: branches of steady states and of cycles, and the points where they change."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from desire_tui.analysis.continuation.curve import Point
    from desire_tui.analysis.continuation.walk import End

Kind = Literal["steady", "cycle", "fold", "Hopf", "fold of cycles", "period doubling"]


@dataclass
class Special:
    """A point where a branch changes: fold, branch point, Hopf, period doubling …; `details` in words.

    `point.facts` is a `Cycle` where it is one of a branch of cycles.
    """

    kind: str
    number: int
    branch: int
    point: Point
    details: str = ""
    values: dict[str, float] = field(default_factory=dict)


@dataclass
class Branch:
    """A curve, point by point, with the reasons why it ends on its two sides."""

    number: int
    kind: Kind
    origin: str
    points: list[Point] = field(default_factory=list)
    ends: tuple[End, End] = ("", "")


@dataclass
class Diagram:
    """All that is found."""

    branches: list[Branch] = field(default_factory=list)
    specials: list[Special] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    is_partial: bool = False

    def special(self, kind: str, branch: int, point: Point) -> Special:
        """Add a special point, numbered among those of its kind from 1."""
        number = 1 + max((other.number for other in self.specials if other.kind == kind), default=0)
        found = Special(kind, number, branch, point)
        self.specials.append(found)
        return found
