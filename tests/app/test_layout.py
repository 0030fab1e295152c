"""Which panes are shown where: at every size, by default, asked for, maximized, while a run goes on."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from desire_tui.desktop.layout_rules import EVERYTHING, SMALLEST, arrange
from desire_tui.desktop.main_screen import PANES
from desire_tui.panes.side_pane import SidePane, SideTabs

from .conftest import LONG, OSCILLATOR, Desktop, desktop

SIZES = [(16, 3), (20, 5), (40, 10), (40, 12), (60, 50), (80, 24), (100, 30), (120, 40), (160, 50), (250, 70)]
panes = st.sampled_from(PANES)


@given(st.integers(1, 300), st.integers(1, 100), panes, st.none() | panes, st.none() | st.booleans())
def test_the_pane_with_the_keys_is_always_seen(width: int, height: int, keys, alone, side):
    if keys == "side" and side is not True:
        side = True  # a hidden pane never has the keys
    now = arrange(width, height, focused=keys, maximized=None if alone is None else keys, side=side)
    assert now.too_small == (width < SMALLEST[0] or height < SMALLEST[1])
    assert now.too_small or keys in now.panes
    assert now.panes <= EVERYTHING
    assert (now.order == "one") == (len(now.panes) <= 1)


@pytest.mark.parametrize(
    ("size", "shown", "order"),
    [
        ((250, 70), {"editor", "command", "graph", "side"}, "columns"),
        ((120, 40), {"editor", "command", "graph", "side"}, "columns"),
        ((119, 40), {"editor", "command", "graph"}, "columns"),
        ((120, 39), {"editor", "command", "graph"}, "columns"),
        ((80, 24), {"editor", "command", "graph"}, "columns"),
        ((60, 50), {"editor", "command", "graph"}, "rows"),
        ((40, 12), {"command", "graph"}, "rows"),
        ((20, 5), {"command"}, "one"),
        ((15, 5), set(), "one"),
    ],
)
def test_what_is_shown_by_default(size: tuple[int, int], shown: set[str], order: str):
    now = arrange(*size, focused="command")
    assert (now.panes, now.order) == (shown, order)


def fills_the_screen(desk: Desktop) -> None:
    """Every cell belongs to exactly one pane, or to the status row."""
    width, height = desk.app.size
    regions = [desk.app.main_screen.query_one(f"#{name}").region for name in desk.app.main_screen.shown]
    regions.append(desk.app.main_screen.query_one("#status").region)
    assert sum(region.area for region in regions) == width * height
    for region in regions:
        assert 0 <= region.x < region.right <= width
        assert 0 <= region.y < region.bottom <= height
    assert not any(a.overlaps(b) for n, a in enumerate(regions) for b in regions[:n])


@pytest.mark.parametrize(
    "sizes", [SIZES[0::3], SIZES[1::3], SIZES[2::3]], ids=["from 16", "from 20", "from 40"]
)
async def test_every_size_is_used_whole_and_can_be_worked_in(program, sizes: list[tuple[int, int]]):
    """Each of three desktops begins at its first size; the others come by resizing the terminal."""
    async with desktop(program(OSCILLATOR), size=sizes[0]) as desk:
        assert desk.app.focused is desk.app.command.prompt
        await desk.press("z", "z", "enter")
        await desk.idle()
        assert "x = " in desk.output
        for size in sizes:
            desk.app.main_screen.close_side()
            desk.app.move_focus(desk.app.command.prompt)
            await desk.pilot.resize_terminal(*size)
            await works_at_this_size(desk)


async def works_at_this_size(desk: Desktop) -> None:
    """Every pane is reached and seen, the side pane comes when it is asked for, the graph alone has curves."""
    fills_the_screen(desk)
    seen = set(desk.app.main_screen.shown)
    for _ in range(4):
        await desk.press("f6")
        await desk.pilot.pause()
        assert desk.app.main_screen.pane_of(desk.app.focused) in desk.app.main_screen.shown
        assert desk.app.focused.region.area
        seen |= desk.app.main_screen.shown
        fills_the_screen(desk)
    assert {"editor", "command", "graph"} <= seen
    await desk.press("alt+q")
    await desk.pilot.pause()
    assert "side" in desk.app.main_screen.shown
    fills_the_screen(desk)
    await desk.press("f7")
    await desk.pilot.pause()
    assert desk.app.main_screen.shown == {"graph"}
    desk.app.graph.tick()
    assert desk.app.graph.canvas.patterns.any()
    await desk.press("f7")
    await desk.pilot.pause()
    fills_the_screen(desk)


async def test_a_terminal_of_no_use_says_so(program):
    async with desktop(program(OSCILLATOR), size=(15, 5)) as desk:
        assert desk.app.main_screen.query_one("#too-small").display
        await desk.pilot.resize_terminal(100, 30)
        await desk.pilot.pause()
        assert not desk.app.main_screen.query_one("#too-small").display
        fills_the_screen(desk)


async def test_resizing_while_a_run_goes_on(program):
    async with desktop(program(LONG)) as desk:
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.runs and desk.app.session.runs[0].count > 10)
        for size in [(60, 20), (15, 2), (160, 50), (40, 12), (80, 24), (20, 5), (150, 45)]:
            await desk.pilot.resize_terminal(*size)
            await desk.pilot.pause()
            desk.app.graph.tick()
            if size != (15, 2):
                fills_the_screen(desk)
        assert desk.app.session.runs[0].ended == "running"
        assert desk.app.graph.canvas.columns > 60
        assert desk.app.graph.canvas.patterns[:, 0].any()


async def test_the_side_pane_follows_the_size_until_the_user_decides(program):
    async with desktop(program(OSCILLATOR), size=(80, 24)) as desk:
        assert desk.app.main_screen.side is None
        await desk.pilot.resize_terminal(120, 40)
        assert desk.app.main_screen.side == "quantities"
        await desk.press("alt+h")
        assert desk.app.main_screen.side is None
        await desk.pilot.resize_terminal(160, 50)
        assert desk.app.main_screen.side is None
        await desk.press("alt+q")
        await desk.pilot.resize_terminal(80, 24)
        assert desk.app.main_screen.side == "quantities"


async def test_the_side_panes_key_moves_there_first_and_hides_it_then(program):
    async with desktop(program(OSCILLATOR), size=(120, 40)) as desk:
        assert desk.app.focused is desk.app.command.prompt
        await desk.press("alt+q")
        assert desk.app.focused is desk.app.quantities.table
        await desk.press("alt+q")
        assert desk.app.main_screen.side is None
        assert desk.app.focused is desk.app.command.prompt


async def test_the_tabs_of_the_side_pane(program):
    async with desktop(program(OSCILLATOR.replace("-x", "-xx")), size=(120, 40)) as desk:
        tabs = desk.app.main_screen.query_one(SideTabs)
        await desk.until(lambda: tabs.problems == 1)
        text = tabs.render_line(0).text
        assert text.startswith("╭─ Quantities │ Problems 1 │ Help ──")
        for name in ("Problems", "Help", "Quantities"):
            await desk.pilot.click(SideTabs, offset=(text.index(name) + 1, 0))
            await desk.pilot.pause()
            assert desk.app.main_screen.side == name.lower()
            assert desk.app.main_screen.query_one(SidePane) in desk.app.focused.ancestors
        await desk.pilot.click(SideTabs, offset=(len(text) - 1, 0))
        assert desk.app.main_screen.side == "quantities"


async def test_maximizing_any_pane_and_moving_on(program):
    async with desktop(program(OSCILLATOR), size=(100, 30)) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.press("alt+e", "f4")
        assert desk.app.main_screen.shown == {"editor"}
        await desk.press("f6")
        assert desk.app.main_screen.shown == {"command"}
        await desk.press("f4")
        assert desk.app.main_screen.shown == {"editor", "command", "graph"}


async def test_on_a_small_screen_a_run_begun_in_the_editor_is_seen(program):
    async with desktop(program(OSCILLATOR), size=(40, 12)) as desk:
        await desk.press("alt+e")
        assert desk.app.main_screen.shown == {"editor"}
        await desk.press("f5")
        await desk.idle()
        assert desk.app.main_screen.shown == {"command", "graph"}
        assert desk.app.focused is desk.app.command.prompt


async def test_problems_are_listed_when_their_pane_is_shown(program):
    async with desktop(program("y = 1\nnonsense here\n"), size=(100, 30)) as desk:
        app = desk.app
        problems = app.main_screen.side_pane.problems
        await desk.until(lambda: app.editor.front.marks.problems)
        await desk.idle()
        assert not problems.option_count
        await desk.press("alt+p")
        await desk.until(
            lambda: problems.option_count == 1 and "error" in str(problems.get_option_at_index(0).prompt)
        )
        await desk.press("alt+h", "alt+e", "ctrl+end", *"more nonsense")
        await desk.until(lambda: len(app.editor.front.marks.all_problems()) == 2)
        await desk.press("alt+p")
        await desk.until(lambda: problems.option_count == 2)
        await desk.press("end", "enter")
        await desk.until(lambda: app.editor.front.cursor_location[0] == 2)
