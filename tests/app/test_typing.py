"""What is typed is what stands there, at any speed; completions help and never interfere."""

from __future__ import annotations

import math
import random
from typing import TYPE_CHECKING

import pytest
from textual import events
from textual.keys import _character_to_key

from desire_tui.commands import COMMAND_LINE_WORDS
from desire_tui.language.completion import around, is_complete, offers
from desire_tui.language.line_tokens import word_before

from .conftest import desktop

if TYPE_CHECKING:
    from desire_tui.editor.completion_popup import CompletionPopup

    from .conftest import Desktop

KEYS = {"\n": "enter", "\t": "tab", "\x7f": "backspace", "←": "left", "→": "right"}
LINES = (
    "TMAX = 1E10 | DT = 0.001", "irule 3 | x = 1", "drun", "DYNAMIC", "d/dt x = v", "d/dt omega = -v", "dispt x, v",
    "write sin(omega)", "ome", "omegas = omega", "ARRAY y[10]", "disp", "tma", "wri", "sinh", "sin", "cos", "si",
    "NN = 101", "x = x+1E100", "scale = 2", "STOP", "-- drun later", "write 'omega disp'", "dr", "d/d", "nex",
)  # fmt: skip
"""Whole words, beginnings of words, words that begin other words; none that indents."""


def rush(desk: Desktop, text: str) -> None:
    """Hand keys to the app without waiting for it, as a terminal does."""
    for character in text:
        key = KEYS.get(character)
        letter = None if key else character
        desk.app.post_message(events.Key(key or _character_to_key(character), letter))


def popup_of(desk: Desktop) -> CompletionPopup:
    return desk.app.completer.popup


async def seen(desk: Desktop) -> None:
    """Wait until a list is on the screen, long enough for keys to be meant for it."""
    desk.app.completer.seen_after_s = 0
    await desk.until(lambda: popup_of(desk).seen_at < math.inf)


# ----------------------------------------------------------------------------------------------- text alone


@pytest.mark.parametrize(
    ("line", "prefix"),
    [
        ("x = sig", "sig"), ("-- sig", ""), ("write 'sig", ""), ("x = 1E10", ""), ("x = 2.5e", ""), ("d/d", "d/d"),
        ("y = a/sig", "sig"), ("y2 = a1", "a1"), ("x = ", ""), ("x$i", "x$i"), ("write 'a--b', om", "om"),
        ('write "it\'s "; om', "om"), ("x = 1 -- it's om", ""), ("y = d/sig", "sig"), ("Vectr d/d", "d/d"),
        ("help dis", "dis"), ("10 x = sig", "sig"), ("write ‘sig", ""), ("x = 1 | sig", "sig"), ("x = a$", "a$"),
        ("end whi", "whi"), ("end while", "while"), ("keep+", ""),
    ],
)  # fmt: skip
def test_the_word_before_the_cursor(line: str, prefix: str):
    assert word_before(line, len(line)) == prefix


def test_a_word_is_complete_if_it_stands_elsewhere_or_belongs_to_the_language():
    lines = ["omega = 1", "ome"]
    assert not is_complete("ome", lines, {})
    assert is_complete("ome", [*lines, "ome = 2"], {})
    assert is_complete("omega", [*lines, "omega"], {})
    assert is_complete("sin", ["sin"], {})
    assert is_complete("kappa", ["kappa"], {"kappa": "= 2"})
    assert not is_complete("zz", ["zz"], {})
    assert is_complete("zz", [], {}, commands=COMMAND_LINE_WORDS)


def test_a_complete_word_comes_first_with_its_help():
    found = offers("sin", [], {}, complete=True)
    assert found[0].word == "sin"
    assert "sine" in found[0].about
    assert "sinh" in {offer.word for offer in found}


def test_names_far_away_in_a_long_program_cost_nothing():
    lines = [f"y{n} = 1" for n in range(10_000)]
    assert "y5000 = 1" in around(lines, 5000)
    assert "y1 = 1" not in around(lines, 5000)


# ---------------------------------------------------------------------------------------------- on screen


