"""The examples browser: order, search, pictures made on the spot, copies."""

from __future__ import annotations

import numpy as np

from desire_tui.panes.example_catalogue import Example, examples
from desire_tui.panes.example_preview import Previewer
from desire_tui.panes.examples_browser import ExamplesScreen
from desire_tui.panes.thumbnail import Thumbnail

from .conftest import desktop


def named(name: str) -> Example:
    return next(example for example in examples() if example.name == name)


async def browser(desk) -> ExamplesScreen:
    await desk.press("f11")
    await desk.until(lambda: isinstance(desk.app.screen, ExamplesScreen))
    await desk.until(lambda: desk.app.screen.highlighted is not None)
    return desk.app.screen


def picture(screen: ExamplesScreen) -> Thumbnail:
    return screen.query_one(Thumbnail)


def rows(thumbnail: Thumbnail) -> list[str]:
    return [thumbnail.render_line(y).text for y in range(thumbnail.size.height)]


def dots(line: str) -> int:
    return sum((ord(c) - 0x2800).bit_count() for c in line if 0x2800 <= ord(c) < 0x2900)


async def test_the_picture_is_the_programs_own_graph(program):
    """x = X - 1 of five responses with damping 10 … 50; the undershoot at the left is -1, all end near 0.1."""
    async with desktop(program("x = 1\n"), size=(120, 40)) as desk:
        screen = await browser(desk)
        await desk.press(*"step_response")
        await desk.until(lambda: screen.highlighted == named("step_response"))
        await desk.until(lambda: picture(screen).graph is not None)
        graph = picture(screen).graph
        assert graph.caption == "X vs. t"
        assert len(graph.curves) == 5
        # d2x/dt2 = 440 - 400 x - r dx/dt from rest, X = x - 1: the last curve has r = 50
        t, x = graph.curves[-1].samples()
        a, b = -10.0, -40.0  # roots of s^2 + 50 s + 400
        exact = 1.1 * (1 + (b * np.exp(a * t) - a * np.exp(b * t)) / (a - b)) - 1
        assert np.abs(x - exact).max() < 1e-3
        text = rows(picture(screen))
        assert text[0].strip() == "step_response.src · runs 1–5 · r = 10 … 50 · scale = 1"
        assert "■ r = 10 ■ r = 20" in text[-1]
        assert sum(map(dots, text)) > 200


async def test_moving_shows_each_programs_picture_and_skips_the_chapters_headings(program):
    async with desktop(program("x = 1\n"), size=(120, 40)) as desk:
        screen = await browser(desk)
        seen = [screen.highlighted.name]
        for _ in range(7):
            await desk.press("down")
            seen.append(screen.highlighted.name)
        assert seen == [example.name for example in examples()[:8]]
        await desk.until(lambda: picture(screen).graph is not None)
        await desk.press("up", "up")
        await desk.until(lambda: screen.highlighted.name == "step_response")
        await desk.press("end", *["pagedown"] * 16)
        assert screen.highlighted == examples()[-1]
        await desk.press(*["pageup"] * 16)
        assert screen.highlighted == examples()[0]


async def test_a_program_without_a_graph_shows_what_it_prints(program):
    async with desktop(program("x = 1\n"), size=(120, 40)) as desk:
        screen = await browser(desk)
        await desk.press(*"loops_and")
        await desk.until(lambda: "sum of 1 to 10:" in picture(screen).text)
        assert "55" in rows(picture(screen))[0]
        await desk.press("x", "y", "q")
        assert screen.highlighted is None
        await desk.press("enter")  # nothing to open
        assert desk.app.screen is screen
        await desk.press("escape")
        await desk.until(lambda: desk.app.screen is desk.app.main_screen)


