"""How a graph becomes a picture: size, resolution, style."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    PictureStyle = Literal["paper", "screen"]


class PictureOptions:
    """How a picture is made: width and height in inches, dots per inch, style.

    Style `paper` is dark on white, `screen` in the program's colours; None: for paper unless the program says
    which colours to use.
    """

    def __init__(
        self,
        inches: tuple[float, float] = (8.0, 5.0),
        dots_per_inch: float = 150,
        style: PictureStyle | None = None,
    ) -> None:
        self.inches, self.dots_per_inch, self.style = inches, dots_per_inch, style


FOR_PAPER = PictureOptions()
