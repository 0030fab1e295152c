"""Opening and saving: the name field, type-ahead, files opened last."""

from __future__ import annotations

from textual.widgets import Input

from desire_tui.common.file_dialog import FileDialog, FileList
from desire_tui.common.recent_files import KEPT, note_recent, recent_files

from .conftest import Desktop, desktop


async def opened(desk: Desktop, key: str) -> FileDialog:
    await desk.press(key)
    await desk.until(lambda: isinstance(desk.app.screen, FileDialog) and desk.app.screen.focused)
    dialog = desk.app.screen
    assert isinstance(dialog, FileDialog)
    await loaded(desk, dialog)
    return dialog


async def loaded(desk: Desktop, dialog: FileDialog) -> None:
    """Wait until the folder was read."""
    files = dialog.query_one(FileList)
    await desk.until(lambda: all(worker.is_finished for worker in desk.app.workers if worker.node is files))


def shown(dialog: FileDialog) -> list[str]:
    return [path.name for path in dialog.query_one(FileList).paths]


async def test_a_new_program_is_saved_under_the_name_typed_at_once(tmp_path):
    async with desktop() as desk:
        await desk.do("file.new")
        await desk.press("x", "=", "1")
        dialog = await opened(desk, "ctrl+s")
        field = dialog.query_one(Input)
        assert dialog.focused is field
        assert field.selected_text == "untitled-1"  # the ending stays
        await desk.press(*"pendulum", "enter")
        await desk.until(lambda: desk.app.screen is desk.app.main_screen)
        assert (tmp_path / "pendulum.src").read_text() == "x=1"
        assert desk.app.editor.front.buffer.name == "pendulum.src"


async def test_entries_have_signs_that_every_terminal_shows_alike(program, tmp_path):
    program("x = 1\n", "models/a.src")
    program("x = 1\n", "b.src")
    (tmp_path / "c.src").symlink_to(tmp_path / "b.src")
    async with desktop(tmp_path / "b.src", size=(100, 30)) as desk:
        dialog = await opened(desk, "ctrl+o")
        files = dialog.query_one(FileList)
        await desk.until(lambda: {"models", "c.src"} <= set(shown(dialog)))
        text = "\n".join(files.render_line(y).text for y in range(files.size.height))
        assert "▸  models" in text
        assert "c.src →" in text
        assert all(ord(character) < 0x1F000 for character in text)


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
        assert shown(dialog) == ["rotor.src", "..", "models", "alpha.src", "torpedo.src"]
        await desk.press("t", "o")
        assert shown(dialog) == ["rotor.src", "..", "torpedo.src"]
        await desk.press("r", "p", "enter")
        await desk.until(lambda: desk.app.editor.front.buffer.name == "torpedo.src")
        dialog = await opened(desk, "ctrl+o")
        assert shown(dialog)[:2] == ["torpedo.src", "rotor.src"]
        await desk.press("n", "o", "t")
        assert shown(dialog) == ["..", "notes.md"]
        await desk.press("ctrl+u", "m", "o", "tab")
        await loaded(desk, dialog)
        assert shown(dialog) == ["..", "pilot.src"]
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


async def test_the_arrows_choose_from_the_name(program):
    program("x = 1\n", "a.src")
    program("x = 2\n", "b.src")
    async with desktop(program("x = 3\n", "c.src")) as desk:
        await opened(desk, "ctrl+o")
        await desk.press("down", "up", "up", "enter")  # up from the first entry is the last
        await desk.until(lambda: desk.app.editor.front.buffer.name == "b.src")
        await desk.do("file.new")
        await desk.press("x")
        dialog = await opened(desk, "ctrl+s")
        await desk.press("down", "enter")  # from a.src
        await desk.until(lambda: dialog.query_one(Input).value == "b.src")
        assert desk.app.screen is dialog  # a second Enter saves


async def test_a_name_too_long_leaves_the_dialog_open(program):
    async with desktop(program("x = 1\n")) as desk:
        for key in ("ctrl+o", "ctrl+shift+s"):
            dialog = await opened(desk, key)
            dialog.query_one(Input).value = "é" * 200
            await desk.press("enter")
            assert desk.app.screen is dialog
            await desk.press("escape")
            await desk.until(lambda: desk.app.screen is desk.app.main_screen)


async def test_the_folder_may_be_gone(program, tmp_path):
    async with desktop(program("x = 1\n", "gone/a.src")) as desk:
        (tmp_path / "gone" / "a.src").unlink()
        (tmp_path / "gone").rmdir()
        program("x = 2\n", "b.src")
        assert "b.src" in shown(await opened(desk, "ctrl+o"))


async def test_control_characters_of_names_are_shown_in_their_line(program):
    program("x = 1\n", "a\nb\x1b]0;c.src")
    async with desktop(program("x = 1\n")) as desk:
        files = (await opened(desk, "ctrl+o")).query_one(FileList)
        assert "    a␊b␛]0;c.src" in [str(option.prompt) for option in files.options]


def test_the_list_of_recent_files_forgets_the_oldest_and_the_missing(tmp_path):
    paths = [tmp_path / f"{n}.src" for n in range(KEPT + 5)]
    for path in paths:
        path.write_text("")
        note_recent(path)
    assert recent_files() == paths[: -KEPT - 1 : -1]
    paths[-1].unlink()
    assert recent_files()[0] == paths[-2]


async def test_hidden_files_come_with_a_dot(program):
    program("x = 1\n", ".hidden.src")
    async with desktop(program("x = 2\n", "seen.src")) as desk:
        dialog = await opened(desk, "ctrl+o")
        assert ".hidden.src" not in shown(dialog)
        await desk.press(".", "h")
        assert ".hidden.src" in shown(dialog)
