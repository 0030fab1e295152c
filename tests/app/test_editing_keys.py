"""Actions of the editor that are in the command table: suggestions, lines, cut, copy, paste."""

from __future__ import annotations

from textual.widgets import Input

from desire_tui.editor.find_bar import FindBar
from desire_tui.editor.status_row import StatusRow
from desire_tui.engine.session.status import State

from .conftest import LONG, OSCILLATOR, desktop


async def test_the_suggestion_is_shown_and_taken_by_one_key(program):
    async with desktop(program(OSCILLATOR.replace("write 'x = '", "wirte 'x = '")), size=(160, 40)) as desk:
        area = desk.app.editor.front
        await desk.until(lambda: area.marks.problems)
        await desk.press("f8")
        await desk.pilot.pause()
        assert "Alt+U: wirte → write" in str(
            desk.app.editor.query_one(StatusRow).query_one("#problem").content
        )
        await desk.press("alt+u")
        assert area.text == OSCILLATOR
        await desk.press("ctrl+z")
        assert "wirte" in area.text


async def test_each_suggestion_of_a_row_is_taken_where_the_cursor_is(program):
    text = OSCILLATOR.replace("dispt x, v", "dispt xspeed, yspeed").replace(
        "d/dt v = -x", "xspeedy = v | yspeedy = x"
    )
    async with desktop(program(text)) as desk:
        area = desk.app.editor.front
        await desk.until(lambda: len(area.marks.problems.get(9, ())) == 2)
        second = area.marks.problems[9][1]
        await desk.press("alt+e")
        area.go_to(9, second.start + 2)
        await desk.press("alt+u")
        assert area.document.get_line(9) == "dispt xspeed, yspeedy"
        await desk.until(lambda: len(area.marks.problems.get(9, ())) == 1)
        area.go_to(9, 0)
        await desk.press("alt+u", "alt+u")  # a second time: nothing more to mend
        assert area.document.get_line(9) == "dispt xspeedy, yspeedy"


async def test_undo_works_while_the_replace_bar_has_the_focus(program):
    async with desktop(program("alpha = 1\nbeta = alpha\n")) as desk:
        area = desk.app.editor.front
        await desk.press("alt+e", "ctrl+r", *"alpha", "tab", *"q", "alt+a")
        assert area.text == "q = 1\nbeta = q\n"
        assert isinstance(desk.app.focused, Input)
        await desk.press("ctrl+z")
        assert area.text == "alpha = 1\nbeta = alpha\n"
        await desk.press("ctrl+y")
        assert area.text == "q = 1\nbeta = q\n"
        assert desk.app.query_one(FindBar).display


async def test_lines_are_duplicated_moved_and_shifted_from_the_palette_and_by_keys(program):
    async with desktop(program("a = 1\nb = 2\n")) as desk:
        area = desk.app.editor.front
        for command, after in (
            ("duplicate", "a = 1\na = 1\nb = 2\n"), ("indent", "a = 1\n  a = 1\nb = 2\n"),
            ("move_down", "a = 1\nb = 2\n  a = 1\n"), ("move_up", "a = 1\n  a = 1\nb = 2\n"),
            ("dedent", "a = 1\na = 1\nb = 2\n"),
        ):  # fmt: skip
            await desk.do(f"edit.{command}")
            assert area.text == after, command
        await desk.press("alt+e", "ctrl+d", "alt+shift+up")
        assert area.text == "a = 1\na = 1\na = 1\nb = 2\n"


async def test_lines_are_cut_copied_and_pasted(program):
    async with desktop(program("a = 1\nb = 2\n")) as desk:
        area = desk.app.editor.front
        await desk.press("alt+e", "shift+end", "ctrl+insert", "ctrl+end")
        assert desk.app.clipboard == "a = 1"
        await desk.press("ctrl+v")
        assert area.text == "a = 1\nb = 2\na = 1"
        await desk.press("ctrl+home", "shift+down", "ctrl+x")
        assert area.text == "b = 2\na = 1"
        assert desk.app.clipboard == "a = 1\n"


