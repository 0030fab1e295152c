"""The sixteen VGA colours [B A.1.3] and how they show on a black and on a white background."""

from __future__ import annotations

from itertools import pairwise

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
RAMP_STEPS, HUE_STEPS = 32, 16
RAMP = 16
"""Numbers from here on: the ramp of runs that share a graph with one curve each."""
HUES = RAMP + RAMP_STEPS
"""Numbers from here on: for each bright colour a ramp of its hue."""
_FIRST_BRIGHT = 9
GHOST = HUES + HUE_STEPS * (WHITE - _FIRST_BRIGHT + 1)
"""A curve of before, in the background."""
PICKED = GHOST + 1
"""The curve picked out of many."""
_RAMP_ON_BLACK: tuple[Rgb, ...] = (
    (90, 120, 255), (0, 190, 225), (60, 215, 110), (235, 220, 60), (255, 125, 60),
)  # fmt: skip
_RAMP_ON_WHITE: tuple[Rgb, ...] = ((68, 1, 84), (59, 82, 160), (0, 125, 135), (30, 140, 60), (200, 90, 0))
_DARK_HUES = (9, 12, 13)
"""Blue, red and magenta: dimmed, they would be lost on black, so that their ramps go on to lighter shades."""
_PALE_INK: Rgb = (135, 135, 135)


def curve_rgb(color: int, *, white: bool = False) -> Rgb:
    """Return what a curve of colour `color` is drawn in; a white one on a `white` background in ink."""
    if color >= RAMP:
        return _special(color, white=white)
    return INK if white and color % 16 == WHITE else rgb(color, white=white)


def rgb(color: int, *, white: bool = False) -> Rgb:
    """Return red, green, blue (0 … 255) of colour `color` (modulo 16) on a black or `white` background."""
    number = color % 16
    return _ON_WHITE.get(number, VGA[number]) if white else VGA[number]


def ramp_color(part: float, hue: int | None = None) -> int:
    """Return the colour number at `part` (0 … 1) of the ramp, or of that of a bright colour's hue."""
    if hue is None:
        return RAMP + round(part * (RAMP_STEPS - 1))
    bright = hue if hue >= _FIRST_BRIGHT else WHITE
    return HUES + (bright - _FIRST_BRIGHT) * HUE_STEPS + round(part * (HUE_STEPS - 1))


def _special(color: int, *, white: bool) -> Rgb:
    if color == GHOST:
        return (165, 165, 165) if white else (95, 95, 95)
    if color == PICKED:
        return (0, 0, 0) if white else (255, 255, 255)
    if color < HUES:
        return _between(_RAMP_ON_WHITE if white else _RAMP_ON_BLACK, (color - RAMP) / (RAMP_STEPS - 1))
    number, step = divmod(color - HUES, HUE_STEPS)
    bright = number + _FIRST_BRIGHT
    full = curve_rgb(bright, white=white)
    if white:
        ends = (_PALE_INK, full) if bright == WHITE else (full, _mixed(full, BLACK, 0.6))
    else:
        ends = (full, _mixed(full, WHITE, 0.7)) if bright in _DARK_HUES else (_mixed(full, BLACK, 0.6), full)
    return _between(ends, step / (HUE_STEPS - 1))


def _mixed(color: Rgb, other: int, part: float) -> Rgb:
    return _between((color, VGA[other]), part)


def _between(anchors: tuple[Rgb, ...], part: float) -> Rgb:
    place = min(part * (len(anchors) - 1), len(anchors) - 1 - 1e-9)
    before, after = list(pairwise(anchors))[int(place)]
    red, green, blue = (round(a + (b - a) * (place % 1)) for a, b in zip(before, after, strict=True))
    return red, green, blue
