"""Find and replace: what is found, what it becomes, and the bar."""

from __future__ import annotations

import pytest

from desire_tui.editor import text_search
from desire_tui.editor.find_bar import FindBar
from desire_tui.editor.text_search import HITS_MAX, SearchRequest, Unsearchable

from .conftest import desktop


@pytest.fixture(autouse=True)
def patience(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search that is short takes longer than usual on a machine with much to do."""
    monkeypatch.setattr(text_search, "PATIENCE_S", 60.0)
    monkeypatch.setattr(text_search, "PATIENCE_FOR_ALL_S", 60.0)


# ----------------------------------------------------------------------------------------------- text alone


@pytest.mark.parametrize(
    ("wanted", "line", "columns"),
    [
        (SearchRequest("x"), "x X xx", [0, 2, 4, 5]),
        (SearchRequest("X"), "x X xx", [2]),  # a capital typed: capitals count
        (SearchRequest("x", case=True), "x X", [0]),
        (SearchRequest("X", case=False), "x X", [0, 2]),
        (SearchRequest("x", word=True), "x xx x$ x_1 $x (x) x", [0, 16, 19]),
        (SearchRequest("a.b"), "a.b aXb", [0]),
        (SearchRequest("a.b", regex=True), "a.b aXb", [0, 4]),
        (SearchRequest(r"\S+", regex=True), "ab AB", [0, 3]),  # the capital of \S is none
        (SearchRequest("^", regex=True), "ab", [0]),
        (SearchRequest("a|b", word=True, regex=True), "a b ab", [0, 2]),
    ],
)
def test_what_is_found(wanted: SearchRequest, line: str, columns: list[int]):
    assert [start for _, start, _ in wanted.hits([line])] == columns


def test_inside_a_part_of_the_text_only():
    lines = ["x x", "x", "x x"]
    within = ((0, 2), (2, 1))
    assert SearchRequest("x").hits(lines, within) == [(0, 2, 3), (1, 0, 1), (2, 0, 1)]
    assert SearchRequest("x").all_replaced(lines, "yy", within) == (0, 2, ["x yy", "yy", "yy x"], 3)
    assert SearchRequest("(x)", regex=True).all_replaced(lines, r"\1\1", within).lines == [
        "x xx",
        "xx",
        "xx x",
    ]


def test_replacements():
    assert SearchRequest("a").all_replaced(["a", "b", "a"], r"\1") == (
        0,
        2,
        [r"\1", "b", r"\1"],
        2,
    )  # as it stands
    rate = SearchRequest(r"d/dt (\w+)", regex=True)
    assert rate.all_replaced(["", "d/dt x = v"], r"\1dot") == (1, 1, ["xdot = v"], 1)
    assert rate.replaced(["d/dt x = v"], (0, 0, 6), r"\g<0>\n\1") == "d/dt x\nx"
    assert SearchRequest(r"\|", regex=True).all_replaced(["a|b"], r"\n").lines == ["a", "b"]
    assert SearchRequest("q").all_replaced(["a"], "b").places == 0


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("a(b", "a ( is not closed (character 2)"),
        ("a)", "a ) closes nothing (character 2)"),
        ("[a", "a [ is not closed"),
        ("*", "nothing to repeat stands before"),
        ("a\\", "stands alone at the end"),
        ("x{70000}{70000}{70000}", "a repetition is repeated"),
        ("(" * 3000 + ")" * 3000, "too large"),
    ],
    ids=lambda text: text[:8],
)
def test_a_wrong_expression_is_told_in_plain_words(text: str, sentence: str):
    with pytest.raises(Unsearchable, match=r".*") as told:
        SearchRequest(text, regex=True).hits(["a"])
    assert sentence in str(told.value)
    with pytest.raises(Unsearchable, match="there is no group of that number"):
        SearchRequest("a", regex=True).all_replaced(["a"], r"\2")


def test_an_expression_that_would_match_for_years_is_broken_off(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(text_search, "PATIENCE_S", 0.25)
    with pytest.raises(Unsearchable, match="takes too long"):
        SearchRequest("(a+)+$", regex=True).hits(["a" * 60 + "b"])


def test_so_many_that_nobody_reads_them():
    assert len(SearchRequest("a").hits(["a" * 1000] * 30)) == HITS_MAX
    assert SearchRequest("a").all_replaced(["a" * 1000] * 30, "b").places == 30_000


# ------------------------------------------------------------------------------------------------ on screen


async def test_the_bar_finds_and_replaces_in_every_way(program):
    text = "x = 1\nX = 2\nxx = x\ny = x\n"
    async with desktop(program(text)) as desk:
        area, bar = desk.app.editor.front, desk.app.editor.query_one(FindBar)

        def shown(name: str) -> str:
            return str(bar.query_one(name).content)

        area.focus()
        assert not bar.children  # they are mounted for whoever searches
        await desk.do("edit.find_next")
        assert not bar.display
        assert desk.app.errors_reported == 0
        await desk.press("ctrl+f", "x", "alt+w")
        assert shown("#found") == "1 of 4"
        assert area.marks.found == {0: [(0, 1)], 1: [(0, 1)], 2: [(5, 6)], 3: [(4, 5)]}
        await desk.press("alt+c", "enter")
        assert shown("#found") == "2 of 3"
        assert [bar.query_one(f"#find-{name}").has_class("-on") for name in ("case", "word", "regex")] == [
            True, True, False,
        ]  # fmt: skip
        await desk.press("alt+w", "alt+x", "backspace", "(")
        assert shown("#wrong") == "a ( is not closed (character 1)"
        await desk.press("x", ")", "$")
        assert shown("#wrong") == ""
        assert shown("#found") == "1 of 2"
        await desk.press("alt+a")  # opens the second field
        await desk.press("tab", "backslash", "1", "z", "alt+a")
        assert area.text == "x = 1\nX = 2\nxx = xz\ny = xz\n"
        await desk.pilot.pause(0.2)
        assert shown("#found") == "2 replaced"
        area.focus()
        await desk.press("ctrl+z")
        assert area.text == text
        await desk.until(lambda: shown("#found") == "2 found")

        # in the lines selected, which grow with what is put in
        await desk.press("escape")
        area.selection = ((0, 0), (1, 5))
        await desk.press("ctrl+r")
        assert shown("#found") == "not found in 1–2"
        await desk.pilot.click("#find-regex")
        await desk.pilot.click("#find-case")
        desk.app.editor.query_one("#wanted").value = "x"
        await desk.until(lambda: shown("#found") == "1 of 2 in 1–2")
        desk.app.editor.query_one("#replacement").value = "long"
        await desk.pilot.click("#replace-one")
        assert area.text.startswith("long = 1\nX = 2\nxx")
        assert shown("#found") == "1 of 1 in 1–2"
        await desk.pilot.click("#replace-all")
        assert area.text == "long = 1\nlong = 2\nxx = x\ny = x\n"

        # another tab is searched as soon as it is in front
        await desk.press("escape", "ctrl+n", "x", "ctrl+f")
        assert shown("#found") == "1 found"
        await desk.press("ctrl+pageup")
        assert bar.finder.area is area
        await desk.press("escape")
        assert not bar.display
        assert area.marks.found == {}
