"""Makes a screenshot look the same in every viewer: not all know the font, or place text as Rich wants it.

Blanks at the ends of a piece of text become its place; braille characters become the dots they stand for.
"""

from __future__ import annotations

import re
from html import escape, unescape

_TEXT = re.compile(
    r'<text class="(?P<kind>[^"]+)" x="(?P<x>[\d.]+)" y="(?P<y>[\d.]+)" textLength="(?P<length>[\d.]+)"'
    r' clip-path="(?P<clip>[^"]+)">(?P<text>[^<]*)</text>'
)
_COLOUR = re.compile(r"\.([\w-]+) \{ fill: (#\w+)")
_RUN = re.compile(r"[\u2800-\u28ff]+|[^\u2800-\u28ff]+")
_LINE, _ABOVE = 24.4, 18.5  # height of a row, and of its top above the base line, in Rich's screenshots
_DOTS = [
    (0, 0),
    (0, 1),
    (0, 2),
    (1, 0),
    (1, 1),
    (1, 2),
    (0, 3),
    (1, 3),
]  # column, row of each bit (Unicode 15, 21.1)
_DOT_SIZE = 4.2


def tidy(svg: str) -> str:
    """Return the screenshot, font-independent."""
    colours = dict(_COLOUR.findall(svg))

    def place(found: re.Match[str]) -> str:
        text = unescape(found["text"])
        wide = float(found["length"]) / max(len(text), 1)
        pieces, at = [], float(found["x"])
        for run in _RUN.findall(text):
            if "\u2800" <= run[0] <= "\u28ff":
                pieces.append(_dots(run, at, float(found["y"]), wide, colours.get(found["kind"], "#ffffff")))
            else:
                pieces.append(_words(run, at, wide, found))
            at += wide * len(run)
        return "".join(pieces)

    return _TEXT.sub(place, svg)


def _words(run: str, at: float, wide: float, found: re.Match[str]) -> str:
    """Return text without the blanks around it."""
    inside = run.strip("\N{NO-BREAK SPACE} \n")
    if not inside:
        return ""
    x = at + wide * (len(run) - len(run.lstrip("\N{NO-BREAK SPACE} \n")))
    length = f"{wide * len(inside):.1f}"
    words = escape(inside, quote=False).replace("\N{NO-BREAK SPACE}", "&#160;")
    return (
        f'<text class="{found["kind"]}" x="{x:.1f}" y="{found["y"]}" textLength="{length}"'
        f' clip-path="{found["clip"]}">{words}</text>'
    )


def _dots(run: str, at: float, y: float, wide: float, colour: str) -> str:
    """Return braille as one path of round dots."""
    path = [
        f"M{at + wide * (number + 0.25 + 0.5 * column):.1f} {y - _ABOVE + _LINE * (0.125 + 0.25 * row):.1f}h0"
        for number, character in enumerate(run)
        for bit, (column, row) in enumerate(_DOTS)
        if (ord(character) - 0x2800) >> bit & 1
    ]
    style = f'stroke="{colour}" stroke-width="{_DOT_SIZE}" stroke-linecap="round" fill="none"'
    return f'<path d="{"".join(path)}" {style}/>' if path else ""


_CLIPS = re.compile(r'\s*<clipPath id="[^"]*-line-\d+">.*?</clipPath>', re.DOTALL)
_CLIP = re.compile(r' clip-path="url\([^"]*-line-\d+\)"')
_FACE = re.compile(r"\s*@font-face \{.*?\}", re.DOTALL)
_RECT = re.compile(
    r'<rect fill="(?P<fill>[^"]+)" x="(?P<x>[\d.]+)" y="(?P<y>[\d.]+)" width="(?P<width>[\d.]+)"'
    r' height="(?P<height>[\d.]+)" shape-rendering="crispEdges"/>'
)


def smaller(svg: str) -> str:
    """Return a tidy screenshot without what shows nothing: clips of whole rows, fonts of the web, long names.

    Neighbours of one colour become one.
    """
    svg = re.sub(r"terminal-\d+-", "t-", _FACE.sub("", _CLIP.sub("", _CLIPS.sub("", svg))))
    kept: list[str] = []
    last: re.Match[str] | None = None
    start = end = 0.0
    at = 0

    def close() -> None:
        if last is not None:
            wide = f'width="{end - start:.1f}"'
            kept.append(
                f'<rect fill="{last["fill"]}" x="{start:.1f}" y="{last["y"]}" {wide} height="{last["height"]}"'
                ' shape-rendering="crispEdges"/>'
            )

    for found in _RECT.finditer(svg):
        x, width = float(found["x"]), float(found["width"])
        same = last is not None and (last["fill"], last["y"]) == (found["fill"], found["y"])
        between = svg[at : found.start()]
        if not (same and abs(x - end) < 0.2 and not between.strip()):
            close()
            kept.append(between)
            last, start = found, x
        end, at = x + width, found.end()
    close()
    return "".join((*kept, svg[at:]))
