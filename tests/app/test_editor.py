"""The editor: typing, colours, marks, tabs, files."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st
from textual.events import AppFocus

from desire_tui.actions.open_and_save import numbered
from desire_tui.commands import COMMAND_LINE_WORDS
from desire_tui.common.dialogs import Choice
from desire_tui.editor import indent
from desire_tui.editor.highlighting import LineHighlights
from desire_tui.editor.program_lines import ProgramLines
from desire_tui.language.completion import OWN_NAME, around, offers
from desire_tui.language.line_tokens import word_before

from .conftest import OSCILLATOR, desktop

if TYPE_CHECKING:
    from desire_tui.editor.code_area import CodeArea

# ----------------------------------------------------------------------------------------------- text alone


@pytest.mark.parametrize(
    ("line", "blanks"),
    [
        ("for i = 1 to 3", 2),
        ("  while x > 0", 4),
        ("if x > 0 then", 2),
        ("if x > 0 then y = 1 | proceed", 0),
        ("for i = 1 to 3 | x = i | next", 0),
        ("for = 3", 0),
        ("x = 1", 0),
        ("  else -- otherwise", 4),
        ("if name = 'then'", 0),
        ("write 'if x then'", 0),
        ("if a = '|next' then -- | next", 2),
        ("while x > 0 -- | end while", 2),
        ("next[2] = 3", 0),
        ("for[1] = 2", 0),
        ("repeat$ = 1", 0),
        ("10 repeat", 2),
        ("MACRO m(x)", 2),
    ],
)
def test_indent_after(line: str, blanks: int):
    assert indent.indent_after(line) == " " * blanks


@pytest.mark.parametrize(
    ("line", "above", "blanks"),
    [
        ("  x = al_", "", 0),
        ("  x = a + _", "", 2),
        ("  y = 1 -- note_", "", 2),
        ("3", "  for i = 1 to _\n", 4),
        ("xt", "  ne_\n", 2),
        ("  then'", "  write 'if x _\n", 2),
    ],
)
def test_indent_after_rows_that_are_joined(line: str, above: str, blanks: int):
    assert indent.indent_after(line, above) == " " * blanks


def test_words_of_joined_rows_are_offered_whole():
    lines = ["alpha = 1 | be_", "ta = 2", "x = 3 -- gam_", "ma = 1"]
    assert [offer.word for offer in offers("be", around(lines, 0), {})] == ["beta"]
    assert [offer.word for offer in offers("gamm", around(lines, 0), {})] == []
    assert [offer.word for offer in offers("m", around(lines, 0), {}) if offer.about == OWN_NAME] == ["ma"]


@pytest.mark.parametrize(
    ("text", "blanks"),
    [
        ("  for i = 1 to 3\n    x = i\n    next", 2),
        ("  for i = 1 to 3\n    for k = 1 to 2\n  ne_\nxt\n    next", 2),
        ("  fo_\nr i = 1 to 3\n    x = i\n    next", 2),
        ("for i = 1 to 3\n  if i > 1 then\n    x = i\n  else x = 2\n    proceed", 2),
        ("  while x\n    next[1] = 2\n    write 'for'\n    -- for ever\n    end while", 2),
        ("if x then\n  write '| next'\n  proceed", 0),
        ("x = 1\nnext", None),
    ],
)
def test_a_closing_line_stands_below_its_opener(text: str, blanks: int | None):
    lines = text.split("\n")
    found = indent.closing_indent(lines, len(lines) - 1)
    assert found == (None if blanks is None else " " * blanks)


@given(st.lists(st.text("ab=-| 'é\t", max_size=12), min_size=1, max_size=5))
def test_commenting_twice_gives_the_lines_back(lines: list[str]):
    once = indent.toggle_comment(lines)
    if any(line.strip() for line in lines) and not all(
        indent.COMMENT.match(line) for line in lines if line.strip()
    ):
        assert all(indent.COMMENT.match(line) for line in once if line.strip())
        assert indent.toggle_comment(once) == lines


def test_numbered_lines():
    assert numbered(ProgramLines("x = 1\ny = 2\n")) == "210 x = 1\n220 y = 2\n"
    assert numbered(ProgramLines("x = 1\ry = 2")) == "210 x = 1\r220 y = 2\r"


def test_completion_offers_own_names_functions_and_statements():
    text = "omega = 2\n-- comment_word\nwrite 'string_word'"
    words = {offer.word: offer.about for offer in offers("om", text.split("\n"), {})}
    assert "omega" in words
    assert not {o.word for o in offers("comment_w", text.split("\n"), {})}
    assert not {o.word for o in offers("string_w", text.split("\n"), {})}
    found = {offer.word: offer.about for offer in offers("si", [], {})}
    assert "sine" in found["sin"]
    assert "dispt" in {o.word for o in offers("disp", [], {})}
    assert "zz" in {o.word for o in offers("z", [], {}, commands=COMMAND_LINE_WORDS)}
    assert offers("om", text.split("\n"), {"omega": "= 2"})[0].about == "= 2"


def test_the_likeliest_completion_comes_first():
    def words(prefix: str, *texts: str) -> list[str]:
        return [offer.word for offer in offers(prefix, texts, {"sizes": "= 3"})]

    assert words("si", "")[:3] == ["sizes", "sin", "sinc"]
    assert words("si", "sigmoid(x) | six = 1")[:3] == ["six", "sizes", "sigmoid"]
    assert words("Si", "Silent = 1 | si = 2")[:2] == ["Silent", "si"]
    assert words("dr", "")[:2] == ["drun", "drunr"]


def test_no_completion_inside_comments_and_strings():
    assert word_before("x = sig", 7) == "sig"
    assert word_before("-- sig", 6) == ""
    assert word_before("write 'sig", 10) == ""


def test_highlight_ranges_are_bytes():
    from textual.document._document import Document

    import desire_tui.engine.session.session  # noqa: F401 - colours come once the engine is imported

    highlights = LineHighlights()
    highlights.document = Document("write 'größe' -- é\nsin(1)")
    line = "write 'größe' -- é"
    pieces = {line.encode()[a:b].decode(): name for a, b, name in highlights[0]}
    assert pieces["write"] == "keyword"
    assert pieces["'größe'"] == "string"
    assert pieces["-- é"] == "comment"


# ---------------------------------------------------------------------------------------------- on screen


async def test_a_row_is_coloured_anew_when_the_one_above_goes_on_in_it(program):
    def style(area: CodeArea, row: int, word: str) -> object:
        return next(s.style and s.style.bold for s in area.render_line(row) if word in s.text)

    async with desktop(program("x = 1\nnext = 2\nnext\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        assert style(area, 2, "next")
        area.go_to(1, 8)
        await desk.press("+", "_")
        await desk.pilot.pause()
        assert not style(area, 2, "next")


async def test_typing_indents_and_dedents(program):
    async with desktop(program("")) as desk:
        area = desk.app.editor.front
        area.focus()
        for text in ("for i = 1 to 3", "x = i", "next", "y = 1"):
            for key in text:
                await desk.press({" ": "space", "=": "equals_sign"}.get(key, key))
            await desk.press("enter")
        assert area.text == "for i = 1 to 3\n  x = i\nnext\ny = 1\n"


async def test_tab_indents_rows_and_undo_takes_it_back(program):
    async with desktop(program("a = 1\nb = 2\nc = 3\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        before = area.text
        await desk.press("shift+down", "shift+down", "tab")
        assert area.text == "  a = 1\n  b = 2\nc = 3\n"
        await desk.press("shift+tab")
        assert area.text == before
        await desk.press("ctrl+underscore")
        assert area.text == "-- a = 1\n-- b = 2\nc = 3\n"
        await desk.press("ctrl+z")
        assert area.text == before
        await desk.press("ctrl+y")
        assert area.text.startswith("-- a")


async def test_find_and_replace(program):
    async with desktop(program("x = 1\nX = 2\nxx = x\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        await desk.press("ctrl+f", "x")
        assert area.selection == ((0, 0), (0, 1))
        assert "1 of 5" in str(desk.app.editor.query_one("#found").content)
        await desk.press("enter")
        assert area.selection == ((1, 0), (1, 1))
        await desk.press("escape")
        assert desk.app.focused is area
        await desk.press("f3")
        assert area.selection == ((2, 0), (2, 1))
        await desk.press("shift+f3", "shift+f3")
        assert area.selection == ((0, 0), (0, 1))
        await desk.press("escape", "ctrl+r")
        desk.app.editor.query_one("#wanted").value = "X"  # a capital letter: case counts
        desk.app.editor.query_one("#replacement").value = "omega"
        desk.app.editor.query_one("#replacement").focus()
        await desk.press("alt+a")
        assert area.text == "x = 1\nomega = 2\nxx = x\n"
        area.focus()
        await desk.press("ctrl+z")
        assert area.text == "x = 1\nX = 2\nxx = x\n"


async def test_a_jump_moves_the_text_no_further_than_it_must(program):
    line = "x = 1 -- " + "long " * 20
    async with desktop(program("\n".join([line] * 60))) as desk:
        area = desk.app.editor.front
        area.focus()
        area.go_to(3, 20)
        await desk.pilot.pause()
        assert area.scroll_offset == (0, 0)  # in view: nothing moves
        area.go_to(40, 100)
        await desk.pilot.pause()
        assert area.scroll_offset.x > 0
        assert abs(area.scroll_offset.y + area.size.height // 2 - 40) <= 1
        area.go_to(40, 20)
        await desk.pilot.pause()
        assert area.scroll_offset.x == 0


async def test_go_to_line(program):
    async with desktop(program(OSCILLATOR)) as desk:
        desk.app.editor.front.focus()
        await desk.press("ctrl+g", "4", "enter")
        await desk.pilot.pause()
        assert desk.app.editor.front.cursor_location == (3, 0)
        await desk.do("edit.goto", "7:4")
        await desk.pilot.pause()
        assert desk.app.editor.front.cursor_location == (6, 3)
        await desk.do("edit.goto", "zwei")
        await desk.pilot.pause()
        assert desk.app.editor.front.cursor_location == (6, 3)


async def test_f1_explains_the_word_at_the_cursor(program):
    async with desktop(program("x = sin(1)\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        area.go_to(0, 5)
        await desk.press("f1")
        await desk.pilot.pause()
        assert desk.app.main_screen.side == "help"
        assert "sin" in desk.app.help_pane.query_one("Markdown").source


async def test_tabs_dirty_marks_and_close_guard(program, tmp_path):
    async with desktop(program("x = 1\n")) as desk:
        editor = desk.app.editor
        await desk.press("ctrl+n")
        await desk.until(lambda: len(editor.areas) == 2)
        await desk.press("y")
        assert editor.front.is_dirty
        await desk.press("ctrl+w")
        await desk.until(lambda: isinstance(desk.app.screen, Choice))
        await desk.press("escape")
        assert len(editor.areas) == 2
        await desk.press("ctrl+w")
        await desk.until(lambda: isinstance(desk.app.screen, Choice))
        await desk.press("d")
        await desk.until(lambda: len(editor.areas) == 1)
        assert editor.front.buffer.name == "osc.src"
        await desk.press("ctrl+q")
        await desk.until(lambda: not desk.app.is_running)


async def test_save_keeps_line_ends_and_notices_changes_on_disk(tmp_path):
    path = tmp_path / "dos.src"
    path.write_bytes(b"x = 1\r\ny = 2\r\n")
    async with desktop(path) as desk:
        area = desk.app.editor.front
        assert area.text == "x = 1\ny = 2\n"
        area.focus()
        await desk.press("z")
        await desk.press("ctrl+s")
        await desk.until(lambda: not area.is_dirty)
        assert path.read_bytes() == b"zx = 1\r\ny = 2\r\n"
        path.write_text("other = 1\n")
        os.utime(path, (1, 1))
        await desk.press("q", "ctrl+s")
        await desk.until(lambda: isinstance(desk.app.screen, Choice))
        assert path.read_text() == "other = 1\n"
        await desk.press("r")  # read it
        await desk.until(lambda: area.text == "other = 1\n")
        assert not area.is_dirty


async def test_what_others_write_into_an_open_file_is_what_runs(tmp_path):
    clean, dirty = tmp_path / "clean.src", tmp_path / "dirty.src"
    for path in (clean, dirty):
        path.write_text("x = 1\n")
    async with desktop(dirty, clean) as desk:
        editor = desk.app.editor
        editor.front.focus()
        await desk.press("y")
        for path in (clean, dirty):
            path.write_text("write 'from elsewhere'\n")
            os.utime(path, (1, 1))
        desk.app.post_message(AppFocus())  # back from another window
        await desk.until(lambda: editor.areas[1].text == "write 'from elsewhere'\n")
        assert not editor.areas[1].is_dirty
        assert editor.areas[0].text == "yx = 1\n"
        assert [n.message for n in desk.app._notifications if n.severity == "warning"] == [
            "dirty.src was changed on disk, and has unsaved changes here."
        ]
        await desk.press("ctrl+pagedown")
        clean.write_text("write 'once more'\n")
        os.utime(clean, (2, 2))
        await desk.press("f5")  # many terminals do not tell of the focus
        await desk.until(lambda: "once more" in desk.output)
        assert sum(n.severity == "warning" for n in desk.app._notifications) == 1  # told once
        await desk.press("ctrl+z")


async def test_keep_under_a_name_and_load(program, tmp_path):
    async with desktop(program("x = 1\n")) as desk:
        await desk.line("keep 'copy'")
        await desk.until((tmp_path / "copy.src").exists)
        assert desk.app.editor.front.buffer.name == "copy.src"
        await desk.line("keep+ 'num'")
        await desk.until((tmp_path / "num.src").exists)
        assert (tmp_path / "num.src").read_text() == "210 x = 1\n"
        await desk.line("load 'osc'")
        await desk.until(lambda: desk.app.editor.front.buffer.name == "osc.src")
        await desk.line("ed")
        await desk.until(lambda: len(desk.app.editor.areas) == 3)
        assert desk.app.editor.front.text == "x = 1\n"


async def test_a_read_only_folder_and_a_vanished_file_lose_nothing(program, tmp_path, monkeypatch):
    path = program("x = 1\n")
    async with desktop(path) as desk:
        area = desk.app.editor.front
        area.focus()
        await desk.press("y")

        def refuse(*_: object, **__: object) -> None:
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr("desire_tui.actions.save_and_reload.replacing", refuse)
        await desk.press("ctrl+s")
        await desk.until(lambda: "error 106" in desk.output)
        assert area.is_dirty
        monkeypatch.undo()
        path.unlink()
        await desk.press("ctrl+s")
        await desk.until(lambda: not area.is_dirty)
        assert path.read_text() == "yx = 1\n"


async def test_binary_and_missing_files_are_refused_with_a_reason(program, tmp_path):
    (tmp_path / "blob.src").write_bytes(b"\x7fELF\0\0")
    async with desktop(program("x = 1\n")) as desk:
        await desk.line("load 'blob.src'")
        await desk.until(lambda: "not a text file" in desk.output)
        await desk.line("load 'nowhere.src'")
        await desk.until(lambda: "error 38" in desk.output)
        assert len(desk.app.editor.areas) == 1


async def test_a_key_in_a_thousand_lines_is_cheap(program, monkeypatch):
    text = "".join(f"y{n} = sin({n})*x + 0.5 -- line {n}\n" for n in range(1000))
    async with desktop(program(text)) as desk:
        area = desk.app.editor.front
        drawn: list[int] = []
        original = LineHighlights.__missing__
        monkeypatch.setattr(
            LineHighlights, "__missing__", lambda s, row: (drawn.append(row), original(s, row))[1]
        )
        area.focus()
        await desk.press("a")
        await desk.pilot.pause()
        # only lines on screen are coloured: the cost of a key does not grow with the program
        assert 0 < len(set(drawn)) <= area.size.height + 1
