"""Pictures in the terminal: by kitty's protocol, by sixel, in half blocks; with and without the library."""

from __future__ import annotations

import base64
import io
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from desire_tui.panes import picture_view
from desire_tui.panes.picture_view import Blocks, PictureScreen
from desire_tui.panes.terminal_graphics import Graphics, _meaning

from .conftest import desktop
from .test_terminal import F5, Terminal

RAMP = """\
TMAX = 1 | DT = 0.01 | NN = 101
scale = 1
display N12 | display R
drun
DYNAMIC
d/dt x = 1
dispt x
"""
"""One red curve from the middle of the left side to the upper right corner."""
KITTY, SIXEL, CELL = "\x1b_Gi=31;OK\x1b\\", "\x1b[?62;4;22c", "\x1b[6;20;10t"
PLAIN = "\x1b[?62;22c"


class Answering(Terminal):
    """A terminal that answers what it is asked."""

    answer = ""

    def read(self, seconds: float = 0.05) -> None:
        before = len(self.raw)
        super().read(seconds)
        if b"\x1b[c" in self.raw[max(before - 3, 0) :]:
            self.send(self.answer)


@pytest.fixture
def terminal(tmp_path):
    opened = []
    (tmp_path / "ramp.src").write_text(RAMP)

    def start(answer: str) -> Answering:
        one = Answering(tmp_path, "ramp.src")
        opened.append(one)
        one.answer = answer
        one.until(lambda: "ramp.src" in one.text and "F5" in one.text)
        one.send(F5)
        one.until(lambda: one.dots > 20)
        return one

    yield start
    for one in opened:
        one.child.close(force=True)


def is_reddish(dots: np.ndarray) -> np.ndarray:
    red, green, blue = (dots[..., channel].astype(int) for channel in range(3))
    return (red > 180) & (red > green + 90) & (red > blue + 90)


def is_the_ramp(dots: np.ndarray) -> bool:
    """Whether red dots lie on one rising line that ends higher than the middle."""
    rows, columns = np.nonzero(is_reddish(dots))
    line = rows < 0.85 * len(dots)  # the colour key below is red, too
    rows, columns = rows[line], columns[line]
    slope, start = np.polyfit(columns, rows, 1)
    off = np.abs(rows - (slope * columns + start))
    return slope < 0 and np.quantile(off, 0.95) < 0.03 * len(dots) and np.ptp(columns) > 0.7 * dots.shape[1]


def sixel_dots(data: str) -> np.ndarray:
    """Draw sixels (DEC STD 070, chapter 9)."""
    size = re.match(r'"\d+;\d+;(\d+);(\d+)', data)
    image = np.zeros((int(size[2]) + 6, int(size[1]) + 1, 3), dtype=np.uint8)
    palette, color, x, y = {}, 0, 0, 0
    for register, times, character, step in re.findall(
        r"#([\d;]+)|!(\d+)([?-~])|([?-~$-])", data[size.end() :]
    ):
        if register:
            number, *rest = map(int, register.split(";"))
            color = number
            if rest:
                assert rest[0] == 2
                palette[number] = [round(2.55 * part) for part in rest[1:]]
        elif step == "$":
            x = 0
        elif step == "-":
            x, y = 0, y + 6
        else:
            bits = ord(character or step) - 63
            count = int(times or 1)
            for bit in range(6):
                if bits >> bit & 1:
                    image[y + bit, x : x + count] = palette[color]
            x += count
    return image[: int(size[2]), : int(size[1])]


def test_a_kitty_terminal_gets_the_png(terminal):
    screen = terminal(KITTY + CELL + PLAIN)
    screen.send("\x1bi")
    screen.until(lambda: re.search(rb"U=1,q=2", screen.raw))
    sent = b"".join(re.findall(rb"\x1b_Gi=\d+,m=[01],f=100,q=2;([^\x1b]+)", screen.raw))
    sent = sent or b"".join(re.findall(rb"\x1b_G[^;]*f=100[^;]*;([^\x1b]+)", screen.raw))
    with Image.open(io.BytesIO(base64.b64decode(sent))) as image:
        assert image.size == (100 * 10, 29 * 20)
        assert is_the_ramp(np.asarray(image.convert("RGB")))
    # the keys work again after the question, and the picture goes
    screen.send("\x1b")
    screen.until(lambda: "─ Command ─" in screen.text)
    screen.send("write 'still', 2*21\r")
    screen.until(lambda: "42" in screen.text)