async def test_the_keys_of_the_editor_leave_fields_and_other_panes_alone(program):
    async with desktop(program("a = 1\n")) as desk:
        area, prompt = desk.app.editor.front, desk.app.command.prompt
        await desk.press("ctrl+l", *"abc", "home", "ctrl+d", "shift+end", "ctrl+x")
        assert prompt.value == ""
        assert desk.app.clipboard == "bc"
        await desk.press("ctrl+v")
        assert prompt.value == "bc"
        assert area.text == "a = 1\n"


async def test_selected_text_is_copied_during_a_run_and_the_run_goes_on(program):
    async with desktop(program(LONG)) as desk:
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.status.state is State.RUNNING)
        await desk.press("alt+e", "ctrl+home", "shift+end", "ctrl+c")
        assert desk.app.clipboard == LONG.splitlines()[0]
        assert desk.app.session.status.state is State.RUNNING
        await desk.press("ctrl+c")
        await desk.until(lambda: desk.app.session.status.state is State.PAUSED)


async def test_a_problem_is_shown_whole_at_the_cursor_and_the_cursor_stays_in_sight(program):
    text = "-- a line\n" * 30 + OSCILLATOR.replace("dispt x, v", "dispt xspeed, v")
    async with desktop(program(text), size=(80, 24)) as desk:
        area, row = desk.app.editor.front, desk.app.editor.query_one(StatusRow)
        await desk.until(lambda: area.marks.problems)
        await desk.press("f8")
        await desk.until(lambda: row.size.height > 1)
        label = row.query_one("#problem")
        lines = [label.render_line(y).text.strip() for y in range(label.size.height)]
        mark = area.marks.all_problems()[0]
        assert " ".join(lines).split() == mark.text.split()
        await desk.until(
            lambda: area.scroll_offset.y <= area.cursor_location[0] < area.scroll_offset.y + area.size.height
        )
        await desk.press("up")
        await desk.until(lambda: row.size.height == 1)


async def test_a_problem_of_five_rows_is_shown_whole_where_half_of_the_editor_is_left(program):
    text = OSCILLATOR.replace("d/dt v = -x", "d/dt v = -x*sqrt(0.5 - x)/3")
    async with desktop(program(text), size=(100, 30)) as desk:
        area, label = desk.app.editor.front, desk.app.editor.query_one(StatusRow).query_one("#problem")

        def shown() -> list[str]:
            lines = [label.render_line(y).text.strip() for y in range(label.size.height)]
            return " ".join(lines).split() if len(lines) == 5 else []

        await desk.press("f5")
        await desk.until(lambda: [shown()] == [mark.text.split() for mark in area.marks.all_problems()[:1]])


async def test_a_problem_keeps_its_room_while_its_line_is_typed(program):
    """Else the text above would move with every key: the problem goes, and comes back when the line is checked."""
    async with desktop(program(OSCILLATOR + "-- end\n" * 30), size=(80, 24)) as desk:
        area, row = desk.app.editor.front, desk.app.editor.query_one(StatusRow)
        await desk.press("alt+e")
        area.go_to(9, 0)
        await desk.press(*"d/dt zz = some", "underscore", *"name")
        await desk.until(lambda: row.rows > 1)
        heights = set()
        for key in "abcd":
            await desk.press(key)
            heights.add(row.rows)
            await desk.until(lambda: area.marks.problems)
            heights.add(row.rows)
        assert 1 not in heights
        await desk.press("home", *"-- ")
        await desk.until(lambda: row.rows == 1)


async def test_a_terminal_that_becomes_lower_keeps_the_cursor_in_sight(program):
    async with desktop(program("-- a line\n" * 80), size=(100, 40)) as desk:
        area = desk.app.editor.front
        area.move_cursor((area.size.height - 1, 0))
        await desk.pilot.resize_terminal(100, 24)
        await desk.until(
            lambda: area.scroll_offset.y <= area.cursor_location[0] < area.scroll_offset.y + area.size.height
        )
        area.scroll_to(y=60, animate=False)  # who looks elsewhere is left there
        rows = area.size.height
        await desk.pilot.resize_terminal(100, 20)
        await desk.until(lambda: area.size.height < rows)
        assert area.scroll_offset.y == 60
