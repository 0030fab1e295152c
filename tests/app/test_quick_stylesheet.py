"""Quicker ways to a widget's styles and to the screen's lines give what Textual's own give."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from textual._compositor import Compositor
from textual.css.stylesheet import Stylesheet
from textual.strip import Strip
from textual.widgets import Static

from tests.app.conftest import desktop

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.app import App
    from textual.dom import DOMNode
    from textual.widget import Widget

STATES = {
    "at the start": (),
    "find bar": ("ctrl+f",),
    "help": ("f1",),
    "list of actions": ("ctrl+p",),
    "examples": ("f11",),
}
"""Keys that open what has styles of its own."""


def styles(widget: Widget, apply: Callable[[DOMNode], None]) -> dict[str, object]:
    """Return what a style sheet gives a widget, its parts, and what it notes."""
    for node in (widget, *widget._component_styles.values()):
        (node.styles.base if node is widget else node.base).reset()
    apply(widget)
    parts = {
        name: repr(sorted(part.base.get_rules().items())) for name, part in widget._component_styles.items()
    }
    notes = (
        widget._has_hover_style, widget._has_focus_within, widget._has_order_style, widget._has_odd_or_even,
    )  # fmt: skip
    return {"": repr(sorted(widget.styles.base.get_rules().items())), "notes": notes, **parts}


def textual_s(app: App[None]) -> Stylesheet:
    """Return Textual's style sheet with the app's rules."""
    sheet = Stylesheet()
    sheet._rules = app.stylesheet.rules
    return sheet


def by_name(sheet: Stylesheet) -> dict[str, list[int]]:
    """Return which rule objects can choose nodes of each name."""
    return {name: [id(rule) for rule in rules] for name, rules in sheet.rules_map.items()}


def lines(app: App[None], render: Callable[..., list[dict[int, Strip]]]) -> list[list[object]]:
    """Return the segments of each of the screen's rows."""
    compositor = app.screen._compositor
    rows = render(compositor, compositor.size.region, lambda _: True)
    return [list(Strip.join(row.values()).simplify()) for row in rows]


@pytest.mark.parametrize("keys", STATES.values(), ids=STATES.keys())
async def test_styles_and_lines_are_those_of_textual(keys: tuple[str, ...]) -> None:
    async with desktop() as desk:
        await desk.press(*keys)
        await desk.pilot.pause()
        app = desk.app
        assert lines(app, type(app.screen._compositor)._render_chops) == lines(app, Compositor._render_chops)
        sheet, plain = app.stylesheet, textual_s(app)
        assert by_name(sheet) == by_name(plain)
        for widget in app.screen.walk_children(with_self=True):
            wanted = styles(widget, plain.apply)
            for _ in range(2):  # found, and remembered
                assert styles(widget, sheet.apply) == wanted, widget


async def test_what_comes_after_other_colours_is_found_with_what_was_there() -> None:
    async with desktop() as desk:
        desk.app.theme = "light"
        await desk.pilot.pause()
        assert by_name(desk.app.stylesheet) == by_name(textual_s(desk.app))
        await desk.press("ctrl+p")  # brings rules of its own
        assert by_name(desk.app.stylesheet) == by_name(textual_s(desk.app))


async def test_initial_gives_the_word_to_whoever_else_says_something() -> None:
    class Plain(Static):
        DEFAULT_CSS = "Plain { width: 7; height: initial; color: red; } Plain.-a { width: initial; }"

    async with desktop() as desk:
        sheet = desk.app.stylesheet
        sheet.add_source(
            "Plain { width: initial; } Plain.-b { color: initial; } Plain.-b { height: 3; }", ("user", "")
        )
        for classes in ("", "-a", "-b", "-a -b"):
            widget = Plain("x", classes=classes)
            await desk.app.screen.mount(widget)
            wanted = styles(widget, textual_s(desk.app).apply)
            assert styles(widget, sheet.apply) == wanted
