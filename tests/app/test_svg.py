"""Screenshots in docs: the same dots and words, placed so that every viewer shows them alike."""

from __future__ import annotations

import io
import re
from html import unescape
from xml.etree import ElementTree as ET

from rich.console import Console
from rich.text import Text

from .svg import tidy


def shot(text: Text) -> str:
    console = Console(record=True, width=40, file=io.StringIO(), force_terminal=True)
    console.print(text)
    return console.export_svg(title="t")


def words(svg: str) -> list[str]:
    return [
        unescape(found).replace("\xa0", " ") for found in re.findall(r"<text[^>]*clip[^>]*>([^<]*)<", svg)
    ]


def test_braille_becomes_its_dots_in_its_colour():
    svg = tidy(shot(Text("a \u2801\u28ff b", style="#123456")))
    (path,) = re.findall(r'<path d="([^"]*)" stroke="#123456"', svg)
    dots = [tuple(map(float, dot)) for dot in re.findall(r"M([\d.]+) ([\d.]+)h0", path)]
    assert len(dots) == 1 + 8
    assert not re.search("[\u2801-\u28ff]", svg)
    (alone, *block) = dots
    assert (
        min(x for x, _ in block) - alone[0] == 12.2 or abs(min(x for x, _ in block) - alone[0] - 12.2) < 0.11
    )
    assert alone[1] == min(y for _, y in block)
    assert len({x for x, _ in block}) == 2
    assert len({y for _, y in block}) == 4


def test_blanks_around_words_become_their_place():
    svg = tidy(shot(Text.assemble(("   left", "red"), ("  <mid>  ", "green"), ("  \n", "blue"))))
    assert [word for word in words(svg) if word.strip()] == ["left", "<mid>"]
    left, mid = (float(x) for x in re.findall(r'<text class="[^"]+" x="([\d.]+)"[^>]*clip', svg))
    assert abs(left - 3 * 12.2) < 0.1
    assert abs(mid - 9 * 12.2) < 0.1
    assert all(word == word.strip() for word in words(svg))


def test_it_stays_well_formed():
    ET.fromstring(tidy(shot(Text("x < 1 & y > 2  \u28c0"))))
