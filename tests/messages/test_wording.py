"""All messages together: numbers, hints, tone, and that every message of the syntax stage is shown by a file."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from desire_tui.engine.diagnostics.wording import all_wordings
from desire_tui.engine.diagnostics.wording.syntax import MESSAGES

HERE = Path(__file__).parent
TOO_BIG = {"line-too-long"}
"""Needs a megabyte of text: tests/syntax/test_limits.py shows it."""

SECOND_PLACES = {key for key in MESSAGES if key.startswith(("first-", "block-begins"))}
"""Sentences for notes under another message."""


@pytest.mark.parametrize("key", sorted(all_wordings()))
def test_sentence(key: str) -> None:
    wording = all_wordings()[key]
    assert wording.code > 0 or wording.message.endswith("here"), "only a second place needs no number"
    assert wording.message
    assert not wording.message.endswith("."), "one sentence, no full stop"
    assert not re.search(r"\b(illegal|invalid)\b", wording.message), "say what is wrong, not that it is"


def test_every_syntax_message_is_shown() -> None:
    shown = "\n".join(path.read_text("utf-8") for path in (HERE / "parse").glob("*.txt"))
    missing = []
    for key, wording in MESSAGES.items():
        if key in TOO_BIG:
            continue
        pattern = "".join(
            ".*" if part.startswith("{") else re.escape(part)
            for part in re.split(r"(\{\w+\})", wording.message)
        )
        kind = "note" if key in SECOND_PLACES else f"error {wording.code}"
        if not re.search(f"{kind}: {pattern}$", shown, re.MULTILINE):
            missing.append(key)
    assert not missing
