"""Lines between panes: moved by keys and the mouse, kept for the next session; where lines of text are cut."""

from __future__ import annotations

import json

import pytest

from desire_tui.common import paths

from .conftest import OSCILLATOR, Desktop, desktop


def sizes(desk: Desktop) -> dict[str, tuple[int, int]]:
    screen = desk.app.main_screen
    return {
        name: (region.width, region.height)
        for name in screen.shown
        if (region := screen.query_one(f"#{name}").region)
    }


def fills_the_screen(desk: Desktop) -> None:
    width, height = desk.app.size
    assert sum(w * h for w, h in sizes(desk).values()) == width * (height - 1)


async def test_keys_move_the_lines_and_the_next_session_has_them(program):
    path = program(OSCILLATOR)
    async with desktop(path, size=(100, 30)) as desk:
        before = sizes(desk)
        await desk.press("alt+e", "alt+full_stop", "alt+full_stop", "alt+apostrophe")
        moved = sizes(desk)
        assert moved["editor"] == (before["editor"][0] + 4, before["editor"][1] + 1)
        assert moved["command"] == (before["command"][0] + 4, before["command"][1] - 1)
        assert moved["graph"][0] == before["graph"][0] - 4
        fills_the_screen(desk)
        await desk.press("f7", "f7")  # the graph alone, and back
        assert sizes(desk) == moved
        await desk.press("alt+q", "alt+apostrophe")  # the side pane grows, the graph shrinks
        fills_the_screen(desk)
        kept = sizes(desk)
    async with desktop(path, size=(100, 30)) as desk:
        assert sizes(desk) == moved
        await desk.press("alt+q")
        assert sizes(desk) == kept
        for _ in range(60):
            await desk.press("alt+comma")
        assert min(w for w, _ in sizes(desk).values()) >= 16
        fills_the_screen(desk)
        await desk.do("view.even")
        await desk.press("alt+h")
        assert sizes(desk) == before
        assert json.loads((paths.state_folder() / "look.json").read_text())["splits"] == {}


@pytest.mark.parametrize("size", [(100, 30), (80, 24)])
async def test_the_mouse_drags_the_lines_and_nothing_else(program, size):
    async with desktop(program(OSCILLATOR), size=size) as desk:
        screen = desk.app.main_screen
        focused = desk.app.focused
        before = sizes(desk)
        x = screen.query_one("#graph").region.x
        await desk.pilot.mouse_down(offset=(x, 9))
        await desk.pilot.hover(offset=(x - 7, 10))
        await desk.pilot.mouse_up(offset=(x - 7, 10))
        assert sizes(desk)["graph"][0] == before["graph"][0] + 7
        y = screen.query_one("#command").region.y
        await desk.pilot.mouse_down(offset=(20, y))
        await desk.pilot.hover(offset=(20, y + 2))
        await desk.pilot.mouse_up(offset=(20, y + 2))
        assert sizes(desk)["command"][1] == before["command"][1] - 2
        await desk.pilot.hover(offset=(20, y - 3))  # let go
        assert sizes(desk)["command"][1] == before["command"][1] - 2
        fills_the_screen(desk)
        assert desk.app.focused is focused
        await desk.press("alt+q")
        tabs = screen.query_one("SideTabs").region
        await desk.pilot.click(offset=(tabs.x + 18, tabs.y))  # a tab in the line is no line
        assert screen.side == "problems"
        high = sizes(desk)["side"][1]
        await desk.pilot.mouse_down(offset=(tabs.right - 4, tabs.y))
        await desk.pilot.hover(offset=(tabs.right - 4, tabs.y - 3))
        await desk.pilot.mouse_up(offset=(tabs.right - 4, tabs.y - 3))
        assert sizes(desk)["side"][1] == high + 3
        assert screen.side == "problems"


async def test_lines_show_where_they_are_cut(program):
    text = "-- " + "long " * 30 + "\nx = 1\n"
    async with desktop(program(text), size=(80, 24)) as desk:
        area = desk.app.editor.front

        def row(y: int) -> str:
            return area.render_line(y).text

        assert row(0).endswith("›")
        assert "›" not in row(1)
        await desk.press("alt+e", "end")
        assert row(0)[area.gutter_width] == "‹"
        assert "›" not in row(0)
        assert row(1)[area.gutter_width] == "‹"
        assert "‹" not in row(2)
        await desk.press("left", "left", "left")
        assert row(0)[area.gutter_width] == "‹"
