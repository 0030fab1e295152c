"""A file that is opened, edited and saved differs in what was edited, and in nothing else."""

from __future__ import annotations

import os

import pytest

from desire_tui.editor import recovery
from desire_tui.editor.recovery import SavedTab

from .conftest import desktop
from .test_safety import dead_pid

MIXED = b"-- a\r\nx = 1\ny = 2\rz = 3\r\n\nw = 4"


def open_file(tmp_path, data, name="a.src"):
    path = tmp_path / name
    path.write_bytes(data)
    return path


async def typed_and_saved(desk, *keys):
    desk.app.editor.front.focus()
    await desk.press(*keys)
    await desk.press("ctrl+s")
    await desk.until(lambda: not desk.app.editor.front.is_dirty)


SHAPES = (
    (b"-- a\nx = 1\n", ""),
    (b"-- a\nx = 1", ""),
    (b"\xef\xbb\xbf-- a\nx = 1\n", "UTF-8 BOM"),
    (b"-- caf\xe9\r\nx = 1\r\n", "Latin-1 CRLF"),
    (b"-- \x93caf\xe9\x94\rx = 1\r", "Windows-1252 CR"),
    (b"\xff\xfe" + "-- ∞\nx = 1\n".encode("utf-16-le"), "UTF-16 LE"),
    (MIXED, "mixed ends"),
)


async def test_only_what_was_typed_changes(tmp_path):
    files = {open_file(tmp_path, data, f"{number}.src"): shape for number, (data, shape) in enumerate(SHAPES)}
    async with desktop() as desk:
        for path, shape in files.items():
            await desk.do("file.open", path.name)
            await desk.until(lambda path=path: desk.app.editor.front.buffer.path == path)
            data = path.read_bytes()
            await typed_and_saved(desk, "x", "ctrl+z", "y", "backspace", "ctrl+s")
            assert path.read_bytes() == data
            place = desk.app.editor.query_one("#place")
            assert str(place.content).removesuffix("1:1").strip() == shape
            await typed_and_saved(desk, "down", "end", "0")
            one, ten = ("x = 1", "x = 10")
            codec = "utf-16-le" if shape == "UTF-16 LE" else "ascii"
            assert path.read_bytes() == data.replace(one.encode(codec), ten.encode(codec))


async def test_whole_lines_keep_their_ends_under_every_command(tmp_path):
    path = open_file(tmp_path, MIXED)
    async with desktop(path) as desk:
        await typed_and_saved(desk, "ctrl+a", "ctrl+slash")
        lines = path.read_bytes()
        assert [line.endswith(b"\r\n") for line in lines.splitlines(keepends=True)] == [
            line.endswith(b"\r\n") for line in MIXED.splitlines(keepends=True)
        ]
        await typed_and_saved(desk, "ctrl+z")
        assert path.read_bytes() == MIXED
        area = desk.app.editor.front
        area.go_to(1)
        await typed_and_saved(desk, "alt+shift+down")
        assert path.read_bytes() == MIXED.replace(b"x = 1\ny = 2\r", b"y = 2\rx = 1\n")
        await typed_and_saved(desk, "alt+shift+up")
        assert path.read_bytes() == MIXED
        await typed_and_saved(desk, "ctrl+d")
        assert path.read_bytes() == MIXED.replace(b"x = 1\n", b"x = 1\nx = 1\n")
        await typed_and_saved(desk, "ctrl+z")
        assert path.read_bytes() == MIXED


async def test_numbered_lines_and_copies_keep_encoding_and_ends(tmp_path):
    path = open_file(tmp_path, b"-- caf\xe9\r\nx = 1\ry = 2\r\n")
    async with desktop(path) as desk:
        await desk.line("keep+ 'num'")
        await desk.until((tmp_path / "num.src").exists)
        assert (tmp_path / "num.src").read_bytes() == b"210 -- caf\xe9\r\n220 x = 1\r230 y = 2\r\n"
        for command, expected in (("ed", path.read_bytes()), ("edit", (tmp_path / "num.src").read_bytes())):
            await desk.line(command)
            await desk.until(lambda: desk.app.editor.front.buffer.path is None)
            await desk.line(f"keep '{command}'")
            await desk.until((tmp_path / f"{command}.src").exists)
            assert (tmp_path / f"{command}.src").read_bytes() == expected


async def test_a_link_stays_a_link_and_all_names_show_the_text(tmp_path):
    path = open_file(tmp_path, b"x = 1\n", "target.src")
    path.chmod(0o750)
    link, other = tmp_path / "link.src", tmp_path / "other.src"
    link.symlink_to("target.src")
    os.link(path, other)
    async with desktop(link) as desk:
        await typed_and_saved(desk, "y")
    assert link.is_symlink()
    assert link.read_text() == other.read_text() == path.read_text() == "yx = 1\n"
    assert path.stat().st_mode & 0o7777 == 0o750


