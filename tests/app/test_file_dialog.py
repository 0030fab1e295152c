"""Opening and saving: the name field, type-ahead, files opened last."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.widgets import Input, OptionList

from desire_tui.common.file_dialog import FileDialog
from desire_tui.common.file_listing import listed
from desire_tui.common.recent_files import KEPT, note_recent, recent_files

from .conftest import Desktop, desktop

if TYPE_CHECKING:
    from pathlib import Path


async def opened(desk: Desktop, key: str) -> FileDialog:
    await desk.press(key)
    await desk.until(lambda: isinstance(desk.app.screen, FileDialog) and desk.app.screen.focused)
    dialog = desk.app.screen
    assert isinstance(dialog, FileDialog)
    return dialog


def shown(dialog: FileDialog) -> list[str]:
    options = dialog.query_one(OptionList)
    return [str(options.get_option_at_index(n).prompt) for n in range(options.option_count)]


async def test_a_new_program_is_saved_under_the_name_typed_at_once(tmp_path):
    async with desktop() as desk:
        await desk.do("file.new")
        await desk.press("x", "=", "1")
        dialog = await opened(desk, "ctrl+s")
        field = dialog.query_one("#file-name", Input)
        assert dialog.focused is field
        assert field.selected_text == "untitled-1"  # the ending stays
        await desk.press(*"pendulum", "enter")
        await desk.until(lambda: desk.app.screen is desk.app.main_screen)
        assert (tmp_path / "pendulum.src").read_text() == "x=1"
        assert desk.app.editor.front.buffer.name == "pendulum.src"


async def test_a_name_without_ending_gets_that_of_programs(tmp_path):
    async with desktop() as desk:
        await desk.do("file.new")
        await desk.press("x")
        await opened(desk, "ctrl+s")
        await desk.press("ctrl+u", "ctrl+k", "a", "enter")
        await desk.until((tmp_path / "a.src").exists)


async def test_open_lists_what_was_open_last_and_follows_what_is_typed(program, tmp_path):
    folder = tmp_path / "programs"
    for name in ("alpha.src", "torpedo.src", "notes.md", "rotor.src"):
        program("x = 1\n", f"programs/{name}")
    program("y = 2\n", "programs/models/pilot.src")
    async with desktop(folder / "rotor.src") as desk:
        dialog = await opened(desk, "ctrl+o")
        assert shown(dialog) == ["rotor.src  · recent", "../", "models/", "alpha.src", "torpedo.src"]
        await desk.press("t", "o")
        assert shown(dialog) == ["rotor.src  · recent", "torpedo.src"]
        await desk.press("r", "p", "enter")
        await desk.until(lambda: desk.app.editor.front.buffer.name == "torpedo.src")
        dialog = await opened(desk, "ctrl+o")
        assert shown(dialog)[:2] == ["torpedo.src  · recent", "rotor.src  · recent"]
        await desk.press("n", "o", "t")
        assert shown(dialog) == ["notes.md"]
        await desk.press("ctrl+u", "m", "o", "tab")
        assert shown(dialog) == ["../", "pilot.src"]
        await desk.press("p", "enter")
        await desk.until(lambda: desk.app.editor.front.buffer.name == "pilot.src")


async def test_a_whole_name_typed_counts_more_than_the_first_of_the_list(program, tmp_path):
    program("x = 1\n", "b-a.src")
    program("x = 2\n", "a.src")
    async with desktop(tmp_path / "b-a.src") as desk:
        await opened(desk, "ctrl+o")
        await desk.press(*"a.src", "enter")
        await desk.until(lambda: desk.app.editor.front.buffer.name == "a.src")


async def test_a_file_that_is_not_there_leaves_the_dialog_open(program):
    async with desktop(program("x = 1\n")) as desk:
        dialog = await opened(desk, "ctrl+o")
        await desk.press(*"nowhere", "enter")
        assert desk.app.screen is dialog
        await desk.press("escape")
        await desk.until(lambda: desk.app.screen is desk.app.main_screen)


def test_the_list_of_recent_files_forgets_the_oldest_and_the_missing(tmp_path):
    paths = [tmp_path / f"{n}.src" for n in range(KEPT + 5)]
    for path in paths:
        path.write_text("")
        note_recent(path)
    assert recent_files() == paths[: -KEPT - 1 : -1]
    paths[-1].unlink()
    assert recent_files()[0] == paths[-2]


def test_hidden_files_come_with_a_dot(tmp_path: Path):
    (tmp_path / ".hidden.src").write_text("")
    (tmp_path / "seen.src").write_text("")
    names = [entry.label for entry in listed(tmp_path, "", (), (".src",))]
    assert names == ["../", "seen.src"]
    assert [entry.label for entry in listed(tmp_path, ".h", (), (".src",))] == [".hidden.src"]
