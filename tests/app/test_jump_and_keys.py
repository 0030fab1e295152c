"""Jump mode, the sheet of keys, themes in the palette, and the key that some terminals send for another."""

from __future__ import annotations

from textual.geometry import Offset
from textual.widgets import Label, OptionList

from desire_tui.actions.jump import JumpScreen
from desire_tui.commands import COMMANDS
from desire_tui.desktop.palette_colours import PaletteColours
from desire_tui.desktop.themed_app import remembered
from desire_tui.editor.tab_strip import TabStrip
from desire_tui.panes.key_sheet import KeySheet, entries, found
from desire_tui.panes.own_keys import OWN_KEYS

from .conftest import OSCILLATOR, desktop


async def test_a_letter_goes_to_a_pane_or_tab(program, monkeypatch):
    """At once: no letter waits until somebody's patience is over."""
    monkeypatch.setattr("desire_tui.desktop.key_ordering.PATIENCE_S", 1e9)
    paths = [program("x = 1\n", f"{name}.src") for name in ("one", "two")]
    async with desktop(*paths, size=(120, 40)) as desk:
        app = desk.app
        for letter, focused in (
            ("g", lambda: app.graph), ("e", lambda: app.editor.front), ("c", lambda: app.command.prompt),
            ("q", lambda: app.quantities.table),
        ):  # fmt: skip
            await desk.press("alt+j")
            await desk.until(lambda: isinstance(app.screen, JumpScreen) and app.screen.query(Label))
            await desk.press(letter)
            await desk.until(lambda: app.screen is app.main_screen)
            assert app.focused is focused(), letter
        await desk.press("alt+j", "s")
        await desk.until(lambda: app.editor.front.buffer.name == "two.src")
        assert app.focused is app.editor.front
        await desk.press("alt+j")
        await desk.until(lambda: isinstance(app.screen, JumpScreen) and app.screen.query(Label))
        texts = {label.region.offset: str(label.content) for label in app.screen.query(Label)}
        strip = app.editor.query_one(TabStrip)
        assert texts[Offset(strip.region.x + strip.places()[0][1], strip.region.y)] == "a"
        await desk.press("escape")
        await desk.until(lambda: app.screen is app.main_screen)
        await desk.press("alt+j", "p")
        await desk.until(lambda: app.main_screen.side == "problems")


async def test_the_sheet_of_keys_is_searched_and_carries_out(program):
    async with desktop(program(OSCILLATOR), size=(80, 24)) as desk:
        app = desk.app
        await desk.press("shift+f1")
        await desk.until(lambda: isinstance(app.screen, KeySheet) and app.screen.focused)
        sheet = app.screen
        assert sheet.size == (80, 24)
        await desk.press(*"slider")
        shown = str(sheet.query_one("#keys-sheet").content)
        assert "Live mode" in shown
        assert "Save" not in shown
        assert "slider" in str(sheet.query_one("#keys-about").content)
        await desk.press("escape")
        await desk.until(lambda: app.screen is app.main_screen)
        await desk.line("keys")
        await desk.until(lambda: isinstance(app.screen, KeySheet) and app.screen.focused)
        await desk.press(*"quantities", "enter")
        await desk.until(lambda: app.main_screen.side == "quantities")


def test_the_sheet_has_every_key_and_those_the_user_changed():
    rows = entries({"run.start": "alt+1"}, OWN_KEYS)
    assert {row.command_id for row in rows} >= {command.id for command in COMMANDS if command.keys}
    assert any(row.keys == "Alt+1" and row.command_id == "run.start" for row in rows)
    assert [row.title for row in found(rows, "alt+j")] == ["Jump"]
    assert {row.keys for row in found(rows, "crosshair")} == {"Alt+R", "R"}
    assert found(rows, "no such key") == []
    assert [(row.part, row.keys) for row in found(rows, "wider range")] == [("on a slider", "+, =")]
    slider = {row.title: row.keys for row in rows if row.part == "on a slider"}
    assert slider["Write into the program"] == "W"
    assert slider["Back to the program's value"] == "Home, 0"


def shown_colours(palette):
    """Return how the letters found and the descriptions are drawn."""
    spans = [s for o in palette.query_one(OptionList).options for s in o.prompt.spans]
    found, described = palette.query_one(OptionList).options[0].prompt.spans[0].style, None
    described = next((s.style for s in spans if s.style != found), PaletteColours.of(palette).described)
    return PaletteColours(found, described)


async def test_the_palette_shows_a_theme_while_it_is_marked(program):
    async with desktop(program("x = 1\n")) as desk:
        app = desk.app
        for ending, theme in (("escape", "dark"), ("enter", "nord")):
            await desk.press("ctrl+p", *"theme: nord")
            await desk.until(lambda: app.screen.query_one(OptionList).option_count)
            await desk.press("down")
            await desk.until(lambda: app.theme == "nord")
            await desk.until(lambda: shown_colours(app.screen) == PaletteColours.of(app.screen))
            await desk.press(ending)
            await desk.until(lambda: app.screen is app.main_screen and app.theme == theme)  # noqa: B023
        await desk.until(lambda: remembered().get("theme") == "nord")


async def test_alt_f_goes_a_word_to_the_right_in_a_text_and_fits_elsewhere(program):
    async with desktop(program("alpha beta\n")) as desk:
        app = desk.app
        await desk.press("alt+e", "ctrl+home", "alt+f")
        assert app.editor.front.cursor_location == (0, 5)
        assert app.graph.fit.wanted is None
        app.command.prompt.focus()
        await desk.press(*"a b", "home", "alt+f")
        assert app.command.prompt.cursor_position == 2
        await desk.press("end", "alt+f")
        assert app.graph.fit.wanted
        app.graph.fit.wanted = None
        await desk.press("alt+e", "shift+f7")
        assert app.graph.fit.wanted
