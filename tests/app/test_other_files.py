"""Files that are no programs: they are edited, and nothing of the language is done to them."""

from __future__ import annotations

from desire_tui.common.paths import config_file

from .conftest import desktop

PROSE = "# A note\nthe pendulum (see below is\n  long\n"


async def test_the_configuration_is_neither_checked_nor_coloured_nor_run(program):
    async with desktop(program("x = 1\n")) as desk:
        await desk.line("config")
        area = desk.app.editor.front
        assert area.buffer.path == config_file()
        await desk.pilot.pause(1.0)
        assert area.marks.problems == {}
        assert not any(area._coloured[row] for row in range(area.document.line_count))
        await desk.press("f5")
        assert "config.toml is no program" in desk.output
        assert not desk.app.engine.is_busy
        await desk.press("alt+e", "ctrl+end", *"theme", "ctrl+@")
        assert not desk.app.completer.popup.is_open


async def test_a_text_saved_under_another_kind_of_name_is_treated_as_such(program, tmp_path):
    async with desktop(program(PROSE, "a.src")) as desk:
        area = desk.app.editor.front
        await desk.until(lambda: area.marks.problems)
        await desk.do("file.save_as", "note.md")
        await desk.until(lambda: not area.marks.problems)
        await desk.press("alt+e", "end", "enter", "x")
        await desk.pilot.pause(1.0)
        assert area.marks.problems == {}
        await desk.do("file.save_as", "b.src")
        await desk.until(lambda: area.marks.problems)


async def test_a_new_line_of_a_note_only_keeps_the_indentation(program):
    async with desktop(program("  for all\n", "note.md")) as desk:
        await desk.press("alt+e", "end", "enter", "x")
        assert desk.app.editor.front.text == "  for all\n  x\n"
