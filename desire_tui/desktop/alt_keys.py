"""Keys that Textual's parser does not know: Ctrl+Insert, and Alt with another key.

Alt comes from terminals without kitty's protocol as Escape and the character. Textual takes most of these for
what a Mac's Option key makes of them (Alt+0 was `º`, Alt+= `≠`, Alt+- `–`), the others for the bare sign, and
Alt+Backspace for Ctrl+W, which closes a tab here. Some terminals send Alt+B and Alt+F for Alt with an arrow:
Alt+B stays a word to the left, Alt+F is one to the right inside a text. With other letters Textual waits
0.1 s for more to come, and takes both apart if it does.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

from textual._ansi_sequences import ANSI_SEQUENCES_KEYS
from textual.keys import _character_to_key
from textual.widgets import Input, TextArea

if TYPE_CHECKING:
    from textual.widget import Widget

CHARACTERS = "0123456789-=+,.;:/'`~!@#$%&*()<>?|{}acdefghijklmnopqrstuvwxyz"
"""Not those that begin longer sequences."""


def teach() -> None:
    """Let Textual's parser know these keys."""
    table = cast("dict[str, Any]", ANSI_SEQUENCES_KEYS)
    for character in CHARACTERS:
        table[f"\x1b{character}"] = (SimpleNamespace(value=f"alt+{_character_to_key(character)}"),)
    table["\x1b[2;5~"] = (SimpleNamespace(value="ctrl+insert"),)
    table["\x1b\x7f"] = (SimpleNamespace(value="alt+backspace"),)


def is_word_right(focused: Widget | None) -> bool:
    """Whether Alt+F, which some terminals send for Alt and the right arrow, can mean a word to the right."""
    if isinstance(focused, Input):
        return focused.cursor_position < len(focused.value)
    return isinstance(focused, TextArea)
