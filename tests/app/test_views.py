"""ProgramLines, their marks, several views of them, and the row of tabs."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from textual import events
from textual.screen import Screen
from textual.widgets import Input, TextArea

from desire_tui.editor.brackets import partner
from desire_tui.editor.line_marks import Marks
from desire_tui.editor.program_lines import ProgramLines
from desire_tui.editor.tab_strip import TabStrip

from .conftest import OSCILLATOR, desktop

# ------------------------------------------------------------------------------------------------ lines alone

EDITS = st.lists(
    st.tuples(
        st.integers(0, 12), st.integers(0, 4), st.integers(0, 4), st.integers(0, 4), st.sampled_from(["", "x", "\n", "x\ny\n", "\n\n"])
    ),
    min_size=1, max_size=6,
)  # fmt: skip
"""Row, column, rows more, column, new text."""


def edited(lines: ProgramLines, edits: list[tuple[int, int, int, int, str]]) -> None:
    for first, left, more, right, text in edits:
        row = min(first, lines.line_count - 1)
        last = min(row + more, lines.line_count - 1)
        start = (row, min(left, len(lines.get_line(row))))
        lines.replace_range(start, max(start, (last, min(right, len(lines.get_line(last))))), text)


@given(EDITS)
def test_a_mark_stays_with_its_line(edits):
    """Each line has a text of its own, so that its place after the edits can be looked up."""
    names = [f"<{row}>" for row in range(12)]
    lines, marks = ProgramLines("\n".join(names)), Marks(breakpoints=set(range(12)))
    lines.followers.append(marks.replaced)
    edited(lines, edits)
    whole = {row for row, name in enumerate(names) if any(line == name for line in lines.lines)}
    for row in whole:
        place = lines.lines.index(names[row])
        assert marks.row_now(row) == place
        assert place in marks.breakpoints
        assert marks.row_now(marks.row_then(place)) == place
    assert all(0 <= row < lines.line_count for row in marks.breakpoints)
    marks.accepted()
    assert all(marks.row_then(row) == row for row in range(lines.line_count))


def test_deleted_lines_take_their_marks_along_and_rewritten_ones_keep_them():
    lines, marks = ProgramLines("a\nb\nc\nd"), Marks(breakpoints={1, 2})
    lines.followers.append(marks.replaced)
    lines.replace_range((0, 0), (3, 1), "  a\n  b\n  c\n  d")  # indented
    assert marks.breakpoints == {1, 2}
    lines.replace_range((1, 0), (2, 0), "")
    assert marks.breakpoints == {1}
    lines.replace_range((1, 0), (1, 0), "\n")  # Return before the text: the line moves down
    assert marks.breakpoints == {2}
    lines.replace_range((2, 3), (2, 3), "\n")  # Return behind it
    assert marks.breakpoints == {2}


@given(EDITS, st.integers(0, 11), st.integers(0, 4))
def test_a_place_stays_before_the_same_text(edits, row, column):
    """A letter that occurs once marks the place."""
    texts = [f"<{row}>" for row in range(12)]
    texts[row] = texts[row][:column] + "!" + texts[row][column:]
    lines, place = ProgramLines("\n".join(texts)), (row, min(column, len(texts[row]) - 1))

    def moved(top, bottom, end):
        nonlocal place
        place = lines.followed(place, top, bottom, end)

    lines.followers.append(moved)
    for edit in edits:
        before = place
        edited(lines, [edit])
        if "!" not in lines.text:
            return
        there = next((at, line.index("!")) for at, line in enumerate(lines.lines) if "!" in line)
        assert place in {there, before}  # new text at the very place: behind it or before it
        place = there


def test_only_line_feeds_end_lines():
    text = "a\x0cb\x1cc\u2028d\ne\r\nf\rg"
    lines = ProgramLines(text)
    assert lines.lines == ["a\x0cb\x1cc\u2028d", "e", "f", "g"]
    lines.replace_range((0, 1), (0, 1), "\x0b\r\n\x85")
    assert lines.text == "a\x0b\n\x85\x0cb\x1cc\u2028d\ne\nf\ng"


@pytest.mark.parametrize(
    ("text", "at", "place"),
    [
        ("a(b[1], c)", (0, 1), (0, 9)), ("a(b[1], c)", (0, 9), (0, 1)), ("a(b[1], c)", (0, 3), (0, 5)),
        ("f(1,\n  2)", (0, 1), (1, 3)), ("f(1,\n  2)", (1, 3), (0, 1)), ("(", (0, 0), None), (")", (0, 0), None),
        ("(]", (0, 0), None), ("(" * 100_000, (0, 0), None), ("(\n" * 100_000, (0, 0), None),
        ("f(')')", (0, 1), (0, 5)), ("f(1 -- )\n )", (0, 1), (1, 1)), ("'(' | a(1)", (0, 1), None), ("(1) -- )", (0, 7), None),
    ],
)  # fmt: skip
def test_brackets(text: str, at: tuple[int, int], place: tuple[int, int] | None):
    assert partner(text.split("\n"), at) == place


# ------------------------------------------------------------------------------------------------------ views


async def test_two_tabs_side_by_side(program):
    async with desktop(program("x = 1\n", "a.src"), program("y = 1\n", "b.src")) as desk:
        editor = desk.app.editor
        assert [area.display for area in editor.areas] == [True, False]
        await desk.press("ctrl+backslash")
        assert [area.display for area in editor.areas] == [True, True]
        editor.areas[1].focus()
        await desk.until(lambda: editor.front is editor.areas[1])
        assert all(area.display for area in editor.areas)
        await desk.press("ctrl+backslash")
        assert [area.display for area in editor.areas] == [False, True]


async def test_a_second_view_shows_what_the_first_does(program):
    async with desktop(program(OSCILLATOR)) as desk:
        editor = desk.app.editor
        first = editor.front
        first.focus()
        await desk.press("alt+v")
        await desk.until(lambda: len(first.views) == 2)
        second = first.views[1]
        assert second.display
        assert second.region.width > 10
        assert second.region.x >= first.region.right
        second.focus()
        await desk.until(lambda: editor.front is second)
        second.go_to(4, 0)
        first.go_to(6, 3)  # without the keys: `desktop` drives the second
        await desk.press("minus", "minus", "enter")
        assert first.text == second.text
        assert first.text.splitlines()[4:6] == ["--", "drun"]
        assert first.cursor_location == (7, 3)  # on the same letter as before
        assert first.is_dirty
        assert editor.areas == [first]
        first.focus()
        await desk.pilot.pause()
        await desk.press("ctrl+z", "ctrl+z")  # what was typed in the other view
        assert first.text == second.text == OSCILLATOR
        await desk.press("ctrl+y", "ctrl+y", "ctrl+s")
        await desk.until(lambda: not first.is_dirty)
        assert first.buffer.path.read_text() == second.text
        # a run from the second view, its marks in both
        second.focus()
        await desk.until(lambda: editor.front is second)
        second.go_to(3)
        await desk.press("f9", "f5")
        await desk.idle()
        assert editor.active is first
        assert first.marks is second.marks
        assert second.marks.traced == 3
        # back to one view, at the place last worked on
        await desk.press("alt+v")
        await desk.until(lambda: len(first.views) == 1)
        assert editor.front is first
        assert first.cursor_location[0] == 3
        await desk.press("z")
        assert "z" in first.document.get_line(3)


async def test_what_another_view_writes_above_moves_nothing_on_screen(program):
    async with desktop(program("".join(f"y{n} = {n}\n" for n in range(300)))) as desk:
        first = desk.app.editor.front
        first.focus()
        await desk.press("ctrl+backslash")  # a single tab: the same text twice
        await desk.until(lambda: len(first.views) == 2)
        second = first.views[1]
        second.go_to(200)
        await desk.pilot.pause()
        shown = second.document.get_line(int(second.scroll_offset.y))
        first.go_to(10)
        await desk.press("enter", "enter", "x")
        await desk.pilot.pause()
        assert second.document.get_line(int(second.scroll_offset.y)) == shown
        assert second.cursor_location[0] == 202
        first.go_to(0)
        await desk.press("ctrl+a", "delete")
        await desk.pilot.pause()
        assert second.text == ""
        assert second.cursor_location == (0, 0)
        await desk.press("ctrl+z")
        await desk.pilot.pause()
        assert second.document.line_count == 303


async def test_long_lines_are_shown_whole_wherever_the_cursor_is(program):
    """A paste ends in a short line: the long ones above must not be cut at the width there was before."""
    async with desktop(program("x = 1\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        await desk.pilot.pause()
        desk.app.post_message(events.Paste("y = 1.23456789012345\nlabel = 'ünïcode ｗｉｄｅ'\nz\n"))
        await desk.until(lambda: area.document.line_count == 5)
        await desk.pilot.pause()
        shown = "\n".join(area.render_line(y).text for y in range(4))
        assert "y = 1.23456789012345" in shown
        assert "'ünïcode ｗｉｄｅ'" in shown


async def test_a_tab_with_two_views_closes_both(program):
    async with desktop(program("x = 1\n", "a.src"), program("y = 1\n", "b.src")) as desk:
        editor = desk.app.editor
        first = editor.front
        first.focus()
        await desk.press("alt+v")
        await desk.until(lambda: len(first.views) == 2)
        second = first.views[1]
        second.focus()
        await desk.until(lambda: editor.front is second)
        await desk.press("ctrl+w")
        await desk.until(lambda: len(editor.areas) == 1)
        await desk.pilot.pause()
        assert [area.buffer.name for area in editor.areas] == ["b.src"]
        assert editor.front is editor.areas[0]
        assert not second.is_attached
        await desk.press("z")
        assert editor.front.text == "zy = 1\n"


# ------------------------------------------------------------------------------------------------------- tabs


def names(desk) -> list[str]:
    return [area.buffer.name for area in desk.app.editor.areas]


async def test_tabs_are_moved_by_keys(program):
    async with desktop(*(program(f"x = {n}\n", f"{n}.src") for n in range(3))) as desk:
        desk.app.editor.front.focus()
        await desk.press("ctrl+shift+pagedown")
        assert names(desk) == ["1.src", "0.src", "2.src"]
        await desk.press("ctrl+shift+pagedown", "ctrl+shift+pagedown")
        assert names(desk) == ["1.src", "2.src", "0.src"]
        await desk.press("ctrl+shift+pageup")
        assert names(desk) == ["1.src", "0.src", "2.src"]
        assert desk.app.editor.front.buffer.name == "0.src"
        await desk.press("ctrl+pagedown")
        assert desk.app.editor.front.buffer.name == "2.src"


async def test_tabs_are_dragged_with_the_mouse(program):
    async with desktop(*(program(f"x = {n}\n", f"{n}.src") for n in range(3))) as desk:
        strip = desk.app.editor.query_one(TabStrip)
        width = len(" 0.src ") + 1
        await desk.pilot.mouse_down(strip, offset=(2, 0))
        for x in range(3, 2 * width + 4):
            await desk.pilot.hover(strip, offset=(x, 0))
        await desk.pilot.mouse_up(strip, offset=(2 * width + 3, 0))
        assert names(desk) == ["1.src", "2.src", "0.src"]
        await desk.pilot.hover(strip, offset=(2, 0))  # let go: nothing is dragged any more
        assert names(desk) == ["1.src", "2.src", "0.src"]
        await desk.pilot.click(strip, offset=(2, 0))
        assert desk.app.editor.front.buffer.name == "1.src"
        assert names(desk) == ["1.src", "2.src", "0.src"]


# ---------------------------------------------------------------------------------------- stops in the script


async def test_a_click_beside_a_line_sets_a_breakpoint_where_the_script_can_stop(program):
    async with desktop(program("x = 1\n-- remark\nx = 2\nSTOP\nx = 3\n")) as desk:
        area = desk.app.editor.front
        await desk.pilot.click(area, offset=(1, 2))
        assert area.marks.breakpoints == {2}
        await desk.pilot.click(area, offset=(1, 1))
        assert area.marks.breakpoints == {2}
        await desk.pilot.click(area, offset=(1, 2))
        assert area.marks.breakpoints == set()


async def test_undo_brings_breakpoints_back(program):
    async with desktop(program("a = 1\nb = 2\nc = 3\nd = 4\n")) as desk:
        area, marks = desk.app.editor.front, desk.app.editor.front.marks
        area.focus()
        marks.breakpoints = {1, 3}
        area.go_to(1)
        await desk.press("ctrl+shift+k")
        assert (area.text, marks.breakpoints) == ("a = 1\nc = 3\nd = 4\n", {2})
        await desk.press("alt+shift+down", "alt+shift+down")  # c goes below d
        assert (area.text, marks.breakpoints) == ("a = 1\nd = 4\n\nc = 3", {1})
        await desk.press("ctrl+z", "ctrl+z")
        assert (area.text, marks.breakpoints) == ("a = 1\nc = 3\nd = 4\n", {2})
        await desk.press("ctrl+z")
        assert marks.breakpoints == {1, 3}
        await desk.press("ctrl+y")
        assert marks.breakpoints == {2}
        await desk.press("ctrl+y", "ctrl+y")
        assert marks.breakpoints == {1}
        await desk.press(*["ctrl+z"] * 3)
        assert marks.breakpoints == {1, 3}


async def test_breakpoints_count_at_once_even_in_an_edited_text(program):
    """The program that runs is the one accepted; a mark is where its line is now."""
    async with desktop(program("x = 1\nSTOP\nx = 2\nx = 3\nx = 4\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        await desk.press("f5")
        await desk.idle()
        assert area.marks.traced == 2
        area.go_to(0)
        await desk.press("enter", "enter")  # two lines more above
        assert area.marks.traced == 4
        area.go_to(5)
        await desk.press("f9")  # x = 3
        await desk.press("f10")
        await desk.idle()
        assert desk.app.session.values.cells[desk.app.session.values.find("x").slot] == 2
        assert area.marks.traced == 5
        assert area.cursor_location[0] == 5
        await desk.press("f9")
        area.go_to(6)
        await desk.press("f9", "f9", "f10")  # set and removed
        await desk.idle()
        assert desk.app.session.values.cells[desk.app.session.values.find("x").slot] == 4
        assert area.marks.traced is None


async def test_a_breakpoint_set_while_the_script_runs_stops_it(program):
    async with desktop(program("n = 0\nrepeat\n  n = n + 1\nuntil n < 0\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.values.find("n") is not None)
        area.go_to(2)
        await desk.press("f9")
        await desk.idle()
        assert area.marks.traced == 2
        await desk.press("f9", "f10")
        await desk.until(lambda: desk.app.session.stopped_at is None)
        assert desk.app.engine.is_busy
        await desk.press("shift+f10")
        await desk.idle()


# ---------------------------------------------------------------------------------------------------- drawing


def shown(desk) -> list[list[tuple[str, object]]]:
    """Return what the screen holds, with styles."""
    return [
        [(s.text, s.style) for s in strip.simplify()] for strip in desk.app.screen._compositor.render_strips()
    ]


async def test_what_is_drawn_row_by_row_is_what_a_new_drawing_gives(program, monkeypatch):
    """Only rows that changed are drawn; whatever is done, none may be forgotten."""
    monkeypatch.setattr(
        "desire_tui.editor.editor_tabs.CHECK_AFTER_S", 1e6
    )  # nothing comes by itself between two looks
    text = "".join(f"y{n} = sin({n})*(x + 0.5) -- line {n}\n" for n in range(100))
    async with desktop(program(text)) as desk:
        desk.app.settings.completion_after = 0
        area = desk.app.editor.front
        area.focus()
        area.cursor_blink = False
        for field in desk.app.main_screen.query(Input):
            field.cursor_blink = False
        for keys in (
            ["x"], ["enter"], ["backspace", "backspace"], ["right"] * 4, ["pagedown"], ["shift+down", "shift+right"], ["tab"],
            ["ctrl+z"], ["ctrl+underscore"], ["f9"], ["end"], ["Y"] * 70, ["home"], ["ctrl+end"], ["ctrl+home"], ["ctrl+l"],
            ["alt+e"], ["alt+t"], ["ctrl+a"], ["left"], ["alt+v"], ["q"], ["ctrl+backslash"], ["ctrl+f"], ["6"], ["escape"],
        ):  # fmt: skip
            await desk.press(*keys)
            await desk.pilot.pause()
            before = shown(desk)
            for view in area.views:
                view._drawn.clear()
                view._shown.clear()  # all of it is drawn now
                view._common = ()
                view.refresh()
            await desk.pilot.pause()
            assert shown(desk) == before, keys


async def test_a_key_draws_its_row_and_lays_out_nothing(program, monkeypatch):
    text = "".join(f"y{n} = sin({n})*x + 0.5 -- line {n}\n" for n in range(1000))
    async with desktop(program(text)) as desk:
        area = desk.app.editor.front
        area.focus()
        area.go_to(500, 3)
        await desk.press("a")
        await desk.until(lambda: area.marks.problems)
        await desk.pilot.pause(0.1)
        drawn, laid_out = [], []
        draw, lay_out = TextArea._render_line, Screen._refresh_layout
        monkeypatch.setattr(TextArea, "_render_line", lambda view, y: (drawn.append(y), draw(view, y))[1])
        monkeypatch.setattr(
            Screen,
            "_refresh_layout",
            lambda screen, *args, **more: (laid_out.append(1), lay_out(screen, *args, **more))[1],
        )
        await desk.press("b", "c", "d")
        await desk.pilot.pause(0.05)
        assert 0 < len(drawn) <= 6  # a row, perhaps again with its cursor
        assert not laid_out
