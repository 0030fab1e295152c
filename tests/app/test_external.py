"""The user's own editor: $VISUAL, $EDITOR, and everything that can go wrong with it."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
from typing import TYPE_CHECKING

import pytest

from desire_tui.editor import external_editor

from .conftest import desktop
from .test_terminal import CTRL_L, CTRL_S, Terminal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path


async def notified(desk, words: str) -> None:
    await desk.until(lambda: any(words in note.message for note in desk.app._notifications))


@pytest.mark.parametrize("editor", ["no-such-editor-here", "'unbalanced", "''"])
async def test_a_missing_editor_is_told(program, monkeypatch, editor: str):
    monkeypatch.setenv("EDITOR", editor)
    async with desktop(program("x = 1\n")) as desk:
        await desk.line("external")
        await notified(desk, "set $EDITOR")
        assert desk.app.editor.front.text == "x = 1\n"


async def test_a_terminal_that_cannot_be_handed_over_is_told(program, monkeypatch):
    monkeypatch.setenv("EDITOR", "cat")
    async with desktop(program("x = 1\n")) as desk:
        await desk.line("external")
        await notified(desk, "cannot be handed")


def test_an_editor_whose_terminal_has_gone_is_ended(monkeypatch):
    monkeypatch.setattr(external_editor, "_LOOK_S", 0.01)
    monkeypatch.setattr(external_editor, "_END_S", 0.01)
    screen, terminal = pty.openpty()
    editor = subprocess.Popen(["sh", "-c", "trap '' HUP; sleep 100"])
    os.close(screen)
    assert external_editor._waited_for(editor, terminal) in {-signal.SIGHUP, -signal.SIGKILL}
    os.close(terminal)


# ------------------------------------------------------------------------------------------ the real terminal


@pytest.fixture
def edited_by(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str], Terminal]]:
    """Start Desire on `a.src` with a shell script as $EDITOR, and hand the program to it."""
    opened: list[Terminal] = []

    def start(script: str) -> Terminal:
        editor = tmp_path / "my editor"
        editor.write_text(script)
        editor.chmod(0o755)
        monkeypatch.setenv("EDITOR", f"'{editor}' --wait")
        (tmp_path / "a.src").write_text("x = 1\ny = 2\n")
        screen = Terminal(tmp_path, "a.src")
        opened.append(screen)
        screen.until(lambda: "y = 2" in screen.text and "F5" in screen.text)
        screen.read(0.3)
        screen.send("\x1be" + "z = 3\r")  # Alt+E: the editor; work that is not saved
        screen.until(lambda: "z = 3" in screen.text)
        screen.send(CTRL_L + "external\r")
        return screen

    yield start
    for one in opened:
        one.child.close(force=True)


def test_the_editor_gets_the_unsaved_text_and_gives_its_own_back(edited_by, tmp_path: Path):
    screen = edited_by(
        '#!/bin/sh\n[ "$1" = --wait ] || exit 9\ncp "$2" seen.txt\necho "$2" > name.txt\necho w = 4 >> "$2"\n'
    )
    screen.until(lambda: "w = 4" in screen.text)
    assert (tmp_path / "seen.txt").read_text() == "z = 3\nx = 1\ny = 2\n"
    assert (tmp_path / "name.txt").read_text().endswith("/a.src\n")
    assert (tmp_path / "a.src").read_text() == "x = 1\ny = 2\n"  # not written behind the user's back
    screen.send("\x1be\x1a" + CTRL_S)  # undo takes all of the editor's changes back
    screen.until(lambda: (tmp_path / "a.src").read_text() == "z = 3\nx = 1\ny = 2\n")


@pytest.mark.parametrize(
    "failures",
    [
        {
            '#!/bin/sh\necho lost >> "$2"\nexit 3\n': "ended with status 3",
            '#!/bin/sh\nrm "$2"\n': "No such file",
        },
        {"#!/bin/sh\nkill -KILL $$\n": "ended by signal 9", "#!/no/such/interpreter\n": "No such file"},
    ],
)
def test_an_editor_that_fails_changes_nothing(edited_by, tmp_path: Path, failures: dict[str, str]):
    screen = edited_by(next(iter(failures)))
    for number, (script, told) in enumerate(failures.items(), 1):
        if number > 1:
            (tmp_path / "my editor").write_text(script)
            screen.send(CTRL_L + "external\r")
        screen.until(lambda told=told: told.replace(" ", "") in "".join(screen.text.split()))
        screen.send("\x1be!" + CTRL_S)  # the desktop works on
        saved = f"z = 3\n{'!' * number}x = 1\ny = 2\n"
        screen.until(lambda saved=saved: (tmp_path / "a.src").read_text() == saved)


def test_an_interrupt_in_the_editor_is_the_editors(edited_by, tmp_path: Path):
    screen = edited_by(
        '#!/bin/sh\ntrap "echo interrupted = 1 >> \\"$2\\"; exit 0" INT\necho waiting\nwhile :; do sleep 0.1; done\n'
    )
    screen.until(lambda: "waiting" in screen.text)
    screen.read(0.3)
    screen.send("\x03")
    screen.until(lambda: "interrupted = 1" in screen.text)
    screen.send("\x1be!" + CTRL_S)
    screen.until(lambda: "interrupted = 1" in (tmp_path / "a.src").read_text())
