"""Text as it may be shown."""

from __future__ import annotations

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.cells import cell_len

from desire_tui.engine.visible_text import visible, visible_line

CONTROL = ("Cc", "Cf", "Cs", "Zl", "Zp")
ANYTHING = st.text(st.characters(codec=None) | st.characters(categories=CONTROL))


def hidden(text: str) -> list[str]:
    return [character for character in text if unicodedata.category(character) in CONTROL]


@given(ANYTHING)
def test_nothing_hidden_is_left_and_every_column_stays(text):
    shown, line = visible(text), visible_line(text)
    assert set(hidden(shown)) <= {"\t", "\n"}
    assert not hidden(line)
    assert len(shown) == len(line) == len(text)
    assert visible(shown) == shown
    assert visible_line(line) == line
    shown.encode()
    for before, after in zip(text, line, strict=True):
        assert after == before if before not in hidden(text) else cell_len(after) == 1


@given(
    st.text(
        st.characters(categories=("L", "N", "P", "S", "Zs"), exclude_characters="\u115f\u1160\u3164\uffa0")
    )
)
def test_plain_text_is_unchanged(text):
    assert visible(text) == visible_line(text) == text


def test_every_character_of_the_hidden_kinds_is_known():
    for code in range(0x110000):
        character = chr(code)
        if unicodedata.category(character) in CONTROL and character not in "\t\n":
            assert visible(character) != character, hex(code)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("\x1b]0;t\x07", "␛]0;t␇"), ("a\x7f", "a␡"), ("\x9b1m", "�1m"), ("\u202egpj", "�gpj"), ("a\u200bb", "a�b"),
        ("\ud800", "�"), ("a\tb\nc\r", "a\tb\nc␍"), ("ärger ≤ 漢字 é", "ärger ≤ 漢字 é"),
    ],
)  # fmt: skip
def test_examples(text, shown):
    assert visible(text) == shown
