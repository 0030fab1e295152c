"""Whoever leaves the desktop waits for nothing: no compiler, no tick of a clock, nothing that Python clears up."""

from __future__ import annotations

import sys
import threading
from typing import TYPE_CHECKING

import pexpect
import pytest

from desire_tui.desktop.engine_thread import EngineThread
from desire_tui.desktop.screen_listener import ScreenListener
from tests.app.conftest import OSCILLATOR, desktop
from tests.app.test_terminal import CTRL_Q, PATIENCE_S, Terminal, assert_restored

if TYPE_CHECKING:
    from pathlib import Path

OF_DESKTOPS = {"desire-engine", "desire-check"}
"""Threads."""
SHIFT_F10 = "\x1b[21;2~"
"""Ends the run."""
EQUATIONS = "\n".join(f"d/dt x{k} = {k}*x - x{k}" for k in range(400))
PROGRAM = f"TMAX = 1 | DT = 0.1 | NN = 11 | x = 1\ndrun\nDYNAMIC\nd/dt x = -x\n{EQUATIONS}\ndispt x\n"
WITH_ENDLESS_WORK = """
import atexit, threading
for_ever = threading.Event().wait
from desire_tui.desktop import terminal_driver
terminal_driver._TICK_S = 1000.0
from desire_tui.engine.codegen.jit import compiler
translate = compiler._object_file
def endless(*args, **how):
    begun = len(str(args[0])) > 20_000
    open("compiling", "a").close() if begun else None
    return for_ever() if begun else translate(*args, **how)
compiler._object_file = endless
atexit.register(for_ever)
from desire_tui.__main__ import main
main(["long.src"])
"""


@pytest.mark.parametrize("typed", [SHIFT_F10, "bye\r", CTRL_Q])
def test_nothing_keeps_whoever_leaves(tmp_path: Path, typed: str):
    (tmp_path / "long.src").write_text(PROGRAM)
    (tmp_path / "start.py").write_text(WITH_ENDLESS_WORK)
    screen = Terminal(tmp_path, shell=(sys.executable, str(tmp_path / "start.py")))
    try:
        screen.until(lambda: "long.src" in screen.text and "F5" in screen.text)
        screen.send("zz\r")
        screen.until((tmp_path / "compiling").exists)
        screen.send(typed)
        if typed == SHIFT_F10:
            screen.until(lambda: "ended" in screen.text)
            screen.send("quit\r")
        screen.child.expect(pexpect.EOF, timeout=PATIENCE_S)
        screen.raw += screen.child.before or b""
        screen.child.wait()
        assert screen.child.exitstatus == 0
        assert_restored(bytes(screen.raw))
        assert (tmp_path / "state" / "desire-tui" / "session.json").exists()
    finally:
        screen.child.close(force=True)


def test_what_was_ended_gets_a_moment_to_write_its_files(monkeypatch: pytest.MonkeyPatch):
    from desire_tui.desktop import engine_thread

    monkeypatch.setattr(engine_thread, "SETTLE_S", PATIENCE_S)
    ready, idle = threading.Event(), threading.Event()

    def post(message: object) -> None:
        (ready if type(message).__name__ == "EngineReady" else idle).set()

    engine = EngineThread(ScreenListener(post), post)
    engine.start()
    assert ready.wait(PATIENCE_S)
    engine.settle()  # nothing goes on
    ended, written = threading.Event(), []

    def job() -> None:
        ended.wait(PATIENCE_S)
        written.append("the last row")

    engine.submit(job)
    threading.Timer(0, ended.set).start()
    engine.settle()
    assert written == ["the last row"]


async def test_in_a_process_that_goes_on_nothing_of_a_desktop_is_left(program):
    """Neither threads nor, with them, all its widgets; what waited is still done."""
    before = set(threading.enumerate())
    done: list[bool] = []
    async with desktop(program(OSCILLATOR)) as desk:
        await desk.until(lambda: not desk.app.engine.is_busy)
        desk.app.engine.submit(lambda: done.append(True))
        own = {thread for thread in set(threading.enumerate()) - before if thread.name in OF_DESKTOPS}
        assert {thread.name for thread in own} == OF_DESKTOPS
    for thread in own:
        thread.join(120)
    assert not any(thread.is_alive() for thread in own)
    assert done == [True]
