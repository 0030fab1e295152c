"""The sixteen VGA colours [B A.1.3] and how they show on a black and on a white background."""

from __future__ import annotations

Rgb = tuple[int, int, int]

BLACK = 0
WHITE = 15

VGA: tuple[Rgb, ...] = (
    (0, 0, 0), (0, 0, 170), (0, 170, 0), (0, 170, 170),
    (170, 0, 0), (170, 0, 170), (170, 85, 0), (170, 170, 170),
    (85, 85, 85), (85, 85, 255), (85, 255, 85), (85, 255, 255),
    (255, 85, 85), (255, 85, 255), (255, 255, 85), (255, 255, 255),
)  # fmt: skip

# Bright colours are made for a black screen; on white each gets a darker shade of the same hue, so that
# yellow, light green and light cyan can be seen [X]. White itself stays white: a net of that colour is meant
# to be gone. A white curve is not: it is drawn in ink.
_ON_WHITE: dict[int, Rgb] = {
    3: (0, 145, 145), 7: (112, 112, 112), 9: (40, 60, 230), 10: (0, 140, 30), 11: (0, 135, 150),
    12: (215, 30, 30), 13: (185, 30, 185), 14: (150, 102, 0),
}  # fmt: skip


INK: Rgb = (32, 32, 32)


def curve_rgb(color: int, *, white: bool = False) -> Rgb:
    """Return what a curve of colour `color` is drawn in; a white one on a `white` background in ink."""
    return INK if white and color % 16 == WHITE else rgb(color, white=white)


def rgb(color: int, *, white: bool = False) -> Rgb:
    """Return red, green, blue (0 … 255) of colour `color` (modulo 16) on a black or `white` background."""
    number = color % 16
    return _ON_WHITE.get(number, VGA[number]) if white else VGA[number]
