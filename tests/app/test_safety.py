"""Configuration, recovery, session, sizes, themes."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from desire_tui.common import config, paths, themes
from desire_tui.common.key_names import key_names
from desire_tui.desktop.tour_note import TourNote
from desire_tui.editor import recovery
from desire_tui.editor.recovery import SavedTab
from desire_tui.panes.command_history import CommandHistory
from desire_tui.panes.run_summary import speed

from .conftest import OSCILLATOR, desktop


def written(text: str) -> tuple[config.Config, list[str]]:
    path = paths.config_file()
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return config.load()


def test_no_configuration_means_the_defaults():
    assert config.load() == (config.Config(), [])


def test_the_defaults_file_means_the_defaults():
    assert written(config.defaults_text()) == (config.Config(), [])


def test_a_wrong_configuration_names_file_key_and_nearest_key():
    settings, wrong = written(
        'them = "light"\nframes_per_second = 500\n[keys]\n"run.strat" = "f9"\n"run.pause" = 3\n'
    )
    assert settings == config.Config()
    assert all(str(paths.config_file()) in sentence for sentence in wrong)
    assert "'them'" in wrong[0]
    assert "did you mean 'theme'?" in wrong[0]
    assert "1 … 60" in wrong[1]
    assert "did you mean 'run.start'?" in wrong[2]
    assert "run.pause" in wrong[3]


def test_an_unreadable_configuration_is_told_and_the_defaults_are_used():
    settings, wrong = written("theme = \n")
    assert settings == config.Config()
    assert "the defaults are used" in wrong[0]


async def test_the_desktop_tells_what_is_wrong_with_the_configuration(program):
    written('theme = "pink"\nfoo = 1\n')
    async with desktop(program("x = 1\n")) as desk:
        assert "no theme 'pink'" in desk.output
        assert "unknown key 'foo'" in desk.output


def dead_pid() -> int:
    done = subprocess.Popen([sys.executable, "-c", ""])
    done.wait()
    return done.pid


async def test_unsaved_work_of_a_dead_session_is_offered(program):
    file = paths.state_folder() / f"recovery-{dead_pid()}.json"
    recovery.store(file, [SavedTab(None, "untitled-1", "lost = 1\n", front=True)])
    async with desktop(program("x = 1\n")) as desk:
        await desk.until(lambda: len(desk.app.screen_stack) > 1)
        await desk.press("r")
        await desk.until(lambda: any("lost" in area.text for area in desk.app.editor.areas))
        await desk.until(lambda: not file.exists())
        own = recovery.recovery_file()
        assert "lost = 1" in own.read_text()
        area = next(area for area in desk.app.editor.areas if "lost" in area.text)
        assert area.is_dirty


async def test_recovery_files_of_living_sessions_are_left_alone(program):
    file = paths.state_folder() / f"recovery-{os.getppid()}.json"
    recovery.store(file, [SavedTab(None, "u", "theirs = 1\n")])
    async with desktop(program("x = 1\n")) as desk:
        await desk.pilot.pause(0.2)
        assert len(desk.app.screen_stack) == 1
        assert file.exists()


@pytest.mark.parametrize(
    "text", ["{", "[]", json.dumps({"version": 99, "tabs": []}), '{"version": 1, "tabs": [{"x": 1}]}']
)
async def test_a_damaged_recovery_file_is_kept_aside(program, text: str):
    file = paths.state_folder() / f"recovery-{dead_pid()}.json"
    file.parent.mkdir(parents=True)
    file.write_text(text)
    async with desktop(program("x = 1\n")) as desk:
        await desk.until(lambda: "another version or is damaged" in desk.output)
        assert file.with_suffix(".unread").read_text() == text


async def test_the_last_sessions_files_are_opened_again(program):
    a, b = program("a = 1\n", "a.src"), program("b = 1\n\n\n", "b.src")
    async with desktop(a, b) as desk:
        desk.app.editor.show(desk.app.editor.areas[1])
        desk.app.editor.front.go_to(1)
        desk.app.leave()
    async with desktop() as desk:
        assert [area.buffer.name for area in desk.app.editor.areas] == ["a.src", "b.src"]
        assert desk.app.editor.front.buffer.name == "b.src"
        assert desk.app.editor.front.cursor_location == (1, 0)


async def test_the_first_start_shows_an_example_and_a_tour():
    async with desktop() as desk:
        assert desk.app.editor.front.text
        assert "Press F5" in desk.output
        await desk.press("f5")
        await desk.idle()
        await desk.until(lambda: "That was a run" in str(desk.app.query_one(TourNote).content))


def test_history_is_kept_and_searched(tmp_path):
    history = CommandHistory(tmp_path / "h.json")
    for line in ("write x", "zz", "write y", "zz", "  "):
        history.add(line)
    assert history.lines == ["write x", "write y", "zz"]
    again = CommandHistory(tmp_path / "h.json")
    assert again.lines == history.lines
    assert again.previous("wr") == "write y"
    assert again.previous("wr") == "write x"
    assert again.previous("wr") is None
    assert again.next() == "write y"
    assert again.next() == "wr"
    assert again.search("X") == (0, "write x")
    (tmp_path / "bad.json").write_text("{")
    assert CommandHistory(tmp_path / "bad.json").lines == []


async def test_history_keys(program):
    async with desktop(program("x = 1\n")) as desk:
        for line in ("a = 1", "b = 2"):
            await desk.line(line)
            await desk.idle()
        prompt = desk.app.command.prompt
        await desk.press("up", "up")
        assert prompt.value == "a = 1"
        await desk.press("down")
        assert prompt.value == "b = 2"
        await desk.press("escape", "ctrl+r", "a")
        assert prompt.value == "a = 1"
        await desk.press("enter")
        await desk.idle()
        assert desk.output.count("> a = 1") == 2


async def test_every_theme_can_be_shown(program):
    async with desktop(program(OSCILLATOR)) as desk:
        for _ in themes.THEMES:
            await desk.press("alt+t")
            await desk.pilot.pause()
        assert desk.app.theme == "dark"
        await desk.line("theme contrast")
        assert desk.app.theme == "contrast"


def test_names_of_keys():
    assert key_names("ctrl+pagedown") == "Ctrl+PgDn"
    assert key_names("f5,alt+l") == "F5, Alt+L"


@pytest.mark.parametrize(("value", "text"), [(0, "0"), (999, "999"), (2.1e6, "2.1 M"), (3.5e10, "35 G")])
def test_speeds(value: float, text: str):
    assert speed(value) == text


async def test_a_large_program_is_opened(tmp_path):
    path = tmp_path / "large.src"
    path.write_text("x = 1 -- a long comment that makes the line longer, for the sake of it\n" * 280_000)
    assert path.stat().st_size > 19e6
    async with desktop(path) as desk:
        area = desk.app.editor.front
        area.focus()
        area.go_to(200_000)
        await desk.press("y")
        assert area.document.get_line(200_000).startswith("yx = 1")


async def test_a_configuration_that_is_saved_is_private(program):
    async with desktop(program("x = 1\n")) as desk:
        await desk.line("config")
        await desk.until(lambda: desk.app.editor.front.buffer.path == paths.config_file().resolve())
        await desk.do("file.save")
        await desk.until(lambda: paths.config_file().exists())
        assert paths.config_file().stat().st_mode & 0o777 == 0o600
        assert paths.config_file().parent.stat().st_mode & 0o777 == 0o700
