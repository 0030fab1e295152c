"""A terminal's screen as a picture, and many as an animated GIF.

Letters are drawn with the fixed font that matplotlib brings; braille and blocks, which it lacks or which would leave
seams between cells, as dots and rectangles.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from PIL import Image, ImageDraw, ImageFont

if TYPE_CHECKING:
    import pyte

WIDTH, HEIGHT = 9, 18
"""Of a character, in dots."""
FONT_SIZE = 15
MARGIN = 8
INK, GROUND = "#d0d0d0", "#101418"
COLORS = {
    "black": "#000000", "red": "#cd3131", "green": "#0dbc79", "brown": "#e5e510", "blue": "#2472c8",
    "magenta": "#bc3fbc", "cyan": "#11a8cd", "white": "#e5e5e5", "brightblack": "#666666",
}  # fmt: skip
PALETTE_COLORS = 96
_LOWER = "▁▂▃▄▅▆▇█"
_LEFT = "▏▎▍▌▋▊▉█"

Cell = tuple[str, str, str, bool]
"""Character, ink, ground, bold."""


@dataclass(frozen=True)
class Frame:
    """What a screen shows: rows of cells."""

    rows: tuple[tuple[Cell, ...], ...]

    @staticmethod
    def of(screen: pyte.Screen) -> Frame:
        """Return what a screen shows now."""
        rows = []
        for y in range(screen.lines):
            line = screen.buffer[y]
            row = []
            for x in range(screen.columns):
                char = line[x]
                ink, ground = _color(char.fg, INK), _color(char.bg, GROUND)
                row.append((char.data, *((ground, ink) if char.reverse else (ink, ground)), char.bold))
            rows.append(tuple(row))
        return Frame(tuple(rows))

    def picture(self) -> Image.Image:
        """Draw it."""
        size = (2 * MARGIN + WIDTH * len(self.rows[0]), 2 * MARGIN + HEIGHT * len(self.rows))
        image = Image.new("RGB", size, GROUND)
        draw = ImageDraw.Draw(image)
        for y, row in enumerate(self.rows):
            for x, (text, ink, ground, bold) in enumerate(row):
                left, top = MARGIN + x * WIDTH, MARGIN + y * HEIGHT
                if ground != GROUND:
                    draw.rectangle((left, top, left + WIDTH - 1, top + HEIGHT - 1), fill=ground)
                _draw_character(draw, left, top, text, ink, bold=bold)
        return image


def _color(name: str, default: str) -> str:
    if name == "default":
        return default
    return COLORS.get(name) or (f"#{name}" if len(name) == 6 else default)


@cache
def _font(*, bold: bool) -> ImageFont.FreeTypeFont:
    import matplotlib as mpl

    name = f"DejaVuSansMono{'-Bold' if bold else ''}.ttf"
    return ImageFont.truetype(str(Path(mpl.get_data_path()) / "fonts/ttf" / name), FONT_SIZE)


def _draw_character(
    draw: ImageDraw.ImageDraw, left: int, top: int, text: str, ink: str, *, bold: bool
) -> None:
    code = ord(text[0]) if text else 0x20
    if text.isspace() or not text:
        return
    if 0x2800 <= code <= 0x28FF:
        for bit in range(8):
            if code >> bit & 1:
                column, row = (bit // 3, bit % 3) if bit < 6 else (bit - 6, 3)
                x, y = left + 1 + 4 * column, top + 2 + 4 * row
                draw.rectangle((x, y, x + 2, y + 2), fill=ink)
        return
    box = _block(code, text)
    if box is not None:
        x1, y1, x2, y2 = box
        draw.rectangle((left + x1, top + y1, left + x2 - 1, top + y2 - 1), fill=ink)
        return
    draw.text((left, top + HEIGHT - 4), text, fill=ink, font=_font(bold=bold), anchor="ls")


def _block(code: int, text: str) -> tuple[int, int, int, int] | None:
    """Return the rectangle of a block character or of a straight line; None for others."""
    if text in _LOWER:
        return 0, HEIGHT - round(HEIGHT * (_LOWER.index(text) + 1) / 8), WIDTH, HEIGHT
    if text in _LEFT:
        return 0, 0, max(round(WIDTH * (_LEFT.index(text) + 1) / 8), 1), HEIGHT
    middle_x, middle_y = WIDTH // 2, HEIGHT // 2
    rectangles = {
        0x2580: (0, 0, WIDTH, middle_y), 0x2590: (middle_x, 0, WIDTH, HEIGHT), 0x2594: (0, 0, WIDTH, 2),
        0x2595: (WIDTH - 1, 0, WIDTH, HEIGHT), 0x2500: (0, middle_y, WIDTH, middle_y + 1),
        0x2501: (0, middle_y - 1, WIDTH, middle_y + 1), 0x2502: (middle_x, 0, middle_x + 1, HEIGHT),
        0x2503: (middle_x, 0, middle_x + 2, HEIGHT),
    }  # fmt: skip
    return rectangles.get(code)


def save_animation(frames: list[tuple[float, Frame]], path: Path, hold: float) -> None:
    """Write frames, each with its time in seconds, as a GIF that repeats; the last one stays for `hold` seconds."""
    times = [time for time, _ in frames]
    durations = [round(1000 * (after - before)) for before, after in pairwise(times)]
    pictures = [frame.picture() for _, frame in frames]
    palette = pictures[len(pictures) // 2].quantize(PALETTE_COLORS)
    small = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    small[0].save(
        path, save_all=True, append_images=small[1:], duration=[*durations, round(1000 * hold)], loop=0, optimize=True,
    )  # fmt: skip
