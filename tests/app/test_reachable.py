"""Every action, carried out without a mouse and without Ctrl+Enter, before a run and after one, and nothing breaks."""

from __future__ import annotations

from contextlib import nullcontext
from typing import TYPE_CHECKING

import pytest
from textual.command import CommandPalette
from textual.screen import ModalScreen
from textual.widgets import Input

from desire_tui.commands import COMMANDS, Command

from .conftest import OSCILLATOR, Desktop, desktop

if TYPE_CHECKING:
    from collections.abc import Callable

PARTS = sorted({command.id.partition(".")[0] for command in COMMANDS})
LEAVES = {"file.quit"}


def spy(desk: Desktop) -> list[str]:
    """Note the actions that begin; they are carried out all the same."""
    done: list[str] = []
    begin: Callable[..., object] = desk.app.call

    def noted(command_id: str, argument: str = "") -> object:
        done.append(command_id)
        return begin(command_id, argument)

    desk.app.call = noted  # type: ignore[method-assign]
    return done


async def settle(desk: Desktop) -> None:
    """Answer no to whatever is asked; wait for the engine."""
    await desk.pilot.pause()
    while isinstance(desk.app.screen, ModalScreen):
        screen = desk.app.screen
        await desk.press("escape")
        await desk.until(lambda screen=screen: desk.app.screen is not screen)
    await desk.idle()
    assert desk.app.is_running
    assert "internal error" not in desk.output


async def by_key(desk: Desktop, command: Command) -> None:
    await desk.press(command.keys.split(",")[0])


async def by_palette(desk: Desktop, command: Command) -> None:
    """Ctrl+P, the action's title, Enter on the first hit of that name."""
    await desk.press("ctrl+p")
    await desk.until(lambda: isinstance(desk.app.screen, CommandPalette))
    palette = desk.app.screen
    palette.query_one(Input).value = command.title
    options = palette.query_one("CommandList")

    def place() -> int | None:
        titles = [str(options.get_option_at_index(n).prompt) for n in range(options.option_count)]
        rows = [title.splitlines()[0].split("  ")[0].strip() for title in titles if title]
        return rows.index(command.title) if command.title in rows else None

    await desk.until(lambda: place() is not None)
    await desk.pilot.pause()
    options.highlighted = place()
    await desk.press("enter")
    await desk.until(lambda: desk.app.screen is not palette)


@pytest.mark.parametrize("part", PARTS)
async def test_every_action_is_carried_out_after_a_run(program, monkeypatch, part: str):
    """By its key, if it has one; dialogs are cancelled."""
    monkeypatch.setenv("EDITOR", "true")
    async with desktop(program(OSCILLATOR)) as desk:
        monkeypatch.setattr(desk.app, "suspend", nullcontext)
        await desk.press("f5")
        await desk.idle()
        done = spy(desk)
        for command in COMMANDS:
            if command.id.partition(".")[0] != part or command.id in LEAVES:
                continue
            desk.app.move_focus(desk.app.editor.front)
            await desk.pilot.pause()
            done.clear()
            if command.keys:
                await by_key(desk, command)
            else:
                desk.app.do(command.id)
            await desk.until(lambda: done)
            assert done[0] == command.id
            await settle(desk)


@pytest.mark.parametrize("part", PARTS)
async def test_every_action_is_carried_out_from_the_palette_before_a_run(program, monkeypatch, part: str):
    monkeypatch.setenv("EDITOR", "true")
    async with desktop(program(OSCILLATOR), size=(60, 14)) as desk:
        monkeypatch.setattr(desk.app, "suspend", nullcontext)
        done = spy(desk)
        for command in COMMANDS:
            if command.id.partition(".")[0] != part or command.id in LEAVES | {"view.palette"}:
                continue
            desk.app.move_focus(desk.app.command.prompt)
            await desk.pilot.pause()
            done.clear()
            await by_palette(desk, command)
            await desk.until(lambda wanted=command.id: wanted in done)
            await settle(desk)


@pytest.mark.parametrize("way", ["key", "palette", "word"])
async def test_quitting_by_key_by_palette_and_by_word(program, way: str):
    command = next(command for command in COMMANDS if command.id == "file.quit")
    async with desktop(program(OSCILLATOR)) as desk:
        left: list[bool] = []
        desk.app.leave = lambda: left.append(True)  # type: ignore[method-assign]
        match way:
            case "key":
                await by_key(desk, command)
            case "palette":
                await by_palette(desk, command)
            case "word":
                await desk.line("bye")
        await desk.until(lambda: left)


def test_no_key_needs_what_terminals_do_not_send():
    for command in COMMANDS:
        for key in command.keys.split(","):
            assert not key.endswith("+enter"), command.id
            assert key.count("ctrl+") + key.count("alt+") <= 1, command.id
