"""When and how much is sent to the terminal: a sheet in pieces, a held screen, a first frame at once."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
from rich.style import Style
from textual.screen import Screen

from desire_tui.engine.outputs.braille_canvas import Canvas
from desire_tui.engine.outputs.text_frame import TextFrame
from desire_tui.panes.graph_sheet import GraphSheet, SheetStyles

from .conftest import LONG, OSCILLATOR, desktop

LOOK = SheetStyles(Style(bgcolor="black"), Style(bold=True), Style(color="white"), white=False)
FRAME = TextFrame(("head".center(26), "   ┌" + "─" * 20 + "┐", *["   │" + " " * 20 + "│"] * 3), 4, 2, 20, 3)


def sheet_with(canvas: Canvas) -> GraphSheet:
    sheet = GraphSheet()
    sheet.lay(26, 5, LOOK, FRAME.lines, FRAME, canvas)
    return sheet


def row_of(sheet: GraphSheet, y: int) -> str:
    return "".join(sheet.piece(tile, y).text for tile in range(4))


def test_the_pieces_of_a_row_are_frame_and_curves_side_by_side():
    canvas = Canvas(20, 3, FRAME.left)
    canvas.line(np.array([0.0, 1.0]), np.array([0.99, 0.99]), color=14)
    sheet = sheet_with(canvas)
    assert row_of(sheet, 0).rstrip() == FRAME.lines[0].rstrip()
    assert row_of(sheet, 2) == "   │" + canvas.text(0) + "│" + " " * 7
    assert row_of(sheet, 3) == FRAME.lines[3].ljust(32)
    assert all(sheet.piece(tile, y).cell_length == 8 for tile in range(4) for y in range(5))


def test_equal_pieces_are_one_object_and_only_what_looks_different_is_sent_again():
    canvas = Canvas(20, 3, FRAME.left)
    sheet = sheet_with(canvas)
    assert sheet.piece(1, 2) is sheet.piece(1, 3) is sheet.piece(1, 4)
    assert len(sheet.changed(sheet.cells)) == 4 * 5
    assert sheet.changed(sheet.cells) == []
    canvas.dots(np.array([0.5]), np.array([0.5]), color=9)  # column 10 of the canvas is in tile (4 + 10) // 8
    assert sheet.changed(sheet.cells) == [(2 + 1, 1)]
    dirty = {(row + FRAME.top, tile) for row, tile in canvas.take_dirty()}
    assert dirty == {(3, 1)}  # the canvas counts its tiles from the sheet's edge too
    canvas.clear()
    assert sheet.changed(sheet.cells) == [(3, 1)]


def test_the_cursor_line_stands_where_the_canvas_is_and_keeps_the_dots():
    canvas = Canvas(20, 3, FRAME.left)
    canvas.dots(np.array([0.5]), np.array([0.5]), color=9)
    sheet = sheet_with(canvas)
    sheet.cursor = (FRAME.left + 10, Style(bold=True))
    rows = [row_of(sheet, y) for y in range(5)]
    assert [row[FRAME.left + 10] for row in rows[2:]] == ["│", canvas.text(1)[10], "│"]
    assert rows[1][FRAME.left + 10] == "─"


async def test_a_held_screen_sends_nothing_and_loses_nothing(program, monkeypatch):
    async with desktop(program(OSCILLATOR)) as desk:
        app = desk.app
        sent = []
        monkeypatch.setattr(app, "_display", lambda screen, update: sent.append(update))
        app.main_screen.hold()
        app.command.console.add("held back")
        for _ in range(5):
            await desk.pilot.pause(0.02)
        assert [update for update in sent if update is not None] == []
        app.main_screen.release()
        await desk.until(
            lambda: (
                any(update is not None for update in sent)
                and any("held back" in strip.text for strip in app.main_screen._compositor.render_strips())
            )
        )


async def test_a_run_that_fails_before_its_first_frame_leaves_no_screen_held(program):
    async with desktop(program("TMAX = 1\nx = nowhere\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x\n")) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.until(lambda: not desk.app.main_screen.is_held)
        assert "nowhere" in desk.output


async def test_a_first_frame_does_not_wait_for_the_clock_but_the_next_does(program):
    async with desktop(program(LONG)) as desk:
        app = desk.app
        await desk.press("f5")
        await desk.until(lambda: app.graph.canvas is not None and app.graph.canvas.patterns.any())
        await desk.until(lambda: app.frame_pacing._drawn_at > 0.0)  # laying out draws too
        drawn = app.frame_pacing._drawn_at
        app.frame_pacing._drawn_at = float("inf")  # just drawn
        app.graph._drawn = ()
        app.frame_pacing.at_once()
        assert app.graph._drawn == ()
        app.frame_pacing._drawn_at = drawn - 1.0
        app.frame_pacing.at_once()
        assert app.graph._drawn != ()


def test_the_desktop_opens_without_tls_and_leaves_it_to_those_who_want_it():
    code = (
        "import sys\nfrom desire_tui import launch\n"
        "with launch._without('ssl'):\n    import asyncio\n"
        "assert asyncio.sslproto.ssl is None and 'ssl' not in sys.modules\n"
        "import ssl\nssl.create_default_context\n"
        "asyncio.run(asyncio.sleep(0))\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_desktop_opens_without_what_only_the_engine_and_dialogs_need():
    """NumPy alone would be a fifth of the time to the first key."""
    code = (
        "import sys\nimport desire_tui.app\n"
        "late = {'numpy', 'matplotlib', 'plotext', 'llvmlite', 'lark', 'textual_fspicker', 'textual.widgets._markdown'}\n"
        "assert not late & sys.modules.keys(), late & sys.modules.keys()\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_garbage_collector_works_again_once_the_desktop_is_there():
    code = (
        "import gc\nfrom desire_tui.desktop.start_up_gc import resume_gc\n"
        "gc.disable()\nresume_gc()\n"
        "assert gc.isenabled() and gc.get_freeze_count() > 1000\n"
        "count = gc.get_freeze_count()\nresume_gc()\nassert gc.get_freeze_count() == count\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


async def test_what_is_sent_at_once_leaves_nothing_else_out(program):
    """The answer to `input`, and what the program then wrote, were not seen in half of all cases."""
    async with desktop(program(OSCILLATOR)) as desk:
        screen, console = desk.app.main_screen, desk.app.command.console
        screen._dirty_widgets.add(console)
        screen.send_only(*desk.app.graph.children)
        assert console in screen._dirty_widgets


async def test_before_the_first_picture_all_is_laid_out_for_the_size_and_once_when_it_stands(
    program, monkeypatch
):
    laid_out: list[bool] = []
    lay_out = Screen._refresh_layout

    def noted(screen: Screen[None], *arguments: object, **options: object) -> None:
        if screen.is_held:
            laid_out.append(True)
        lay_out(screen, *arguments, **options)

    monkeypatch.setattr(Screen, "_refresh_layout", noted)
    async with desktop(program(OSCILLATOR)) as desk:
        assert len(laid_out) == 2
        assert desk.app.editor.front.size.width > 0
