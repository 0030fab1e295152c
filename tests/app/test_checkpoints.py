"""When unsaved work goes to the recovery file."""

from __future__ import annotations

import threading

from textual import messages

from desire_tui.editor import recovery

from .conftest import desktop


def kept() -> str:
    file = recovery.recovery_file()
    return file.read_text() if file.exists() else ""


async def test_typing_is_kept_within_moments_and_written_in_a_thread(program, monkeypatch):
    threads = []
    store = recovery.store
    monkeypatch.setattr(
        recovery, "store", lambda *args: threads.append(threading.current_thread()) or store(*args)
    )
    async with desktop(program("x = 1\n")) as desk:
        desk.app.editor.front.focus()
        await desk.press("y")
        desk.app.checkpoint_soon()  # what the timer does every second
        await desk.until(lambda: "yx = 1" in kept())
        assert all(thread is not threading.main_thread() for thread in threads)
        assert desk.app.settings.checkpoint_seconds == 1


async def test_work_is_kept_before_a_run(program):
    async with desktop(program("x = 1\n")) as desk:
        desk.app.settings.checkpoint_seconds = 600
        desk.app.editor.front.insert("y")
        desk.app.call("run.start")
        await desk.until(lambda: "yx = 1" in kept())


async def test_work_is_kept_when_a_served_page_goes_away(program):
    async with desktop(program("x = 1\n")) as desk:
        desk.app.editor.front.insert("y")
        desk.app.post_message(messages.ExitApp())
        await desk.until(lambda: "yx = 1" in kept())


async def test_what_could_not_be_written_is_tried_again(program, monkeypatch):
    async with desktop(program("x = 1\n")) as desk:
        desk.app.editor.front.insert("y")
        with monkeypatch.context() as full_disk:
            full_disk.setattr(recovery, "store", lambda *args: False)
            assert not desk.app.checkpoints.checkpoint()
        assert desk.app.checkpoints.checkpoint()
        assert "yx = 1" in kept()
