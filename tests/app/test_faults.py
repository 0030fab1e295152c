"""Faults injected where Textual would end the app: it goes on, the work is kept, the fault is written up."""

from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING

import pytest
from textual.widgets import Static

from desire_tui.common import paths
from desire_tui.desktop import fault_barrier
from desire_tui.editor import recovery

from .conftest import Desktop, desktop

if TYPE_CHECKING:
    from collections.abc import Callable


class Boom(Exception):
    pass


def boom(*args: object, **options: object) -> None:
    raise Boom("injected")


class Unmountable(Static):
    def compose(self):
        raise Boom("injected")


async def worker() -> None:
    boom()


def in_render(desk: Desktop) -> None:
    desk.app.editor.front.render_line = boom
    desk.app.editor.front._drawn.clear()
    desk.app.editor.front.refresh(layout=True)


def in_layout(desk: Desktop) -> None:
    desk.app.editor.front.get_content_height = boom
    desk.app.command._size_updated = boom
    desk.app.screen.refresh(layout=True)


PLACES = {
    "action": lambda desk: desk.app.call_later(boom),
    "widget": lambda desk: desk.app.editor.front.call_later(boom),
    "next": lambda desk: desk.app.editor.front.call_next(boom),
    "timer": lambda desk: desk.app.main_screen.set_timer(0.02, boom),
    "worker": lambda desk: desk.app.run_worker(worker()),
    "thread": lambda desk: desk.app.in_background(boom),
    "compose": lambda desk: desk.app.command.mount(Unmountable()),
    "render": in_render,
    "layout": in_layout,
}


@pytest.mark.parametrize("place", PLACES)
async def test_the_desktop_outlives_a_fault(program, place: str):
    async with desktop(program("x = 1\n")) as desk:
        app, area = desk.app, desk.app.editor.front
        area.focus()
        await desk.press("y")
        inject: Callable[[Desktop], object] = PLACES[place]
        inject(desk)
        await desk.until(lambda: app._exception_event.clear() or "internal error" in desk.output)
        app._exception = None
        assert app.is_running
        log = paths.state_folder() / "faults.log"
        assert "Boom: injected" in log.read_text()
        assert str(log) in desk.output.replace("\n", "")
        assert "yx = 1" in recovery.recovery_file().read_text()
        area.focus()
        area.insert("z")
        app._exception_event.clear()
        await desk.until(lambda: "yzx = 1" in area.text and app.is_running)
        app.set_focus(app.command.prompt)
        app.command.prompt.insert_text_at_cursor("q")
        app._exception_event.clear()
        assert app.command.prompt.value == "q"
        app._exception = None


async def test_a_widget_that_cannot_be_drawn_says_so_once_and_is_drawn_when_it_can(program):
    async with desktop(program("x = 1\n")) as desk:
        app, area = desk.app, desk.app.editor.front
        in_render(desk)
        for _ in range(5):
            area.refresh(layout=True)
            await desk.pilot.pause(0.05)
        shown = "\n".join(str(strip.text) for strip in app.screen._compositor.render_strips())
        assert fault_barrier.FAILED[:20] in shown
        assert desk.output.count("internal error") == 1
        del area.render_line
        area.refresh(layout=True)
        await desk.pilot.pause()
        shown = "\n".join(str(strip.text) for strip in app.screen._compositor.render_strips())
        assert "x = 1" in shown


async def endless(desk: Desktop) -> None:
    app = desk.app
    app.editor.front.focus()
    await desk.press("y")

    def again() -> None:
        if app.return_code != 1:
            app.call_later(again)
            boom()

    app.call_later(again)
    while app.return_code != 1:  # noqa: ASYNC110 - an app that ends tells nobody
        await asyncio.sleep(0.01)
    app._exception = None
    assert len(app._exit_renderables) == 1
    assert "Unsaved work is kept in" in str(app._exit_renderables[0])
    assert "yx = 1" in recovery.recovery_file().read_text()


async def test_faults_without_end_end_the_desktop_with_the_work_kept(program):
    async with desktop(program("x = 1\n")) as desk:
        await endless(desk)
        assert desk.app.return_code == 1


@pytest.mark.parametrize("fault", [SystemExit, KeyboardInterrupt, ValueError])
async def test_the_engines_thread_outlives_whatever_a_job_raises(program, fault):
    async with desktop(program("x = 1\nwrite x\n")) as desk:

        def fails():
            raise fault("injected")

        desk.app.engine.submit(fails)
        await desk.idle()
        assert fault.__name__ in desk.output
        await desk.line("write 6*7")
        await desk.until(lambda: "42" in desk.output)


async def test_a_dead_engine_thread_is_reported_and_followed_by_another(program, monkeypatch):
    ended_by = []
    monkeypatch.setattr(threading, "excepthook", lambda end: ended_by.append(end.exc_type))
    async with desktop(program("x = 1\n")) as desk:
        engine = desk.app.engine
        post = engine._post

        def fails(message):
            raise SystemExit

        monkeypatch.setattr(engine, "_post", fails)  # not even a report gets out
        engine.submit(lambda: None)
        dead = engine._thread
        dead.join(120)
        assert not dead.is_alive()
        assert ended_by == [SystemExit]
        monkeypatch.setattr(engine, "_post", post)
        await desk.line("write 6*7")
        await desk.until(lambda: "42" in desk.output)
        assert "thread had ended" in desk.output