async def test_enter_opens_a_copy_and_saving_it_leaves_the_original_alone(tmp_path):
    original = named("lorenz")
    async with desktop() as desk:
        await browser(desk)
        await desk.press(*"lorenz", "enter")
        await desk.until(lambda: desk.app.editor.front.buffer.name == "lorenz.src")
        area = desk.app.editor.front
        assert area.text == original.text
        assert area.buffer.path is None
        assert not area.is_dirty
        area.insert("-- mine\n", (0, 0))
        await desk.do("file.save", str(tmp_path / "mine.src"))
        await desk.until((tmp_path / "mine.src").exists)
        assert (tmp_path / "mine.src").read_text() == "-- mine\n" + original.text
        assert original.path.read_text() == original.text


async def test_an_untouched_copy_is_not_opened_twice_a_changed_one_is(program):
    async with desktop(program("x = 1\n")) as desk:
        for _ in range(2):
            await browser(desk)
            await desk.press(*"lorenz", "enter")
            await desk.until(lambda: desk.app.editor.front.buffer.name == "lorenz.src")
        assert len(desk.app.editor.areas) == 2
        desk.app.editor.front.insert("-- mine\n", (0, 0))
        await browser(desk)
        await desk.press(*"lorenz", "enter")
        await desk.until(lambda: len(desk.app.editor.areas) == 3)


async def test_f5_opens_and_runs(program):
    async with desktop(program("x = 1\n")) as desk:
        await browser(desk)
        await desk.press(*"free_osc", "f5")
        await desk.until(lambda: desk.app.graph.page is not None)
        await desk.idle()
        assert desk.app.editor.active.buffer.name == "free_oscillation.src"
        assert desk.app.session.runs[-1].ended == "tmax"


async def test_a_programs_files_are_written_where_the_user_is_and_never_by_the_picture(tmp_path):
    """files.src writes `three.dat`: run for its picture it must not leave anything, run by the user it must."""
    async with desktop() as desk:
        screen = await browser(desk)
        await desk.press(*"ch5 files")
        await desk.until(lambda: screen.highlighted == named("files"))
        await desk.until(lambda: picture(screen).text)
        assert not list(tmp_path.glob("three*"))
        await desk.press("f5")
        await desk.until(lambda: list(tmp_path.glob("three*")))
        await desk.idle()


async def test_a_new_wish_ends_the_run_of_an_older_one(tmp_path):
    made = []
    previewer = Previewer(made.append)
    endless = "TMAX = 1E7 | DT = 0.001 | NN = 1000001\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x\n"
    quick = "TMAX = 1 | DT = 0.1 | NN = 11\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x\n"
    slow, fast = (Example(tmp_path / f"{n}.src", text) for n, text in (("slow", endless), ("fast", quick)))
    previewer.ask(slow)
    while previewer._session is None or not previewer._session.runs:
        pass
    previewer.ask(fast)
    while not made:
        pass
    previewer.close()
    previewer._thread.join(120)
    assert not previewer._thread.is_alive()
    assert [preview.example for preview in made] == [fast]
    assert abs(made[0].graph.curves[0].samples()[1][-1] - 1) < 1e-12


async def test_a_program_that_fails_says_so(tmp_path):
    made = []
    previewer = Previewer(made.append)
    previewer.ask(Example(tmp_path / "bad.src", "write 1/0\n"))
    while not made:
        pass
    previewer.close()
    assert made[0].graph is None
    assert "zero" in made[0].problem


async def test_where_there_is_hardly_any_room_the_description_has_it(program):
    async with desktop(program("x = 1\n"), size=(60, 16)) as desk:
        screen = await browser(desk)
        assert not picture(screen).display
        await desk.pilot.resize_terminal(80, 24)
        await desk.until(lambda: picture(screen).display and picture(screen).graph is not None)
        await desk.until(lambda: "■" in rows(picture(screen))[-1])


async def test_the_first_start_opens_a_copy_and_the_tour_comes_once():
    original = named("step_response")
    async with desktop() as desk:
        assert desk.app.editor.front.text == original.text
        assert desk.app.editor.front.buffer.path is None
        assert "Welcome" in desk.output
        desk.app.leave()
    async with desktop() as desk:
        assert desk.app.editor.front.text == original.text
        assert "Welcome" not in desk.output
