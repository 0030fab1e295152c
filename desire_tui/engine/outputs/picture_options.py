"""How a graph becomes a picture: size, resolution, style."""

from __future__ import annotations

import re
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
INCHES_LEAST, INCHES_MOST = 1, 40
DPI_LEAST, DPI_MOST = 10, 1200
_SIZE = re.compile(r"(\d+\.?\d*)[x×](\d+\.?\d*)", re.ASCII)
_DPI = re.compile(r"(\d+)\s*dpi", re.ASCII | re.IGNORECASE)


def inches(text: str) -> tuple[float, float] | None:
    """Return width and height of `6x4`; None for anything else, and for sizes that no picture has."""
    found = _SIZE.fullmatch(text.strip().lower())
    if found is None:
        return None
    width, height = float(found[1]), float(found[2])
    return (width, height) if all(INCHES_LEAST <= side <= INCHES_MOST for side in (width, height)) else None


def name_and_options(text: str) -> tuple[str, PictureOptions]:
    """Read `name.png 6x4 300 dpi screen`: a file's name and what is said of its picture, in any order.

    ValueError: a size or resolution that no picture has.
    """
    options = PictureOptions()
    name = text.strip()
    while True:
        head, _, word = name.rpartition(" ")
        if word.lower() == "dpi":  # `300 dpi`
            head, _, number = head.rpartition(" ")
            word = f"{number}dpi"
        if not head:
            return name.strip("'\""), options
        if word.lower() in ("paper", "screen"):
            options.style = "paper" if word.lower() == "paper" else "screen"
        elif found := _DPI.fullmatch(word):
            options.dots_per_inch = float(found[1])
            if not DPI_LEAST <= options.dots_per_inch <= DPI_MOST:
                raise ValueError(word)
        elif _SIZE.fullmatch(word.lower()):
            size = inches(word)
            if size is None:
                raise ValueError(word)
            options.inches = size
        else:
            return name.strip("'\""), options
        name = head.rstrip()
