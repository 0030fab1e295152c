"""The table docs/coverage.md: for every statement, form, function and command the programs or tests that hold it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.help.page_catalogue import topics
from tests.programs.expectations import read_expectations
from tests.programs.facts_of_the_original import FACTS
from tests.programs.features import DYNAMIC, FUNCTIONS, SCRIPT, features

if TYPE_CHECKING:
    from desire_tui.help.page_catalogue import Topic

ROOT = Path(__file__).parents[2]
INTRODUCTION = """\
Every row is a statement, form, function or command of [the language](language.md), with programs that use it and check
what it does, on both back ends. Functions are also compared with other formulas, in scripts, in segments and element by
element, by `tests/programs/test_functions.py`. Made by `python -m docs.generate`."""
SHOWN = 3
"""Programs named for each row."""


def command_tests() -> dict[str, list[str]]:
    """Return for every command the test files that give it: as a quoted line, alone or with an argument."""
    paths = sorted(ROOT.glob("tests/*/test_*.py"), key=lambda path: (path.name != "test_commands.py", path))
    files = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in paths}
    pages = [page for page in topics().values() if page.kind == "command"]
    return {page.name: [name for name in files if _holds(files[name], page)][:1] for page in pages}


def _holds(text: str, page: Topic) -> bool:
    return any(_gives(text, word) for word in (page.name, *page.words))


def _gives(text: str, word: str) -> bool:
    """Whether a test's text holds the command; pausing is no word but a method of the session."""
    return (word == "pause" or word in text) and bool(
        re.search(
            r"\.pause\(\)" if word == "pause" else rf"""["']{re.escape(word)}(?:["']| ["'#*\w])""", text
        )
    )


def programs() -> dict[str, str]:
    """Return every program that checks something, by its name in the table; small test programs first."""
    paths = [*sorted(ROOT.glob("tests/programs/*/*.src")), *sorted(ROOT.glob("examples/**/*.src"))]
    found = {
        str(p.relative_to(ROOT)): p.read_text(encoding="utf-8") for p in paths if p.parent.name != "errors"
    }
    pages = {f"help page `{page.name}`": page.example for page in topics().values() if page.prints}
    return {**{name: text for name, text in found.items() if _checks(text)}, **pages}


def _checks(text: str) -> bool:
    expected = read_expectations(text)
    return bool(expected.checks or expected.prints or expected.console or expected.error)


def users() -> tuple[dict[str, list[str]], dict[str, list[str]]]:
    """Return the programs that use each row of SCRIPT and of DYNAMIC, functions included."""
    script: dict[str, list[str]] = {row: [] for row in (*SCRIPT, *FUNCTIONS)}
    dynamic: dict[str, list[str]] = {row: [] for row in (*DYNAMIC, *FUNCTIONS)}
    for name, text in programs().items():
        for table, used in zip((script, dynamic), features(parse(Source(text, name))), strict=True):
            for row in used & table.keys():
                table[row].append(name)
    return script, dynamic


def markdown() -> str:
    """Return the table as a page."""
    script, dynamic = users()
    lines = [
        "# What is tested where",
        "",
        INTRODUCTION,
    ]
    for title, table, rows in (("Script", script, SCRIPT), ("DYNAMIC segments", dynamic, DYNAMIC)):
        lines += ["", f"## {title}", "", "| statement | programs |", "| --- | --- |"]
        lines += [f"| `{row}` | {_some(table[row])} |" for row in rows]
    lines += ["", "## Functions", "", "| function | programs |", "| --- | --- |"]
    lines += [f"| `{row}` | {_some([*script[row], *dynamic[row]])} |" for row in FUNCTIONS]
    lines += ["", "## Commands", "", "| command | tests |", "| --- | --- |"]
    lines += [f"| `{name}` | {_some(where)} |" for name, where in command_tests().items()]
    lines += ["", "## Programs of the original", "", "| fact | programs |", "| --- | --- |"]
    for fact in FACTS:
        names = [f"original/{name}" for name in fact.first] + list(fact.programs)
        lines.append(f"| {fact.title} | {', '.join(name.removeprefix('../../') for name in names)} |")
    return "\n".join(lines) + "\n"


def _some(names: list[str]) -> str:
    return ", ".join(list(dict.fromkeys(names))[:SHOWN])
