"""What `display` statements have set: on or off, colours, thickness (book Table 1.1)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.graph.axes import AXIS_WORDS, Axes
from desire_tui.engine.graph.colors import BLACK, WHITE

if TYPE_CHECKING:
    from collections.abc import Sequence

_FIRST_BRIGHT, _LAST_BRIGHT = 9, 15
_LINEAR = Axes()
_ONE_COLOR = (16, 18)  # N 16, 18, -18: all curves alike


@dataclass
class DisplaySettings:
    """The settings in force.

    `mode` 0 off, 1 a new graph for each run, 2 runs share a graph; `thickness` 1 thin, 2 thick, 3 extra
    thick. `first` is the number given to `display N`, `net` the one given to `display C`; `by_size`: pictures
    show size in place of colour (`SHOW *`).
    """

    mode: Literal[0, 1, 2] = 1
    first: int = 14
    net: int = 7
    thickness: Literal[1, 2, 3] = 1
    white: bool = False
    by_size: bool = False
    fit: bool = False
    texts: dict[str, str] = field(default_factory=dict)
    """What `title`, `xlabel`, `ylabel`, `units` say."""
    axes: Axes = _LINEAR
    own_colors: bool = False
    """Whether the program says which colours to use."""

    def apply(self, mode: str, args: Sequence[float]) -> None:
        """Carry out `display 0/1/2`, `Q R Y`, `N n`, `C n`. Other letters set nothing here."""
        self.own_colors = self.own_colors or mode in ("N", "C")
        match mode:
            case "0" | "1" | "2":
                self.mode = int(mode)  # type: ignore[assignment]  # 0, 1 or 2: matched above
            case "Q" | "R" | "Y":
                self.thickness = {"Q": 1, "R": 2, "Y": 3}[mode]  # type: ignore[assignment]  # as above
            case "N" if args:
                self.first = int(args[0])
                self.white = self.first < 0 or (self.white and self.net == 17)
            case "fit":
                self.fit = True
            case word if word in AXIS_WORDS:
                self.axes = self.axes.changed(word)
            case "C" if args:
                self.net = int(args[0])
                self.white = self.white or self.net == 17

    @property
    def one_color(self) -> bool:
        """Whether all curves have the same colour; such graphs have no colour keys [B 1.3.7.1]."""
        return abs(self.first) in _ONE_COLOR

    @property
    def net_color(self) -> int | None:
        """Colour number of the coordinate net, None where it cannot be seen or is switched off."""
        color = BLACK if self.net in (16, 17) else abs(self.net) % 16
        return None if color == (WHITE if self.white else BLACK) else color

    def curve_dash(self, number: int) -> int:
        """Return how often the colours were gone through before curve `number`."""
        return 0 if self.one_color else number // (_LAST_BRIGHT - _FIRST_BRIGHT + 1)

    def curve_color(self, number: int) -> int:
        """Colour number of curve `number` (from 0): n, n + 1, … within 9 … 15, round again."""
        if self.one_color:
            return BLACK if self.white else WHITE
        color = abs(self.first) + number
        if color > _LAST_BRIGHT:
            color = _FIRST_BRIGHT + (color - _FIRST_BRIGHT) % (_LAST_BRIGHT - _FIRST_BRIGHT + 1)
        if self.white and color == WHITE:
            return BLACK  # white on white would be no curve at all [X]
        return color
