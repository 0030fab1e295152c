"""Edits, undo and redo against texts longer and shorter than the pane (`tests/fuzz/editor.py`)."""

from __future__ import annotations

import pytest
from textual import events
from textual.widgets.text_area import Selection

from tests.fuzz.editor import run

from .conftest import desktop


@pytest.mark.parametrize("first", [0, 100, 221, 312])
async def test_sequences_of_edits(first: int):
    assert await run(range(first, first + 4)) == 4


async def test_going_to_the_last_row_of_a_text_just_opened_shows_no_rows_behind_it():
    assert await run(range(343012674, 343012675)) == 1


@pytest.mark.parametrize("rows", [1, 3, 30])
async def test_a_paste_taller_than_the_pane_is_undone(rows: int):
    async with desktop(size=(100, rows + 20)) as desk:
        await desk.press("ctrl+n")
        area = desk.app.editor.front
        text = "\n".join(f"x{number} = {number}" for number in range(300))
        await area._on_paste(events.Paste(text))
        await desk.pilot.pause()
        await desk.press("ctrl+z")
        assert area.text == ""
        await desk.press("ctrl+y")
        assert area.text == text
        top = area.scroll_offset.y
        assert top <= area.cursor_location[0] < top + area.size.height


async def test_rewriting_rows_as_they_are_keeps_what_can_be_done_again(program):
    async with desktop(program("x = 1\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        await desk.press("a", "ctrl+z")
        area.shift_lines(-1)  # nothing to take away
        await desk.press("ctrl+y")
        assert area.text == "ax = 1\n"


async def test_return_in_place_of_several_lines_is_indented_as_the_first(program):
    async with desktop(program("x = 1\n    y = 2\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        area.selection = Selection((0, 3), (1, 8))
        await desk.press("enter")
        assert area.text == "x =\n2\n"
