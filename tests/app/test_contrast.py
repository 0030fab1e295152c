"""Every text that a theme puts on the screen can be read: WCAG's contrast ratio of what is really drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from textual.color import Color
from textual.widgets import Input

from desire_tui.common import themes
from desire_tui.common.dialogs import Choice, LineDialog

from .conftest import OSCILLATOR, Desktop, desktop

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rich.style import Style

READABLE = 4.5
"""WCAG 2.2, 1.4.3 (AA): text. Bold text of a terminal counts as text of ordinary size."""
GRAPHICS = 3.0
"""WCAG 2.2, 1.4.11: lines, frames, curves."""
LINES = set("─│┌┐└┘├┤┬┴┼━╸╺┃▁▂▃▄▅▆▇█▉▊▋▌▍▎▏▔▕▐▀▊●■·╮╭╯╰╱╲▸✖⚠✓") | {
    chr(code) for code in range(0x2800, 0x2900)
}


def luminance(color: Color) -> float:
    parts = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in color.normalized]
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]


def contrast(one: Color, other: Color) -> float:
    """WCAG's contrast ratio, 1 … 21."""
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def test_the_ratio_is_wcags():
    assert contrast(Color.parse("#000"), Color.parse("#fff")) == pytest.approx(21)
    assert contrast(Color.parse("#777"), Color.parse("#fff")) == pytest.approx(
        4.48, abs=0.005
    )  # the known near miss


def drawn(style: Style) -> tuple[Color, Color]:
    """Return the colours of text and ground that the terminal gets."""
    assert style.color is not None
    assert style.bgcolor is not None
    text, ground = Color.from_rich_color(style.color), Color.from_rich_color(style.bgcolor)
    if style.dim:
        text = ground.blend(text, 0.5)
    return (ground, text) if style.reverse else (text, ground)


def texts(desk: Desktop) -> Iterator[tuple[str, Style]]:
    """Every piece of text of the screen with the style it is drawn in; under a dialog only the dialog's."""
    screen = desk.app.screen
    inside = screen.region if screen is desk.app.main_screen else screen.children[0].region
    for y, strip in enumerate(screen._compositor.render_strips()):
        x = 0
        for segment in strip:
            if segment.text.strip() and segment.style is not None and inside.contains(x, y):
                yield segment.text.strip(), segment.style
            x += segment.cell_length


def hard_to_read(desk: Desktop) -> dict[tuple[str, str], str]:
    """Return the pairs of colours whose contrast is too low, with a word on each."""
    found = {}
    for text, style in texts(desk):
        if style.color is None or style.bgcolor is None:
            continue
        colour, ground = drawn(style)
        ratio = contrast(colour, ground)
        if ratio < (GRAPHICS if set(text) <= LINES | {" "} else READABLE):
            found[colour.hex, ground.hex] = f"{colour.hex} on {ground.hex}, {ratio:.2f}: {text[:30]!r}"
    return found


PROGRAM = """\
-- every kind of word: comment, number 12.5, text, function, system variable
TMAX = 6 | DT = 0.001 | NN = 301
ARRAY A[3]
x = 1 | w = sqrt(1) | message$ = 'text'
display N14 | drun
write 'x = '; x
DYNAMIC
d/dt x = v
d/dt v = -w*w*x + rr
dispt x, v
"""


@pytest.mark.parametrize("theme", [*themes.NAMES, "sixteen"])
async def test_every_text_on_the_screen_can_be_read(program, monkeypatch, theme: str):
    if theme == "sixteen":
        monkeypatch.delenv("COLORTERM")
        monkeypatch.setenv("TERM", "linux")
        theme = "dark"
    found: dict[tuple[str, str], str] = {}
    async with desktop(program(PROGRAM), size=(120, 40)) as desk:

        async def look(where: str) -> None:
            await desk.pilot.pause()
            desk.app.graph.tick()
            await desk.pilot.pause()
            for pair, sentence in hard_to_read(desk).items():
                found.setdefault(pair, f"{where}: {sentence}")

        desk.app.theme = theme
        await look("before a run")
        await desk.press("f5")
        await desk.idle()
        await look("a failed run")
        await desk.do("view.problems")
        await look("problems")
        await desk.do("file.new")
        desk.app.editor.front.load_text(OSCILLATOR.replace("x = 1", "x = 1 | w = 1"))
        await desk.press("f5")
        await desk.idle()
        await look("a run")
        desk.app.editor.front.focus()
        desk.app.editor.front.select_all()
        await look("a selection")
        await desk.do("edit.find", "x")
        await look("find")
        await desk.do("edit.replace", "x")
        await look("replace")
        await desk.press("escape")
        await desk.do("run.live", "w")
        await look("live")
        desk.app.quantities.table.focus()
        await desk.press("enter")
        await look("editing a quantity")
        await desk.press("escape")
        await desk.do("graph.read")
        await look("the read-out")
        await desk.do("help.word", "dispt")
        await look("help")
        desk.app.help_pane.query_one(Input).value = "integration"
        await look("search in help")
        await desk.do("view.search_output")
        await look("search in the output")
        await desk.press("escape")
        desk.app.command.keep_pending(["a = ", "b = 2"])
        desk.app.notify("a notice", severity="information")
        desk.app.notify("a warning", severity="warning")
        desk.app.notify("an error", severity="error")
        await look("notices")
        for dialog in (Choice("Title", "A question", ("Yes", "No")), LineDialog("Title", "value", "a hint")):
            desk.app.push_screen(dialog)  # type: ignore[arg-type]
            await look(type(dialog).__name__)
            await desk.press("escape")
        await desk.do("view.palette")
        await desk.pilot.pause(0.3)
        await look("palette")
        await desk.press("escape")
        desk.app.editor.front.focus()
        await desk.press("ctrl+end", "s", "i")
        await desk.do("edit.complete")
        await look("completion")
    assert not found, "\n".join(found.values())


@pytest.mark.parametrize("theme", themes.THEMES, ids=lambda theme: theme.name)
def test_every_colour_of_a_theme_can_be_read_on_its_grounds(theme):
    for ground in (theme.surface, theme.background, theme.panel):
        for colour in (
            theme.foreground,
            theme.primary,
            theme.accent,
            theme.error,
            theme.warning,
            themes.quiet(theme),
        ):
            assert contrast(Color.parse(str(colour)), Color.parse(str(ground))) >= READABLE, (colour, ground)


@pytest.mark.parametrize(
    "theme", [*themes.THEMES, themes.SIXTEEN_DARK, themes.SIXTEEN_LIGHT], ids=lambda theme: theme.name
)
def test_every_colour_of_the_editor_can_be_read(theme):
    for ground in (theme.surface, theme.background):
        for name, style in themes.editor_theme(theme).syntax_styles.items():
            if style.color is not None:
                ratio = contrast(Color.from_rich_color(style.color), Color.parse(str(ground)))
                assert ratio >= READABLE, (name, ground, ratio)
