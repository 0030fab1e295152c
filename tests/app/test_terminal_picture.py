"""The moving picture is drawn from what a terminal shows (`make recording`)."""

from __future__ import annotations

import pyte
from PIL import Image

from .terminal_picture import GROUND, HEIGHT, MARGIN, WIDTH, Frame, save_animation


def frame_of(text):
    screen = pyte.Screen(8, 2)
    pyte.Stream(screen).feed(text)
    return Frame.of(screen)


def cell(picture, column, row=0):
    left, top = MARGIN + column * WIDTH, MARGIN + row * HEIGHT
    return picture.crop((left, top, left + WIDTH, top + HEIGHT))


def test_letters_braille_and_blocks_are_drawn_in_their_colours():
    picture = frame_of("\x1b[38;2;255;0;0m⠁█A\x1b[48;2;0;0;255m \x1b[0m ").picture()
    red, ground = (255, 0, 0), tuple(bytes.fromhex(GROUND[1:]))
    dot, block, letter, blue, empty = (cell(picture, column) for column in range(5))
    assert dot.getpixel((2, 3)) == red
    assert dot.getpixel((6, 12)) == ground
    assert set(block.get_flattened_data() if hasattr(block, "get_flattened_data") else block.getdata()) == {
        red
    }
    assert letter.getextrema()[0][1] > 200
    assert blue.getpixel((4, 9)) == (0, 0, 255)
    assert empty.getextrema() == tuple((part, part) for part in ground)


def test_an_animation_keeps_frames_and_times(tmp_path):
    path = tmp_path / "a.gif"
    save_animation([(0.0, frame_of("a")), (0.5, frame_of("ab")), (0.7, frame_of("abc"))], path, hold=2.0)
    durations = []
    with Image.open(path) as moving:
        for number in range(moving.n_frames):
            moving.seek(number)
            durations.append(moving.info["duration"])
    assert durations == [500, 200, 2000]
