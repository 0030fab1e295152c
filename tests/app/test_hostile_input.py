"""Hostile text pasted wherever the desktop takes some: no fault, nothing that a terminal would obey."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from textual.events import Paste
from textual.widgets import Input

from desire_tui.common import paths
from desire_tui.editor import recovery
from desire_tui.editor.recovery import SavedTab

from .conftest import Desktop, desktop
from .test_safety import dead_pid

if TYPE_CHECKING:
    from textual.widget import Widget

EVIL = "\x00\x1b]0;PWNED\x07\x1b[31m\x9bPWNED\u202ePWNED\u200b[red][/]\ud800x\udcff\x85\u2028end"
"""Control characters, bidirectional ones, markup, lone surrogates, line ends of Unicode."""


def assert_harmless(desk: Desktop) -> None:
    """What is sent to the terminal holds our own sequences only, and can be encoded; nothing has failed."""
    strips = desk.app.screen._compositor.render_strips()
    for strip in strips:
        assert "".join(segment.text for segment in strip if segment.control) == ""
        sent = "".join(strip.render(desk.app.console))
        sent.encode()
        assert not any(
            sign in sent for sign in ("\x00", "\x07", "\x1b]", "\x9b", "\u202e", "\u200b", "\x85", "\u2028")
        )
    assert desk.app._exception is None
    assert not (paths.state_folder() / "faults.log").exists()


async def paste(desk: Desktop, widget: Widget, text: str = EVIL) -> None:
    desk.app.set_focus(widget)
    await desk.pilot.pause()
    desk.app.screen.post_message(Paste(text))
    await desk.pilot.pause()
    assert_harmless(desk)


def field(desk: Desktop, name: str) -> Input:
    return desk.app.screen.query_one(name, Input)


async def test_fields_of_the_desktop(program):
    async with desktop(program("x = 1\n")) as desk:
        for command, name in (
            ("help.word", "#help-search"), ("edit.find", "#wanted"), ("edit.replace", "#replacement"),
            ("view.quantities", "#filter"), ("view.search_output", "#output-search"),
        ):  # fmt: skip
            await desk.do(command)
            await paste(desk, field(desk, name))
            await desk.press("enter")
            await desk.pilot.pause()
            assert_harmless(desk)
        await paste(desk, desk.app.editor.front)
        await paste(desk, desk.app.command.prompt)
        await desk.press("enter")
        await desk.idle()
        assert_harmless(desk)
        desk.app.editor.front.focus()
        desk.app.checkpoint()
        [tab] = recovery.read(recovery.recovery_file())
        assert tab.text == desk.app.editor.front.document.ended_text


async def test_the_examples_browser(program):
    async with desktop(program("x = 1\n")) as desk:
        await desk.do("file.examples")
        await desk.until(lambda: desk.app.screen.query("#examples-filter"))
        await paste(desk, field(desk, "#examples-filter"))
        await desk.press("down", "enter", "escape")
        assert_harmless(desk)


async def test_answers_of_a_program(program):
    async with desktop(program("input a\nwrite a\ninput b\n")) as desk:
        await desk.do("run.start")
        await desk.until(lambda: "waits for input" in desk.app.main_screen.status_bar.hint)
        for answer in (EVIL, EVIL, "1"):
            await paste(desk, desk.app.command.prompt, answer)
            await desk.press("enter")
            await desk.pilot.pause()
            assert_harmless(desk)
        await desk.press("ctrl+c")
        await desk.idle()
        assert_harmless(desk)


@pytest.mark.parametrize("name", [EVIL, "\ud800", "\udcff.src", "a\x00b", "\x1b[31m.src", "n" * 300])
async def test_names_to_save_under(program, tmp_path, name):
    async with desktop(program("x = 1\n")) as desk:
        await desk.do("file.save_as")
        await desk.until(lambda: desk.app.screen is not desk.app.main_screen)
        await paste(desk, desk.app.screen.query_one(Input), name)
        await desk.press("enter")
        await desk.pilot.pause()
        assert_harmless(desk)
        await desk.press("escape")
        await desk.pilot.pause()
        assert_harmless(desk)
        assert (tmp_path / "osc.src").read_text() == "x = 1\n"


async def test_names_in_commands(program):
    async with desktop(program("NN = 2 | TMAX = 1\ndrun\nDYNAMIC\nx = t\ndispt x\n")) as desk:
        await desk.do("run.start")
        await desk.idle()
        for command in ("file.open", "file.save_numbered", "graph.snapshot", "graph.export"):
            for name in ("a\x00b", "\ud800.src", "~nobody/there", "n" * 300):
                await desk.do(command, name)
                await desk.until(lambda: not desk.app.workers._workers)
                assert_harmless(desk)


async def test_work_of_another_session(program):
    recovery.store(
        paths.state_folder() / f"recovery-{dead_pid()}.json",
        [SavedTab(None, EVIL, EVIL), SavedTab(f"/{EVIL}", EVIL, EVIL)],
    )
    async with desktop(program("x = 1\n")) as desk:
        await desk.until(lambda: desk.app.screen is not desk.app.main_screen)
        assert_harmless(desk)
        await desk.press("r")
        await desk.until(lambda: desk.app.screen is desk.app.main_screen)
        assert_harmless(desk)
        assert EVIL.replace("\x85", "\n") in desk.app.editor.front.text or EVIL in desk.app.editor.front.text
        await desk.do("file.save")
        await desk.pilot.pause()
        assert_harmless(desk)
