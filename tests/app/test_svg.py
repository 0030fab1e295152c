"""Screenshots in docs: the same dots and words, placed so that every viewer shows them alike."""

from __future__ import annotations

import io
import re
from html import unescape
from xml.etree import ElementTree as ET

from rich.console import Console
from rich.text import Text

from .svg import smaller, tidy


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


def test_smaller_pictures_show_the_same():
    text = Text.assemble(
        ("ab", "on #112233"), (" cd", "on #112233"), (" \u28ff", "#abcdef on #223344"), "\nnext"
    )
    svg = tidy(shot(text))
    small = smaller(svg)
    assert len(small) < 0.6 * len(svg)
    ET.fromstring(small)
    rects = [
        re.findall(r'<rect fill="(#112233|#223344)" x="([\d.]+)" y="([\d.]+)" width="([\d.]+)"', s)
        for s in (svg, small)
    ]
    covered = [
        {(fill, y): (min(float(x) for f, x, v, _ in found if (f, v) == (fill, y)),
                     sum(float(w) for f, _, v, w in found if (f, v) == (fill, y))) for fill, _, y, _ in found}
        for found in rects
    ]  # fmt: skip
    assert len(rects[1]) == 2 < len(rects[0])
    assert covered[0].keys() == covered[1].keys()
    for place, (start, width) in covered[0].items():
        assert abs(covered[1][place][0] - start) < 0.11
        assert abs(covered[1][place][1] - width) < 0.11
    for pattern in (r"<text[^>]*>([^<]*)<", r'<path d="([^"]*)"', r'textLength="([\d.]+)"'):
        assert re.findall(pattern, small) == re.findall(pattern, svg)
    assert "url(http" not in small
