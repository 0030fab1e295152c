"""A stranger's file in the real program: none of its control characters reaches the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.editor.recovery import SavedTab, store

from .conftest import desktop
from .test_safety import dead_pid
from .test_terminal import CTRL_L, CTRL_N, CTRL_Q, CTRL_S, F5, Terminal, terminal

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

__all__ = ["terminal"]  # a fixture

EVIL = "\x1b]0;PWNED\x07\x1b]52;c;UFdORUQ=\x07\x9bPWNED\u202ePWNED\u200b[red]\x9c"
NAME = EVIL.replace("/", "") + ".src"
PROGRAM = f"""\
-- comment {EVIL}
write '{EVIL}'
note '{EVIL}'
write misspelt; '{EVIL}'
"""
FORBIDDEN = ("\x1b]0;", "\x1b]52", "PWNED\x07", "=\x07", "\x9b", "\x9c", "\u202e", "\u200b")


def assert_harmless(screen: Terminal) -> None:
    sent = bytes(screen.raw).decode(errors="replace")
    assert [sequence for sequence in FORBIDDEN if sequence in sent] == []


def test_a_hostile_file_opened_run_and_offered_again(
    terminal: Callable[..., Terminal], tmp_path: Path
) -> None:
    (tmp_path / NAME).write_text(PROGRAM)
    screen = terminal(NAME)
    screen.until(lambda: "comment ␛]0;PWNED␇" in screen.text)
    screen.send(F5)
    screen.until(lambda: "misspelt" in screen.text.partition("comment")[2].partition("write misspelt")[2])
    screen.send(CTRL_Q)
    screen.read(0.5)
    assert "PWNED" in screen.text
    assert_harmless(screen)


def test_hostile_names_in_dialogs_and_hostile_text_that_is_pasted(
    terminal: Callable[..., Terminal], tmp_path: Path
) -> None:
    (tmp_path / NAME).write_text(PROGRAM)
    (tmp_path / "a.src").write_text("input a\nwrite a\n")
    store(tmp_path / "state" / "desire-tui" / f"recovery-{dead_pid()}.json", [SavedTab(None, EVIL, EVIL)])
    screen = terminal("a.src")
    screen.until(lambda: "Unsaved work found" in screen.text and "PWNED" in screen.text)
    screen.read(1.5)  # a question that comes up by itself takes no answer at first
    screen.send("r")
    screen.until(lambda: "Unsaved work found" not in screen.text)
    screen.send(CTRL_S)  # a tab without a file: the dialog shows the folder
    screen.until(lambda: "a.src" in screen.text and "Save as" in screen.text)
    screen.read(0.5)
    screen.send("\x1b")
    screen.until(lambda: "Save as" not in screen.text)
    pasted = f"\x1b[200~-- {EVIL.replace(chr(27), '')}\x1b[201~"
    screen.send(CTRL_N + pasted)
    screen.until(lambda: "UFdORUQ=␇" in screen.text)
    screen.send(CTRL_L + pasted)
    screen.read(0.5)
    assert_harmless(screen)


async def test_the_cursor_stands_where_its_character_is_drawn(program):
    line = "\x1b\x07\u202e\x9bab\tc"
    async with desktop(program(f"{line}\nabcdefghijkl\n")) as desk:
        area = desk.app.editor.front
        text = str(area.get_line(0))
        assert text == "␛␇��ab\tc"
        shown = [area.get_column_width(0, column) for column in range(len(line) + 1)]
        assert shown[:7] == [0, 1, 2, 3, 4, 5, 6]
        for column in range(len(line)):
            area.move_cursor((0, column))
            area.record_cursor_width()
            assert area.wrapped_document.location_to_offset((0, column)).x == shown[column]
            assert area.cell_width_to_column_index(shown[column], 0) == column
        strip = area.render_line(0)
        assert "␛␇��ab" in strip.text
        area.move_cursor((0, 4))
        area.action_cursor_down()
        assert area.cursor_location == (1, 4)
