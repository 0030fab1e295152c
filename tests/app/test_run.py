"""Running programs from the desktop."""

from __future__ import annotations

import math

from desire_tui.engine.session.status import State

from .conftest import LONG, OSCILLATOR, desktop


async def test_a_program_runs_and_its_curve_is_drawn(program):
    async with desktop(program(OSCILLATOR)) as desk:
        await desk.line("zz")
        await desk.idle()
        assert "> zz" in desk.output
        shown = float(desk.output.split("x = ")[-1])
        assert abs(shown - math.cos(6)) < 1e-5
        graph = desk.app.graph
        graph.tick()
        assert graph.page is not None
        assert graph.page.caption == "x, v vs. t"
        # cos starts at +1, at the top left; the curve crosses the middle where cos is 0
        canvas = graph.canvas
        assert canvas is not None
        assert canvas.patterns[0, 0]
        assert canvas.patterns.any(axis=0).all()
        assert desk.app.editor.active is desk.app.editor.front


async def test_curves_grow_while_the_run_goes_on_and_it_can_be_paused_resumed_and_ended(program):
    async with desktop(program(LONG)) as desk:
        app = desk.app
        await desk.press("f5")
        await desk.until(lambda: app.session.runs and app.session.runs[0].count > 100)
        app.graph.tick()
        assert app.graph.canvas is not None
        filled = app.graph.canvas.patterns.any(axis=0)
        assert filled[0]
        assert not filled[-1]
        assert app.session.runs[0].ended == "running"

        await desk.press("ctrl+c")
        await desk.until(lambda: app.session.status.state is State.PAUSED)
        before, count = -1, app.session.runs[0].count
        while before != count:  # a pause is asked for; on a busy machine the run hears of it some time later
            await desk.pilot.pause(0.1)
            before, count = count, app.session.runs[0].count
        assert app.session.runs[0].ended == "running"
        app.show_status()
        assert "Paused" in app.main_screen.query_one("#status").hint

        await desk.line("x")  # names show values during a run
        assert f"{app.session.values.cells[app.session.values.find('x').slot]:g}" in desk.output

        await desk.press("enter")
        await desk.until(lambda: app.session.runs[0].count > count)
        await desk.press("ctrl+c")
        await desk.until(lambda: app.session.status.state is State.PAUSED)
        await desk.press("space", "enter")
        await desk.idle()
        assert app.session.runs[0].ended == "stopped"
        assert "x = " not in desk.output
        assert desk.output.rstrip().endswith("ended")


async def test_a_script_brings_lines_into_view_and_leaves_the_focus(program):
    text = "x = 1\n\ny = 2\nedit 220-230\nz = 3\n"
    async with desktop(program(text)) as desk:
        await desk.line("zz")
        await desk.idle()
        await desk.until(lambda: desk.app.editor.front.cursor_location == (2, 0))
        assert desk.app.focused is desk.app.command.prompt
        await desk.line("edit 240")
        await desk.until(lambda: desk.app.editor.front.cursor_location == (4, 0))
        assert desk.app.editor.front.text == text


async def test_a_double_click_on_the_graph_pauses(program):
    async with desktop(program(LONG)) as desk:
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.runs and desk.app.session.runs[0].count > 10)
        await desk.pilot.click("#graph", times=2)
        await desk.until(lambda: desk.app.session.status.state is State.PAUSED)


async def test_running_again_ends_the_run_that_goes_on(program):
    async with desktop(program(LONG)) as desk:
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.runs and desk.app.session.runs[0].count > 10)
        first = desk.app.session.runs[0]
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.runs and desk.app.session.runs[0] is not first)
        assert first.ended == "stopped"


async def test_a_mistake_sends_the_cursor_to_its_line(program):
    async with desktop(program(OSCILLATOR.replace("-x", "-xx"))) as desk:
        await desk.press("f5")
        await desk.idle()
        area = desk.app.editor.front
        row = next(n for n, line in enumerate(area.document.lines) if "-xx" in line)
        assert area.cursor_location[0] == row
        assert area.marks.problems[row][0].code == 200
        assert f"osc.src:{row + 1}:" in desk.output
        assert "error 200" in desk.output


async def test_problems_show_while_typing_and_f8_goes_to_them(program):
    async with desktop(program(OSCILLATOR)) as desk:
        area = desk.app.editor.front
        area.focus()
        assert not area.marks.problems
        area.go_to(8, 12)
        await desk.press("q")
        await desk.until(lambda: area.marks.problems)
        area.go_to(0)
        await desk.press("f8")
        assert area.cursor_location[0] == 8
        assert area.marks.problems[8][0].message in str(desk.app.editor.query_one("#problem").content)


async def test_a_run_begins_by_saying_how_many_problems_the_program_has(program):
    text = "if 1 > 2 then x = nowhere | go to no_place | proceed\nwrite 'done'\nDYNAMIC\nlabel a\nx = 1\nlabel a\nx = 2\n"
    async with desktop(program(text)) as desk:
        await desk.press("f5")
        await desk.until(lambda: "2 errors, 1 warning: F8 goes from one to the next\n" in desk.output)
        await desk.until(lambda: "done" in desk.output)