def test_a_sixel_terminal_gets_sixels(terminal):
    screen = terminal(CELL + SIXEL)
    screen.send("\x1bi")
    screen.until(lambda: re.search(rb"\x1bP[\d;]*q[^\x1b]+\x1b\\", screen.raw))
    data = re.search(rb"\x1bP[\d;]*q([^\x1b]+)\x1b\\", screen.raw)[1].decode()
    dots = sixel_dots(data)
    assert dots.shape == (29 * 20, 100 * 10, 3)
    assert is_the_ramp(dots)


def test_a_plain_terminal_gets_blocks_and_is_told_so(terminal):
    screen = terminal(PLAIN)
    screen.send("\x1bi")
    screen.until(lambda: "This terminal shows no pictures" in screen.text)
    assert b"\x1b_Gi=31" in screen.raw
    assert screen.text.count("▀") == 29 * 100
    screen.send("q")
    screen.until(lambda: "─ Command ─" in screen.text)


@pytest.mark.parametrize(
    ("answer", "expected"),
    [
        (KITTY + CELL + PLAIN, Graphics("kitty", (10, 20))),
        ("\x1b[<35;3;4M" + CELL + "q" + SIXEL, Graphics("sixel", (10, 20))),  # mouse and keys in between
        (KITTY + SIXEL, Graphics("sixel", (10, 20))),
        (PLAIN, Graphics("none", (10, 20))),
        ("\x1b[?64c", Graphics("none", (10, 20))),
        ("", Graphics("none", (10, 20))),
        ("\x1b[6;0;0t" + PLAIN, Graphics("none", (10, 20))),
        ("\x1b[6;36;18t" + SIXEL, Graphics("sixel", (18, 36))),
    ],
)
def test_what_answers_mean(answer, expected, monkeypatch):
    monkeypatch.setattr("desire_tui.panes.terminal_graphics._pixels_of_window", lambda: None)
    assert _meaning(answer.encode()) == expected


async def shown(desk) -> PictureScreen:
    await desk.press("f5")
    await desk.idle()
    await desk.do("graph.picture")
    await desk.until(lambda: isinstance(desk.app.screen, PictureScreen))
    return desk.app.screen


def keys_row(screen) -> str:
    return str(screen.query_one("#picture-keys").render())


async def test_without_the_library_a_capable_terminal_is_told_how_to_get_it(program, monkeypatch):
    monkeypatch.setattr(picture_view, "find_spec", lambda _: None)
    monkeypatch.setattr(PictureScreen, "known", Graphics("kitty", (10, 20)))
    async with desktop(program(RAMP)) as desk:
        screen = await shown(desk)
        await desk.until(lambda: screen.query(Blocks))
        await desk.until(lambda: "pip install 'desire-tui[pictures]'" in keys_row(screen))
        blocks = screen.query_one(Blocks)
        assert is_the_ramp(np.array(blocks.dots))
        strip = blocks.render_line(0)
        assert strip.cell_length == 100
        await desk.press("escape")
        await desk.until(lambda: desk.app.screen is desk.app.main_screen)


async def test_without_a_graph_there_is_nothing_to_show(program):
    async with desktop(program(RAMP)) as desk:
        await desk.do("graph.picture")
        await desk.pilot.pause()
        assert desk.app.screen is desk.app.main_screen


async def test_the_picture_follows_size_and_page_and_can_be_saved(program, monkeypatch, tmp_path):
    monkeypatch.setattr(PictureScreen, "known", Graphics())
    async with desktop(program(RAMP)) as desk:
        await desk.press("f5")
        await desk.idle()
        screen = await shown(desk)
        await desk.until(lambda: screen.query(Blocks))
        await desk.pilot.resize_terminal(60, 20)
        await desk.until(lambda: screen.query(Blocks) and len(screen.query_one(Blocks).dots) == 2 * 19)
        before = desk.app.graph.page
        await desk.press("pageup")
        await desk.until(lambda: desk.app.graph.page is not before)
        await desk.press("s")
        await desk.until(lambda: type(desk.app.screen).__name__ == "LineDialog")
        await desk.press("enter")
        await desk.until(lambda: list(tmp_path.glob("osc.png")))


def test_the_picture_costs_nothing_before_it_is_wanted():
    import subprocess
    import sys

    code = (
        "import sys, desire_tui.app; "
        "print(sorted(m for m in sys.modules if m.split('.')[0] in ('PIL', 'matplotlib', 'textual_image')))"
    )
    ran = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[2],
    )
    assert ran.stdout.strip() == "[]"
