"""What a program must show, at its end, is folded on the screen, and only there."""

from __future__ import annotations

from desire_tui.editor.folding import fold_row

from .conftest import Desktop, desktop

PROGRAM = "x = 7\nwrite x\n\n-- What it must show (tests check it):\n--? x = 7\n--| 7\n"


def seen(desk: Desktop) -> list[str]:
    area = desk.app.editor.front
    lines = [area.render_line(y).text.strip() for y in range(min(area.size.height, 12))]
    return [line for line in lines if line]


async def test_expectations_are_one_line_until_they_are_opened(program, tmp_path):
    async with desktop(program(PROGRAM)) as desk:
        area = desk.app.editor.front
        assert seen(desk)[-1] == "4  -- What it must show (3 lines folded, Alt+Z)"
        assert area.virtual_size.height == 4
        await desk.press("alt+z")
        assert seen(desk)[-2:] == ["6  --| 7", "7"]
        await desk.press("alt+z")
        assert len(seen(desk)) == 4
        await desk.press("alt+e", "ctrl+home", *"y=1", "enter", "ctrl+s")
        await desk.until(lambda: not area.is_dirty)
        assert (tmp_path / "osc.src").read_text() == "y=1\n" + PROGRAM
        assert seen(desk)[-1].startswith("5  -- What it must show")


async def test_keys_stay_before_the_fold_and_places_inside_open_it(program):
    async with desktop(program(PROGRAM)) as desk:
        area = desk.app.editor.front
        await desk.press("alt+e", "ctrl+end")
        assert area.cursor_location == (3, len(PROGRAM.splitlines()[3]))
        await desk.press("down", "right", "pagedown")
        assert area.cursor_location[0] == 3
        assert area.fold == 3
        area.go_to(4)
        await desk.pilot.pause()
        assert area.fold is None
        assert area.cursor_location == (4, 0)


async def test_typing_at_the_fold_opens_it_and_undo_keeps_the_text(program):
    async with desktop(program(PROGRAM)) as desk:
        area = desk.app.editor.front
        await desk.press("alt+e", "ctrl+end", "enter", "z")
        assert area.fold is None
        assert area.text.splitlines()[4:6] == ["z", "--? x = 7"]
        await desk.press("ctrl+z", "ctrl+z", "ctrl+z")
        assert area.text == PROGRAM


async def test_all_is_selected_with_what_is_folded(program):
    async with desktop(program(PROGRAM)) as desk:
        await desk.press("alt+e", "ctrl+a")
        assert desk.app.editor.front.selected_text == PROGRAM


async def test_both_views_follow_a_change_above_the_fold(program):
    async with desktop(program(PROGRAM), size=(120, 30)) as desk:
        await desk.do("file.twice")
        await desk.press("alt+e", "ctrl+home", "enter", "enter")
        assert [view.fold for view in desk.app.editor.front.views] == [5, None]
        await desk.press("ctrl+z", "ctrl+z")
        assert desk.app.editor.front.text == PROGRAM


def test_only_expectations_at_the_end_are_folded():
    assert fold_row(PROGRAM.splitlines()) == 3
    assert fold_row(["x = 1", "--? x = 1"]) == 1
    assert fold_row(["--? x = 1", "x = 1"]) is None
    assert fold_row(["-- What it must show", ""]) is None