async def test_stop_and_go(program):
    async with desktop(program("x = 1\nSTOP\nwrite 'went on'\n")) as desk:
        await desk.line("zz")
        await desk.idle()
        assert desk.app.editor.front.marks.traced == 2
        assert "went on" not in desk.output.replace("write 'went on'", "")
        await desk.line("go")
        await desk.idle()
        assert desk.output.rstrip().endswith("went on")
        assert desk.app.editor.front.marks.traced is None


async def test_a_breakpoint_stops_the_script_before_its_line_and_moves_with_it(program):
    async with desktop(program("x = 1\nx = 2\nx = 3\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        area.go_to(1)
        await desk.press("f9")
        area.go_to(0, 0)
        await desk.press("enter")
        assert area.marks.breakpoints == {2}
        await desk.press("f5")
        await desk.idle()
        assert desk.app.session.values.cells[desk.app.session.values.find("x").slot] == 1
        assert area.marks.traced == 2
        await desk.press("f10")
        await desk.idle()
        assert desk.app.session.values.cells[desk.app.session.values.find("x").slot] == 3


async def test_trace_steps_through_the_script(program):
    async with desktop(program("x = 1\nx = 2\nx = 3\n")) as desk:
        await desk.press("f12")
        await desk.press("f5")
        rows = []
        for _ in range(3):
            await desk.idle()
            rows.append(desk.app.editor.front.marks.traced)
            await desk.press("f10")
        await desk.idle()
        assert rows == [0, 1, 2]


async def test_input_asks_in_the_command_line(program):
    async with desktop(program("input a\nwrite 2*a\n")) as desk:
        await desk.press("f5")
        await desk.until(lambda: desk.app.command.is_asking)
        desk.app.command.prompt.value = "21"
        await desk.press("enter")
        await desk.idle()
        assert desk.output.rstrip().endswith("42")


async def test_input_can_be_broken_off(program):
    async with desktop(program("input a\nwrite 'never'\n")) as desk:
        await desk.press("f5")
        await desk.until(lambda: desk.app.command.is_asking)
        await desk.press("ctrl+c")
        await desk.idle()
        assert "never" not in desk.output.replace("'never'", "")
        assert not desk.app.command.is_asking


async def test_pasted_lines_run_one_after_the_other(program):
    async with desktop(program("")) as desk:
        from textual.events import Paste

        desk.app.command.prompt.focus()
        await desk.pilot.pause()
        desk.app.command.prompt.post_message(Paste("a = 2\nb = a*21\nwrite b\nwrite a"))
        await desk.until(lambda: desk.output.rstrip().endswith("42"))
        assert desk.app.command.prompt.value == "write a"


async def test_an_endless_loop_can_be_broken_off(program):
    async with desktop(program("repeat\n  x = 1\nuntil 1 > 2\n")) as desk:
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.status.state is State.SCRIPT)
        await desk.press("shift+f10")
        await desk.idle()
        assert "ended" in desk.output


async def test_a_shell_command_is_asked_for(program):
    async with desktop(program("sh echo hello-from-sh\n")) as desk:
        await desk.press("f5")
        await desk.until(lambda: len(desk.app.screen_stack) > 1)
        await desk.press("r")
        await desk.idle()
        assert "error 450" in desk.output
        await desk.press("f5")
        await desk.until(lambda: len(desk.app.screen_stack) > 1)
        await desk.press("a")
        await desk.idle()
        assert desk.output.rstrip().endswith("hello-from-sh")


async def test_control_characters_do_not_reach_the_terminal(program):
    async with desktop(program("write 'a\x1b[2Jb\x07[bold]c'\n")) as desk:
        await desk.press("f5")
        await desk.idle()
        assert "a␛[2Jb␇[bold]c" in desk.output


async def test_a_click_on_an_error_goes_to_its_place(program):
    async with desktop(program(OSCILLATOR.replace("-x", "-xx"))) as desk:
        await desk.press("f5")
        await desk.idle()
        area, console = desk.app.editor.front, desk.app.command.console
        area.go_to(0)
        row = next(
            n
            for n, (number, *_) in enumerate(console.scrollback.rows)
            if "osc.src:" in console.scrollback.lines[number].text
        )
        await desk.pilot.click("#console", offset=(3, row - int(console.scroll_offset.y)))
        assert area.cursor_location[0] == 8
        assert desk.app.focused is area


async def test_output_can_be_searched_and_copied(program, monkeypatch):
    text = "for i = 1 to 200 | write 'line ', i | next\n"
    async with desktop(program(text)) as desk:
        await desk.press("f5")
        await desk.idle()
        console = desk.app.command.console
        assert desk.output.splitlines()[-1] == "line \t200".expandtabs(8)
        await desk.press("alt+y")
        field = desk.app.command.query_one("#output-search")
        field.value = "17 "
        assert not console.search("no such text")
        field.value = "17"
        await desk.press("enter")
        assert console.found[1] < 200
        assert "17" in console.scrollback.lines[console.found[1]].text
        first = console.found[1]
        await desk.press("enter")
        assert console.found[1] < first
        await desk.press("escape")
        assert desk.app.focused is desk.app.command.prompt
        monkeypatch.setenv("TMUX", "x")
        await desk.do("view.copy_output")
        assert desk.app.clipboard == console.text
        notices = [note.message for note in desk.app._notifications]
        assert any("set-clipboard" in message for message in notices)


async def test_no_color_means_no_color(program, monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    async with desktop(program(OSCILLATOR)) as desk:
        assert desk.app.no_color
