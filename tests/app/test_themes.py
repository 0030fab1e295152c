"""Themes: all can be shown, the one chosen is remembered; few colours, few characters."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from textual.strip import Strip

from desire_tui.app import DesireApp
from desire_tui.common import paths, plain_characters, themes
from desire_tui.desktop import visible_screen

from .conftest import OSCILLATOR, desktop

SIXTEEN = {
    f"#{red:02x}{green:02x}{blue:02x}"
    for red, green, blue in (
        *((r, g, b) for r in (0, 0xAA) for g in (0, 0xAA) for b in (0, 0xAA)),
        *((r, g, b) for r in (0x55, 0xFF) for g in (0x55, 0xFF) for b in (0x55, 0xFF)),
    )
}
"""Those of old consoles (their brown may be dark yellow)."""


async def test_a_theme_that_was_chosen_is_there_next_time_unless_the_configuration_changed(program):
    path = program(OSCILLATOR)
    async with desktop(path) as desk:
        for name in desk.app.available_themes:  # some of Textual's leave colours out
            desk.app.try_theme(name)
            await desk.pilot.pause()
            assert desk.app.errors_reported == 0
        desk.app.try_theme(None)
        assert desk.app.theme == "dark"
        await desk.line("theme light")
    assert DesireApp([path]).theme == "light"
    paths.config_file().parent.mkdir(parents=True, exist_ok=True)
    paths.config_file().write_text('theme = "contrast"\n')
    assert DesireApp([path]).theme == "contrast"
    (paths.state_folder() / "look.json").write_text(
        '{"theme": ["light"], "instead_of": "contrast", "splits": 3}'
    )
    assert DesireApp([path]).theme == "contrast"
    (paths.state_folder() / "look.json").write_text('{"theme": "pink", "instead_of": "contrast"')
    assert DesireApp([path]).theme == "contrast"


def test_sixteen_colours_are_enough(monkeypatch):
    """TERM=xterm or linux: every colour is one of theirs, so that none becomes its ground's."""
    for name in ("COLORTERM", "TEXTUAL_COLOR_SYSTEM"):
        monkeypatch.delenv(name, raising=False)
    for term in ("xterm", "linux"):
        monkeypatch.setenv("TERM", term)
        app = DesireApp([])
        assert app.current_theme.name == "sixteen-dark"
        app.theme = "light"
        assert app.current_theme.name == "sixteen-light"
    monkeypatch.setenv("TERM", "xterm-256color")
    assert DesireApp([]).current_theme.name == "dark"
    for theme in (themes.SIXTEEN_DARK, themes.SIXTEEN_LIGHT):
        colours = {getattr(theme, name) for name in ("primary", "secondary", "accent", "foreground", "panel")}
        colours |= {getattr(theme, name) for name in ("background", "surface", "success", "warning", "error")}
        colours |= {
            style.color.triplet.hex if style.color else style.bgcolor.triplet.hex
            for style in themes.editor_theme(theme).syntax_styles.values()
            if style.color or style.bgcolor
        }
        assert colours <= SIXTEEN


@pytest.mark.parametrize(
    ("drawn", "shown"),
    [
        ("╭─ ▸a │ b ─╮", "┌─ ►a │ b ─┐"),
        ("⠀⠉⣀⡇⢸⣿⠒⠤", " ▀▄▌▐█▀▄"),
        ("✖ ● ‹› – …", "x • <> - ."),
        ("plain ü", "plain ü"),
    ],
)
def test_a_console_gets_the_characters_that_its_font_has(monkeypatch, drawn: str, shown: str):
    console = Console(file=SimpleNamespace(write=lambda _: None), force_terminal=True, color_system=None)
    monkeypatch.setattr(Strip, "render", Strip.render)  # what is taught ends with the test
    visible_screen.teach(plain=True)
    strip = Strip([Segment(drawn, Style())])
    assert strip.render(console) == shown
    visible_screen.teach()
    assert Strip([Segment(drawn, Style())]).render(console) == drawn


def test_a_console_gets_no_bold_black_which_it_shows_as_grey(monkeypatch):
    console = Console(
        file=SimpleNamespace(write=lambda _: None), force_terminal=True, color_system="standard"
    )
    monkeypatch.setattr(Strip, "render", Strip.render)
    visible_screen.teach(plain=True)
    black = Style(bold=True, color="#000000", bgcolor="#55ffff")
    white = Style(bold=True, color="#ffffff", bgcolor="#0000aa")
    assert Strip([Segment("OK", black)]).render(console).startswith("\x1b[30;106mOK")
    assert Strip([Segment("OK", white)]).render(console).startswith("\x1b[1;97;44mOK")
    grey = Style(color="#555555", bgcolor="#00aaaa")
    assert Strip([Segment("CSV", grey)]).render(console).startswith("\x1b[30;46mCSV")
    on_black = Style(color="#555555", bgcolor="#000000")
    assert Strip([Segment("CSV", on_black)]).render(console).startswith("\x1b[90;40mCSV")
    visible_screen.teach()
    assert Strip([Segment("OK", black)]).render(console).startswith("\x1b[1;30;106mOK")


def test_every_character_of_the_frames_and_graphs_has_a_plain_one(monkeypatch):
    """What code page 437 has, nearly every font of a console has."""
    for character in map(chr, plain_characters.PLAIN):
        plain = character.translate(plain_characters.PLAIN)
        assert len(plain) == 1
        plain.replace("►", "").replace("◄", "").replace("•", "").encode(
            "cp437"
        )  # pictures of control characters
    monkeypatch.setenv("TERM", "linux")
    assert plain_characters.are_needed()
    monkeypatch.setenv("TERM", "xterm")
    assert not plain_characters.are_needed()