async def test_a_character_that_the_encoding_lacks_is_asked_about(tmp_path):
    path = open_file(tmp_path, data := b"-- caf\xe9\r\n")
    async with desktop(path) as desk:
        area = desk.app.editor.front
        area.insert("∞", (0, 3))
        await desk.press("ctrl+s")
        await desk.until(lambda: len(desk.app.screen_stack) > 1)
        await desk.press("escape")
        assert path.read_bytes() == data
        assert area.is_dirty
        await desk.press("ctrl+s")
        await desk.until(lambda: len(desk.app.screen_stack) > 1)
        sentence = str(desk.app.screen.query("Label").first().content)
        assert "Line 1, column 4 is ∞" in sentence
        assert "Latin-1" in sentence
        await desk.press("u")
        await desk.until(lambda: not area.is_dirty)
        assert path.read_bytes() == "-- ∞café\r\n".encode()
        assert area.buffer.shape == "CRLF"


async def test_text_that_would_be_read_as_another_is_asked_about(tmp_path):
    path = open_file(tmp_path, data := b"-- caf\xe9\n")
    async with desktop(path) as desk:
        area = desk.app.editor.front
        area.replace("Ã©", (0, 6), (0, 7))
        await desk.press("ctrl+s")
        await desk.until(lambda: len(desk.app.screen_stack) > 1)
        assert path.read_bytes() == data
        await desk.press("u")
        await desk.until(lambda: not area.is_dirty)
        assert path.read_bytes().decode() == "-- cafÃ©\n"


@pytest.mark.parametrize("character", ["\0", "\ud800"])
async def test_what_no_text_has_is_refused_with_its_place(tmp_path, character):
    path = open_file(tmp_path, b"x = 1\ny = 2\n")
    async with desktop(path) as desk:
        desk.app.editor.front.insert(character, (1, 2))
        await desk.press("ctrl+s")
        await desk.until(lambda: "error 106" in desk.output)
        assert "Line 2, column 3" in desk.output
        assert path.read_bytes() == b"x = 1\ny = 2\n"


async def test_recovered_work_keeps_encoding_ends_and_the_question_about_changes(tmp_path):
    path, gone = open_file(tmp_path, b"-- caf\xe9\r\nx = 1\n"), tmp_path / "gone.src"
    async with desktop(path) as desk:
        desk.app.editor.front.insert("0", (1, 5))
        desk.app.checkpoint()
        (tab,) = recovery.read(recovery.recovery_file())
        assert (tab.text, tab.encoding) == ("-- café\r\nx = 10\n", "Latin-1")
        assert tab.stamp == path.stat().st_mtime
    file = recovery.state_folder() / f"recovery-{dead_pid()}.json"
    missing = SavedTab(str(gone), "gone.src", "-- é\r", encoding="Latin-1")
    recovery.store(file, [tab, missing])
    os.utime(path, (1, 1))
    async with desktop() as desk:
        await desk.until(lambda: len(desk.app.screen_stack) > 1)
        await desk.press("r")
        await desk.until(lambda: not file.exists())
        first, second = desk.app.editor.areas[-2:]
        assert first.buffer.shape == "Latin-1 mixed ends"
        desk.app.editor.show(second)
        await desk.press("ctrl+s")
        await desk.until(gone.exists)
        assert gone.read_bytes() == b"-- \xe9\r"
        desk.app.editor.show(first)
        await desk.press("ctrl+s")
        await desk.until(lambda: len(desk.app.screen_stack) > 1)  # it was changed meanwhile
        await desk.press("o")
        await desk.until(lambda: not first.is_dirty)
        assert path.read_bytes() == b"-- caf\xe9\r\nx = 10\n"


@pytest.mark.parametrize("tab", ['"encoding": "EBCDIC"', '"encoding": []', '"stamp": "x"'])
def test_recovery_files_with_wrong_facts_are_damaged(tmp_path, tab):
    file = tmp_path / "r.json"
    file.write_text(f'{{"version": 1, "tabs": [{{"path": null, "label": "a", "text": "x", {tab}}}]}}')
    with pytest.raises(ValueError, match="damaged"):
        recovery.read(file)


async def test_a_file_read_again_brings_its_encoding_and_ends(tmp_path):
    path = open_file(tmp_path, b"-- caf\xe9\r\nx = 1\n")
    async with desktop(path) as desk:
        path.write_bytes("-- café\nx = 1\r\n".encode())
        os.utime(path, (1, 1))
        desk.app.file_actions.save_and_reload.notice_changes()
        assert desk.app.editor.front.buffer.shape == "mixed ends"
        await typed_and_saved(desk, "y")
        assert path.read_bytes() == "y-- café\nx = 1\r\n".encode()


async def test_pipes_and_devices_are_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.src")
    async with desktop() as desk:
        await desk.line("load 'pipe.src'")
        await desk.until(lambda: "not an ordinary file" in desk.output)
