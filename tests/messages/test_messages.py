"""Golden messages: every file holds a program and what the user sees for it, next to each other.

Drop a file `NAME.txt` into `tests/messages/<stage>/`; no code is needed. The folder says which stage speaks:

    parse   engine.syntax.parse, then engine.structure (all problems, in the order of their places)
    check   what `desire check` and the editor show: parse, then engine.check
    run     a fresh Session runs the text as `erun` does; the DesireError that ends it is shown, and before it
            everything that was reported without stopping (warnings)

A file:

    what it shows, in a sentence or two
    ===== program
    x = (3 + 4
    ===== messages
    program.src:1:11: error 7: a parenthesis is not closed
        x = (3 + 4
                  ^
    hint: add )

Optional sections between program and messages: `===== input` (lines that answer the script's `input`),
`===== go` (empty: a STOP is answered with go; n lines: n times), `===== command` (command lines that run after
the program, each whatever became of those before: their messages are shown under the name `<command>`).
Files are read and written in a folder of the test's own, shown as `<folder>`, the one above as `<above>`; steps too
small to mean anything as `<tiny>`.
A program that must show nothing has an empty last section. Write the expected text yourself and look at the
difference; `UPDATE_MESSAGES=1 pytest tests/messages` writes the present output into all files: review it with
`git diff` before you commit.
"""

from __future__ import annotations

import os
import re
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import pytest

from desire_tui.engine.diagnostics import DesireError, Diagnostic, render_all
from desire_tui.engine.source import Source

if TYPE_CHECKING:
    from collections.abc import Callable

HERE = Path(__file__).parent
VANISHING_STEP = re.compile(r"DT = [\d.]+e-(1[5-9]|[2-9]\d)\b")
"""Where a solver gave up is rounding's business, which differs between processors."""
STAGES = ("parse", "check", "run")
FILES = sorted(path for stage in STAGES for path in (HERE / stage).glob("*.txt"))


def sections(text: str) -> dict[str, str]:
    """Split a golden file at its `===== name` lines; the text above the first is its title."""
    found = {"title": ""}
    name = "title"
    for line in text.splitlines(keepends=True):
        if line.startswith("===== "):
            name = line[6:].strip()
            found[name] = ""
        else:
            found[name] += line
    return found


def by_place(problems: list[Diagnostic]) -> list[Diagnostic]:
    return sorted(problems, key=lambda problem: problem.span or (0, 0))


def messages_of_parse(parts: dict[str, str], source: Source, folder: Path) -> list[Diagnostic]:
    from desire_tui.engine.structure.structure import structure
    from desire_tui.engine.syntax.parse import parse

    del parts, folder
    program = parse(source)
    return by_place([*program.problems, *structure(program).problems])


def messages_of_check(parts: dict[str, str], source: Source, folder: Path) -> list[Diagnostic]:
    from desire_tui.engine.session.session import Session

    del parts
    return by_place(list(Session(folder=folder).check(source)))


def messages_of_run(parts: dict[str, str], source: Source, folder: Path) -> list[Diagnostic]:
    from desire_tui.engine.session.listener import Listener
    from desire_tui.engine.session.session import Session

    answers = iter(parts.get("input", "").splitlines())
    shown: list[Diagnostic] = []

    class Console(Listener):
        def ask(self, prompt: str) -> str:
            del prompt
            try:
                return next(answers)
            except StopIteration:
                raise EOFError from None

        def problems(self, diagnostics) -> None:
            shown.extend(diagnostics)

    session = Session(Console(), folder=folder)

    def attempt(work: Callable[[], object]) -> None:
        try:
            work()
        except DesireError as error:
            shown.extend(problem.within(source) for problem in error.diagnostics)

    def program() -> None:
        session.erun(source)
        for _ in range(max(1, len(parts["go"].splitlines())) if "go" in parts else 0):
            session.go()

    attempt(program)
    for line in parts.get("command", "").splitlines():
        attempt(lambda line=line: session.execute(line))
    return shown


SPEAKERS = {"parse": messages_of_parse, "check": messages_of_check, "run": messages_of_run}


@cache
def spoken(path: Path) -> tuple[str, frozenset[str], frozenset[tuple[str, str]]]:
    """Return what the user sees for a golden file's program, the keys of all messages and notes, problems' severities."""
    parts = sections(path.read_text("utf-8"))
    source = Source(parts["program"].removesuffix("\n"), "program.src")
    with TemporaryDirectory() as name:
        folder = Path(name).resolve() / "program"
        folder.mkdir()
        problems = SPEAKERS[path.parent.name](parts, source, folder)
        shown = render_all(problems).replace(str(folder), "<folder>").replace(str(folder.parent), "<above>")
        shown = VANISHING_STEP.sub("DT = <tiny>", shown)
    keys: set[str] = set()
    rest = list(problems)
    while rest:
        problem = rest.pop()
        keys.add(problem.key)
        rest.extend(problem.related)
    severities = frozenset((problem.key, problem.severity) for problem in problems)
    return (f"{shown}\n" if shown else ""), frozenset(keys), severities


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_message(path: Path) -> None:
    text = path.read_text("utf-8")
    shown, _, _ = spoken(path)
    if os.environ.get("UPDATE_MESSAGES"):
        head = text[: text.index("===== messages\n") + len("===== messages\n")]
        path.write_text(head + shown, "utf-8")
        return
    assert shown == sections(text)["messages"]


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_file_is_complete(path: Path) -> None:
    parts = sections(path.read_text("utf-8"))
    assert parts["title"].strip(), "say in the first line what the file shows"
    assert set(parts) <= {"title", "program", "input", "go", "command", "messages"}
    assert {"program", "messages"} <= set(parts)
