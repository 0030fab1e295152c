"""The table of actions: complete, without clashes, reachable."""

from __future__ import annotations

import pytest

from desire_tui import commands
from desire_tui.commands import BY_ID, COMMANDS, parse_line
from desire_tui.desktop import alt_keys

from .conftest import OSCILLATOR, desktop

ARROWS = ("left", "right", "up", "down", "pageup", "pagedown")
"""Their keys are longer sequences, which all terminals agree on."""


def test_ids_and_words_and_keys_are_unique():
    assert len(BY_ID) == len(COMMANDS)
    # `fit` alone fits the graph, `fit k to x ~ y` a model
    words = [(word, bool(command.argument)) for command in COMMANDS for word in command.words]
    assert len(words) == len(set(words))
    keys = [key for command in COMMANDS for key in command.keys.split(",") if key]
    assert len(keys) == len(set(keys))
    assert "ctrl+enter" not in keys


@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        ("zz", ("run.start", "")),
        ("  erun ", ("run.start", "")),
        ("keep 'a b.src'", ("file.save", "a b.src")),
        ("keep'x.src'", ("file.save", "x.src")),
        ('load "f"', ("file.open", "f")),
        ("help dispt", ("help.word", "dispt")),
        ("snapshot 'g.png'", ("graph.snapshot", "g.png")),
        ("bye", ("file.quit", "")),
        ("run = 3", None),
        ("line[3] = 2", None),
        ("zz | write x", None),
        ("find 'a|b'", ("edit.find", "a|b")),
        ("find a|b", None),
        ("write x", None),
        ("go to 100", None),
        ("", None),
    ],
)
def test_command_lines(line: str, wanted: tuple[str, str] | None):
    found = parse_line(line)
    assert (found and (found[0].id, found[1])) == wanted


async def test_every_action_is_in_the_palette_and_has_a_method(program):
    async with desktop(program(OSCILLATOR)) as desk:
        offered = {entry.title.split("  ")[0] for entry in desk.app.get_system_commands(desk.app.screen)}
        for command in COMMANDS:
            part, _, name = command.id.partition(".")
            assert callable(getattr(desk.app._controllers[part], name))
            assert command.title in offered or command.id == "view.palette"


async def test_keys_do_what_the_table_says(program):
    """Each key, pressed, calls its action."""
    async with desktop(program(OSCILLATOR)) as desk:
        app = desk.app
        done: list[str] = []
        app.do = lambda command_id, argument="": done.append(command_id)  # type: ignore[method-assign]
        app.editor.front.focus()
        await desk.pilot.pause()
        for command in COMMANDS:
            for key in command.keys.split(","):
                if key and key != "alt+f":  # inside a text a word to the right
                    done.clear()
                    await desk.press(key)
                    assert done == [command.id], key


async def test_keys_can_be_remapped(program, tmp_path):
    folder = tmp_path / "config" / "desire-tui"
    folder.mkdir(parents=True)
    (folder / "config.toml").write_text('[keys]\n"run.start" = "ctrl+j"\n')
    async with desktop(program(OSCILLATOR)) as desk:
        done: list[str] = []
        desk.app.do = lambda command_id, argument="": done.append(command_id)  # type: ignore[method-assign]
        await desk.press("ctrl+j", "f5")
        assert done == ["run.start"]


def test_bindings_have_priority_and_ids():
    for binding in commands.bindings():
        assert binding.priority
        assert binding.id


CHARACTERS = {
    "backspace": "\x7f", "minus": "-", "plus": "+", "equals_sign": "=", "full_stop": ".", "comma": ",", "apostrophe": "'", "semicolon": ";",
}  # fmt: skip


def test_every_key_with_alt_arrives_from_terminals_without_kittys_protocol():
    """There Alt+0 is Escape and 0, which Textual took for `º`; some never arrived, Alt+Backspace closed the tab."""
    from textual._xterm_parser import XTermParser

    alt_keys.teach()
    keys = {key for command in COMMANDS for key in command.keys.split(",") if key.startswith("alt+")}
    for key in {key for key in keys if key.split("+")[-1] not in ARROWS} | {"alt+backspace"}:
        name = key.removeprefix("alt+")
        assert [event.key for event in XTermParser().feed(f"\x1b{CHARACTERS.get(name, name)}")] == [key]


def test_the_page_of_keys_is_up_to_date():
    from .pictures import KEYS, keys_page

    assert KEYS.read_text() == keys_page()


async def test_a_quantity_wins_over_a_word_of_the_desktop(program):
    async with desktop(program("theme = 7 | zz = 5\n")) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.line("theme")
        await desk.idle()
        assert desk.output.rstrip().endswith("7")
        assert desk.app.theme == "dark"
