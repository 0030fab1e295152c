"""The ready-made settings: they start the server that there is, and their grammar knows the language's words."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from desire_tui.cli import main
from desire_tui.engine.syntax.words import KEYWORDS

EDITORS = Path(__file__).parents[2] / "editors"
GRAMMAR = json.loads((EDITORS / "vscode" / "syntaxes" / "desire.tmLanguage.json").read_text(encoding="utf-8"))


def test_the_settings_start_the_server():
    assert "lsp" in main.commands
    package = json.loads((EDITORS / "vscode" / "package.json").read_text(encoding="utf-8"))
    assert package["contributes"]["configuration"]["properties"]["desire.command"]["default"] == [
        "desire",
        "lsp",
    ]
    assert '{ "desire", "lsp" }' in (EDITORS / "neovim" / "ftplugin" / "desire.lua").read_text(
        encoding="utf-8"
    )
    assert '"desire" "lsp"' in (EDITORS / "emacs" / "desire-mode.el").read_text(encoding="utf-8")
    helix = (EDITORS / "helix" / "languages.toml").read_text(encoding="utf-8")
    assert 'command = "desire"\nargs = ["lsp"]' in helix


def scopes(line):
    """Colour a line as TextMate does: the first rule that matches earliest wins, then on behind it."""
    found, at = [], 0
    while at < len(line):
        matches = [(m.start(), n, m) for n, rule in enumerate(GRAMMAR["patterns"])
                   if (m := re.compile(rule["match"]).search(line, at)) and m.end() > m.start()]  # fmt: skip
        if not matches:
            break
        _, number, match = min(matches, key=lambda one: one[:2])
        rule = GRAMMAR["patterns"][number]
        parts = [("name", match[0])] if "name" in rule else [
            (group, match[int(group)]) for group in rule["captures"] if match[int(group)]]  # fmt: skip
        for group, text in parts:
            name = rule["name"] if group == "name" else rule["captures"][group]["name"]
            found.append((text, name.removesuffix(".desire")))
        at = match.end()
    return found


@pytest.mark.parametrize("word", sorted(KEYWORDS))
def test_every_keyword_is_one_where_a_statement_begins(word):
    assert (word, "keyword.control") in scopes(f"{word} x")
    assert (word, "keyword.control") in scopes(f"y = 1 | {word} x")
    assert (word, "keyword.control") not in scopes(f"{word} = 2")
    assert (word, "keyword.control") not in scopes(f"y = {word}")


def test_a_line_has_its_colours():
    assert scopes("210 d/dt x = -sin(t)*2e-3 | if x > 0 then go to 20 -- 'why'") == [
        ("210", "comment.line-number"), ("d/dt", "keyword.control"), ("x", "variable.other"),
        ("=", "keyword.operator"), ("-", "keyword.operator"), ("sin", "support.function"),
        ("t", "support.variable"), ("*", "keyword.operator"), ("2e-3", "constant.numeric"),
        ("|", "keyword.operator"), ("if", "keyword.control"), ("x", "variable.other"),
        (">", "keyword.operator"), ("0", "constant.numeric"), ("then", "keyword.operator.word"),
        ("go to", "keyword.control"), ("20", "constant.numeric"), ("-- 'why'", "comment.line.double-dash"),
    ]  # fmt: skip
