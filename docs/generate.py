"""Writes the generated pages of docs/: `python -m docs.generate`. A test keeps them current.

Statements, functions and errors come from the help pages, the gallery from the examples' first comments.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.commands import BY_ID
from desire_tui.common.key_names import key_names
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.diagnostics.wording import all_wordings
from desire_tui.engine.integration.rules import markdown_table
from desire_tui.help.page_catalogue import topics
from desire_tui.panes.example_catalogue import CHAPTERS, Example, examples
from docs.editor_grammars import textmate, vim
from docs.man_page import man_page
from docs.python_reference import python_reference
from tests.programs.coverage import markdown as tested_where

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.help.page_catalogue import Topic

DOCS = Path(__file__).parent
EXAMPLES = DOCS.parent / "examples"
NOTE = "<!-- made by python -m docs.generate; edit the tables it reads, not this page -->"

RULES_BEGIN = "<!-- table of rules: made by python -m docs.generate from engine/integration/rules.py -->"
RULES_END = "<!-- end of the table of rules -->"

GALLERY = """\
{count} programs, one for every system of the book and more. Open them with F11 in the app, or by name:
`desire examples/ch2/lorenz.src`. The `--?` lines say what they must show; a test holds them to it."""

KINDS = """\
### Errors and warnings

A warning is legal but hardly meant, or says what a run took in place of a setting: it stops nothing, and
`desire check` ends with status 0 if there are no others. An error stops a program when the statement or the
segment that holds it is reached, error 1 at once. `compare` refuses what would be a warning elsewhere, as it
would compare with another run."""

DESKTOP = """\
![The desktop](pictures/main-160x50.svg)

All keys in one table, and how to change them: [keys](keys.md)."""


def statements() -> str:
    """Statements, commands and system variables, one section each."""
    parts = ["# Statements, commands, system variables", NOTE]
    titles = {
        "Script": ("script", "dialogue"),
        "DYNAMIC segments": ("DYNAMIC",),
        "System variables": ("variable",),
        "Command line": ("command",),
    }
    for title, kinds in titles.items():
        pages = sorted((p for p in topics().values() if p.kind in kinds), key=lambda p: p.name.casefold())
        parts += [f"## {title}", *(_section(page) for page in pages)]
    return "\n\n".join(parts) + "\n"


def functions() -> str:
    """All library functions: the table, then the pages that say more than it."""
    pages = [page for page in topics().values() if page.kind == "function"]
    overview = topics()["functions"]
    rest = [_section(page) for page in pages if page is not overview and (page.text or page.example)]
    return "\n\n".join(["# Library functions", NOTE, overview.text, *rest]) + "\n"


def errors() -> str:
    """All messages by number."""
    pages = [page for page in topics().values() if page.kind == "error"]
    intro = "Numbers below 400 are Desire's own. `…` stands for what the message fills in."
    sections = [_section(page) for page in pages]
    return "\n\n".join(["# Errors", NOTE, intro, *sections, KINDS, _kinds_of_problems()]) + "\n"


def _kinds_of_problems() -> str:
    """Return the table of all messages, each an error or a warning; notes at second places are neither."""
    every = sorted(
        (wording.code, wording.warning, key) for key, wording in all_wordings().items() if wording.code
    )
    rows = [
        f"| {code} | {'**warning**' if warning else 'error'} | {_cell(Diagnostic(key).message)} |"
        for code, warning, key in every
    ]
    return "\n".join(["| number | | message |", "| --- | --- | --- |", *rows])


def _cell(text: str) -> str:
    return text.replace("|", "&#124;")


def _section(page: Topic) -> str:
    """Return a help page as a section, its heading two levels down."""
    _, *rest = page.markdown.rstrip("\n").split("\n\n")
    return "\n\n".join([f"### {page.name}", *rest])


def desktop() -> str:
    """Return what the desktop does beyond the language, with its keys."""
    parts = ["# The desktop", NOTE, DESKTOP]
    for page in topics().values():
        if page.kind != "desktop":
            continue
        text = page.markdown.partition("\n\nSee also")[0].partition("\n\n")[2]
        parts.append(f"## {page.name.capitalize()}\n\n" + text.replace("*desktop*: ", "", 1).rstrip())
        rows = [
            f"| {key_names(BY_ID[name].keys)} | {BY_ID[name].title} | {BY_ID[name].help} |"
            for name in page.actions
        ]
        if rows:
            parts.append("\n".join(("| key | action | |", "| --- | --- | --- |", *rows)))
    return "\n\n".join(parts) + "\n"


def rules() -> str:
    """Return the page about integration rules, with the present table of rules; the rest is written there."""
    before, _, rest = (DOCS / "rules.md").read_text(encoding="utf-8").partition(RULES_BEGIN)
    _, _, after = rest.partition(RULES_END)
    return f"{before}{RULES_BEGIN}\n{markdown_table()}\n{RULES_END}{after}"


def gallery() -> str:
    """Every example with what it shows, and pictures of some."""
    every = examples(EXAMPLES)
    parts = ["# Examples", NOTE, GALLERY.format(count=len(every))]
    for folder, title in CHAPTERS.items():
        here = [example for example in every if example.folder == folder]
        parts += [f"## {here[0].chapter}. {title}", _list(here)]
        drawn = [e.name for e in here if (DOCS / "pictures" / f"{e.name}.png").exists()]
        parts += [f"![{name}](pictures/{name}.png)\n*{name}*" for name in drawn]
    return "\n\n".join(parts) + "\n"


def _list(programs: Iterable[Example]) -> str:
    rows = []
    for program in programs:
        about = program.about.replace("|", "\\|").replace("*", "\\*")
        rows.append(f"| [{program.name}](../examples/{program.folder}/{program.path.name}) | {about} |")
    return "\n".join(["| program | |", "| --- | --- |", *rows])


def coverage() -> str:
    """Return the table of what is tested where."""
    return tested_where()


PAGES: dict[str, Callable[[], str]] = {
    "statements.md": statements,
    "functions.md": functions,
    "errors.md": errors,
    "desktop.md": desktop,
    "rules.md": rules,
    "examples.md": gallery,
    "coverage.md": coverage,
    "desire.1": man_page,
    "../editors/vscode/syntaxes/desire.tmLanguage.json": textmate,
    "../editors/neovim/syntax/desire.vim": vim,
    "python_reference.md": lambda: python_reference(NOTE),
}


def main() -> None:
    """Write all pages."""
    for name, page in PAGES.items():
        (DOCS / name).write_text(page(), encoding="utf-8")
        sys.stdout.write(f"docs/{name}\n")


if __name__ == "__main__":
    main()