async def test_tab_takes_the_word_marked(program):
    async with desktop(program("omega = 1\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        area.go_to(1)
        await desk.press("o", "m", "e")
        await seen(desk)
        await desk.press("tab")
        assert area.text == "omega = 1\nomega"
        assert not popup_of(desk).is_open
        await desk.press("space", "s", "i", "n")
        await seen(desk)
        words = [offer.word for offer in popup_of(desk).offered]
        assert words[0] == "sin"
        assert "sinh" in words
        await desk.press("escape")
        assert not popup_of(desk).is_open
        await desk.press("enter")
        assert area.text.endswith(" sin\n")


async def test_arrows_choose_and_enter_takes_what_they_chose(program):
    async with desktop(program("omega1 = 1\nomega2 = 2\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        area.go_to(2)
        await desk.press("o", "m", "e")
        await seen(desk)
        await desk.press("down", "enter")
        assert area.text.endswith("\nomega2")


async def test_enter_never_takes_a_word_nobody_chose(program):
    async with desktop(program("drunr = 1\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        area.go_to(1)
        await desk.press("d", "r", "u")
        await seen(desk)
        await desk.press("n", "enter", "x")
        assert area.text == "drunr = 1\ndrun\nx"
        assert not popup_of(desk).is_open


async def test_tab_indents_behind_a_complete_word_and_before_the_list_was_seen(program):
    async with desktop(program("omega = 1\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        area.go_to(1)
        await desk.press("s", "i", "n")
        await seen(desk)
        await desk.press("tab")
        assert area.text == "omega = 1\nsin "
        area.clear()
        area.insert("omega = 1\n")
        desk.app.completer.seen_after_s = (
            math.inf
        )  # however fast the machine: this Tab was on its way already
        await desk.press("o", "m", "e")
        await desk.until(lambda: popup_of(desk).is_open)
        await desk.press("tab")
        assert area.text == "omega = 1\nome "


async def test_letters_narrow_the_list_and_a_click_elsewhere_closes_it(program):
    async with desktop(program("omega = 1\nomicron = 2\n")) as desk:
        area = desk.app.editor.front
        area.focus()
        area.go_to(2)
        await desk.press("o", "m")
        await desk.do("edit.complete")
        assert [offer.word for offer in popup_of(desk).offered] == ["omega", "omicron"]
        await desk.press("i")
        assert [offer.word for offer in popup_of(desk).offered] == ["omicron"]
        await desk.press("x")
        assert not popup_of(desk).is_open
        await desk.press("backspace")
        await desk.do("edit.complete")
        assert area.text.endswith("\nomicron")  # a single one is put in at once
        await desk.press("enter", "o", "m")
        await desk.do("edit.complete")
        await desk.press("ctrl+l")
        assert not popup_of(desk).is_open


async def test_a_paste_opens_no_list_and_arrives_as_it_is(program):
    text = "irule 3\ndrun\nDYNAMIC\nd/dt omega = disp"
    async with desktop(program("")) as desk:
        area = desk.app.editor.front
        area.focus()
        desk.app.post_message(events.Paste(text))
        rush(desk, "\n")
        await desk.until(lambda: area.document.line_count == 5)
        assert area.text == text + "\n"
        assert not popup_of(desk).is_open


async def test_alt_with_a_letter_that_means_nothing_types_nothing(program):
    async with desktop(program("x = 1\n")) as desk:
        desk.app.editor.front.focus()
        desk.app.post_message(events.Key("alt+b", "b"))
        desk.app.post_message(events.Key("y", "y"))
        await desk.until(lambda: desk.app.editor.front.text == "yx = 1\n")


async def test_backspaces_and_arrows_keep_their_place_among_letters(program):
    async with desktop(program("")) as desk:
        area = desk.app.editor.front
        area.focus()
        rush(desk, "abX\x7fc = 1\n" * 20 + "q←←r→→s\n" * 3 + "end")
        await desk.until(lambda: "end" in area.text)
        assert (
            area.text == "abc = 1\n" * 19 + "abc = 1r\nqsr\nqsr\nqs\nend"
        )  # q goes left over the line's end
        desk.app.command.prompt.focus()
        await desk.pilot.pause()
        rush(desk, "wrX\x7fite 2←←3→→*0\n")
        await desk.idle()
        assert "> write3 2*0" in desk.output


async def test_a_run_waits_for_the_letters_typed_before_its_key(program):
    async with desktop(program("")) as desk:
        area = desk.app.editor.front
        area.focus()
        rush(desk, "x = 7\n" * 50 + "write 'last'; x + 1")
        desk.app.post_message(events.Key("f5", None))
        rush(desk, "23")
        await desk.until(lambda: "last8" in desk.output)
        await desk.idle()
        assert area.text.endswith("x + 123")
        assert desk.app.listener.front.text.endswith("x + 1")


@pytest.mark.parametrize("seed", range(4))
async def test_any_text_at_any_speed(program, seed: int):
    """Pauses of all kinds between keys; a slow typist even waits for each list and then ignores it."""
    dice = random.Random(seed)
    async with desktop(program("")) as desk:
        area = desk.app.editor.front
        area.focus()
        desk.app.completer.seen_after_s = 0
        typed = ""
        for _ in range(25):
            line = dice.choice(LINES) + dice.choice(("\n", " \n", "\n\n"))
            pace = dice.choice(("rush", "flow", "slow"))
            for character in line:
                rush(desk, character)
                if pace == "flow" and dice.random() < 0.3:
                    await desk.pilot.pause(dice.random() * 0.05)
                elif pace == "slow" and dice.random() < 0.2:
                    await desk.pilot.pause(0.12)
            typed += line
        await desk.until(lambda: len(area.text) >= len(typed))
        await desk.pilot.pause()
        assert area.text == typed


async def test_letters_right_after_a_key_go_where_it_leads(program):
    """To the find bar, a new tab, a dialog: none of them is there yet when the letters are typed."""
    text = "".join(f"y{n} = {n}\n" for n in range(50))
    async with desktop(program(text)) as desk:
        area = desk.app.editor.front
        area.focus()
        await desk.pilot.pause()
        desk.app.post_message(events.Key("ctrl+f", None))
        rush(desk, "y33\n")
        desk.app.post_message(events.Key("escape", None))
        rush(desk, "found")
        await desk.until(lambda: "found" in area.text)
        assert area.document.get_line(33) == "found = 33"
        desk.app.post_message(events.Key("ctrl+g", None))
        rush(desk, "12\nhere ")
        await desk.until(lambda: "here" in area.text)
        assert area.document.get_line(11) == "here y11 = 11"
        desk.app.post_message(events.Key("ctrl+n", None))
        rush(desk, "new")
        await desk.until(lambda: desk.app.editor.front.text == "new")
        assert "new" not in area.text
        desk.app.post_message(events.Key("ctrl+end", None))
        rush(desk, "er")
        await desk.until(lambda: desk.app.editor.front.text == "newer")


def test_only_words_of_the_language_are_offered():
    words = {offer.word for start in "abcdefghijklmnopqrstuvwxyz" for offer in offers(start, [], {})}
    assert {"dispt", "drun", "irule", "sin", "then", "d/dt", "TMAX"} <= words
    assert not {"precedence", "operators", "hexadecimal", "settings", "rules"} & words
