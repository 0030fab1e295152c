"""Questions that grant something: all is seen, and no key answers that was meant for something else."""

from __future__ import annotations

import threading
from time import monotonic

import pytest
from textual import events
from textual.containers import VerticalScroll
from textual.widgets import Button, Label

from desire_tui.common.dialogs import UNREAD, Choice
from desire_tui.desktop.engine_messages import PermissionAnswer, PermissionRequested
from desire_tui.engine.session.permissions import PermissionRequest

from .conftest import Desktop, desktop

LONG = "echo harmless " + "# " * 2000 + "\n\n\n; rm -rf the-end"


async def asked(desk: Desktop, command: str) -> tuple[Choice, PermissionAnswer]:
    answer = PermissionAnswer(threading.Event())
    desk.app.message_handlers.handle(PermissionRequested(PermissionRequest("shell", command), answer))
    await desk.until(lambda: isinstance(desk.app.screen, Choice) and desk.app.screen.query(Button))
    await desk.pilot.pause()
    dialog = desk.app.screen
    assert isinstance(dialog, Choice)
    return dialog, answer


def seen(desk: Desktop) -> str:
    strips = desk.app.screen._compositor.render_strips()
    return "\n".join("".join(segment.text for segment in strip) for strip in strips)


@pytest.mark.parametrize("size", [(80, 24), (40, 10), (30, 6)])
async def test_a_long_command_is_allowed_only_when_it_was_seen_to_its_end(program, size):
    async with desktop(program("x = 1\n"), size=size) as desk:
        _, answer = await asked(desk, LONG)
        assert "Allow" in seen(desk)
        assert "Refuse" in seen(desk)
        assert "the-end" not in seen(desk)
        assert "to the end" in seen(desk)
        await desk.press("a", "left", "enter")
        await desk.pilot.click("#choice-0")
        assert not answer.done.is_set()
        for _ in range(1000):
            if "the-end" in seen(desk):
                break
            await desk.press("pagedown")
        assert "rm -rf the-end" in seen(desk)
        assert "Refuse" in seen(desk)
        await desk.press("a")
        assert answer.done.is_set()
        assert answer.yes


async def test_refusing_needs_no_reading(program):
    async with desktop(program("x = 1\n"), size=(80, 24)) as desk:
        _, answer = await asked(desk, LONG)
        await desk.press("enter")  # the answer that has the focus at first
        assert answer.done.is_set()
        assert not answer.yes


async def test_control_characters_and_line_ends_of_a_command_are_seen(program):
    async with desktop(program("x = 1\n")) as desk:
        dialog, _ = await asked(desk, "ls\x1b[2K\r\x1b]0;x\x07\u202e[red]\nrm a")
        text = str(dialog.query_one(Label).content)
        assert text.endswith("ls␛[2K␍␛]0;x␇�[red]␊\nrm a")
        assert "[red]␊" in seen(desk)


async def test_a_key_typed_before_the_question_was_drawn_is_no_answer(program):
    async with desktop(program("x = 1\n")) as desk:
        ahead = [events.Key("a", "a"), events.Key("enter", "\r"), events.Key("escape", None)]
        for key in ahead:
            key.time = monotonic()
        _, answer = await asked(desk, "ls")
        for key in ahead:
            desk.app.post_message(key)
        await desk.pilot.pause()
        assert not answer.done.is_set()
        await desk.press("a")
        assert answer.done.is_set()
        assert answer.yes


async def test_who_goes_on_typing_gives_no_answer(program, monkeypatch):
    async with desktop(program("x = 1\n")) as desk:
        monkeypatch.setattr("desire_tui.common.dialogs.GRACE_SECONDS", 1e6)
        dialog, answer = await asked(desk, "ls")
        since = dialog._quiet_since
        await desk.press("a", "enter")
        assert not answer.done.is_set()
        assert dialog._quiet_since > since


async def test_overwriting_begins_with_no(program, tmp_path):
    other = tmp_path / "other.src"
    other.write_text("y = 2\n")
    async with desktop(program("x = 1\n")) as desk:
        desk.app.do("file.save_as", str(other))
        await desk.until(lambda: isinstance(desk.app.screen, Choice))
        await desk.pilot.pause()
        await desk.press("enter")
        await desk.until(lambda: not isinstance(desk.app.screen, Choice))
        assert other.read_text() == "y = 2\n"


async def test_a_text_that_fits_is_seen_at_once(program):
    async with desktop(program("x = 1\n")) as desk:
        dialog, _ = await asked(desk, "ls")
        assert dialog.query_one(VerticalScroll).max_scroll_y == 0
        assert UNREAD not in seen(desk)
