"""Builds and finds the help pages."""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib.resources import files
from typing import Any, Literal

from desire_tui.engine.data_classes import dataclass

Kind = Literal["script", "DYNAMIC", "dialogue", "command", "variable", "function", "desktop", "error"]
"""Where a topic belongs. `script` statements are commands too; `dialogue` ones talk to files or the user."""

HEADINGS: dict[Kind, str] = {
    "script": "script",
    "dialogue": "script",
    "DYNAMIC": "DYNAMIC segments",
    "command": "command line",
    "variable": "system variable",
    "function": "library function",
    "desktop": "desktop",
    "error": "message",
}


@dataclass(frozen=True, slots=True)
class Topic:
    """A help page. `example` is a complete program, `prints` its console output; tests hold them to it."""

    name: str
    kind: Kind
    summary: str
    words: tuple[str, ...] = ()
    syntax: tuple[str, ...] = ()
    text: str = ""
    example: str = ""
    prints: str = ""
    see: tuple[str, ...] = ()
    also: str = ""
    """Words that people may search it by."""
    leads: tuple[str, ...] = ()
    """Words that lead here where no other page has them; not offered as words of a program."""
    actions: tuple[str, ...] = ()
    """Actions of the desktop that it is about."""

    @property
    def markdown(self) -> str:
        """The page."""
        parts = [f"# {self.name}", f"*{HEADINGS[self.kind]}*: {self.summary}"]
        if self.syntax:
            parts.append("\n".join(("```", *self.syntax, "```")))
        if self.text:
            parts.append(self.text)
        if self.example:
            parts.append(f"Example:\n\n```desire\n{self.example}\n```")
        if self.prints:
            parts.append(f"prints\n\n```\n{self.prints}\n```")
        if self.see:
            parts.append("See also: " + ", ".join(f"`{word}`" for word in self.see))
        return "\n\n".join(parts) + "\n"


_WRITTEN = (
    "script", "runs", "dynamic", "vectors", "display", "files", "commands", "desktop", "analysis", "fits",
)  # fmt: skip


@cache
def topics() -> dict[str, Topic]:
    """Every page by its name: statements first, then variables and commands, functions, errors by number."""
    pages = [*_written(), *_functions(), *_errors()]
    table = {page.name: page for page in pages}
    assert len(table) == len(pages), "two help pages of one name"
    return table


def find(word: str) -> Topic | None:
    """Return the page of a word as it stands in a program, or of `200` or `error 200`; None if there is none.

    Case decides where it must (`dispxy`, `DISPXY`) and is forgiven elsewhere.
    """
    wanted = " ".join(word.split())
    number = re.fullmatch(r"(?:error\s+)?(\d+)", wanted, re.IGNORECASE)
    if number:
        return topics().get(f"error {number[1]}")
    return _exact().get(wanted) or _folded().get(wanted.casefold()) or _desktop().get(wanted.casefold())


@cache
def _desktop() -> dict[str, Topic]:
    """Words of the command line that are no words of the language: `live`, `config`."""
    return {word: page for page in topics().values() for word in page.leads}


@cache
def _exact() -> dict[str, Topic]:
    """Every word that leads to a page. A page's own name wins over another page's further words."""
    table = {page.name: page for page in topics().values()}
    for page in topics().values():
        for word in page.words:
            table.setdefault(word, page)
    return table


@cache
def _folded() -> dict[str, Topic]:
    table: dict[str, Topic] = {}
    for word, page in _exact().items():
        table.setdefault(word.casefold(), page)
    return table


def _written() -> list[Topic]:
    """Read the pages of `pages/*.toml`."""
    pages = []
    for name in _WRITTEN:
        pages += [_page(entry) for entry in tomllib.loads(_with_rules(_text_of(name)))["page"]]
    return pages


def _with_rules(text: str) -> str:
    """Fill in what pages say about integration rules, from the table of rules."""
    from desire_tui.engine.integration.rules import RULES, in_words, markdown_table, rules_of

    text = text.replace("{table of rules}", markdown_table())
    for kind in ("variable", "multistep"):
        text = text.replace(f"{{{kind} rules}}", in_words(rules_of(kind)).replace(" … ", "–"))
    numbers = [rule.number for rule in RULES.values() if rule.reads_jacobian]
    return text.replace("{rules with a JACOBIAN}", " and ".join(map(str, numbers)))


def _text_of(name: str) -> str:
    return files(__package__).joinpath("pages", f"{name}.toml").read_text(encoding="utf-8")


def _page(entry: dict[str, Any]) -> Topic:
    kind: Kind = entry.get("kind", "script")
    return Topic(
        name=entry["name"],
        kind=kind,
        summary=entry["summary"],
        words=tuple(entry.get("words", ())),
        syntax=tuple(entry.get("syntax", ())),
        text=entry.get("text", "").strip(),
        example=entry.get("example", "").strip("\n"),
        prints=entry.get("prints", "").strip("\n"),
        see=tuple(entry.get("see", ())),
        also=entry.get("also", ""),
        leads=tuple(entry.get("leads", ())),
        actions=tuple(entry.get("actions", ())),
    )


def _functions() -> list[Topic]:
    """Make a page for each function of the library, and one that lists them all."""
    from desire_tui.engine.library import LIBRARY

    written: dict[str, dict[str, Any]] = tomllib.loads(_text_of("functions"))
    pages = []
    for entry in LIBRARY.values():
        more = written.get(entry.name, {})
        shows: list[tuple[str, str]] = more.get("shows", [])
        first = ["COMPLEX z"] if more.get("complex") else []
        pages.append(Topic(
            name=entry.name,
            kind="function",
            summary=entry.help,
            words=(entry.name, f"{entry.name}()"),
            syntax=(f"{entry.name}({entry.parameters})",),
            text=more.get("text", "").strip(),
            example="\n".join([*first, *(f"write {expression}" for expression, _ in shows)]) if shows else "",
            prints="\n".join(value for _, value in shows),
            see=tuple(more.get("see", ())),
        ))  # fmt: skip
    rows = [f"| `{page.syntax[0]}` | {page.summary} |" for page in pages]
    text = "\n".join(("| function | value |", "| --- | --- |", *rows))
    words = ("functions", "library")
    overview = Topic(
        "functions", "function", "all library functions", words, ("y = f(x)",), text, see=("FUNCTION",)
    )
    return [*pages, overview]


def _errors() -> list[Topic]:
    """One page for each error number; several messages may share one."""
    from desire_tui.engine.diagnostics.wording import all_wordings

    by_code: dict[int, list[tuple[str, str, str]]] = {}
    for wording in all_wordings().values():
        by_code.setdefault(wording.code, []).append((wording.message, wording.hint, wording.explanation))
    by_code.pop(0, None)  # "used here": a note beside a message, no message of its own
    return [_error_page(code, by_code[code]) for code in sorted(by_code)]


def _error_page(code: int, messages: list[tuple[str, str, str]]) -> Topic:
    messages = sorted(messages, key=lambda message: not message[2])  # what is explained is the usual case
    plain = list(dict.fromkeys(_readable(message) for message, _, _ in messages))
    paragraphs: list[str] = []
    for message, hint, explanation in messages:
        heading = f"**{_readable(message)}**" if len(plain) > 1 else ""
        paragraphs += [heading, _sentence(hint) if hint else "", explanation]
    text = "\n\n".join(dict.fromkeys(part for part in paragraphs if part))
    return Topic(
        name=f"error {code}",
        kind="error",
        summary=plain[0] + (", and others" if len(plain) > 1 else ""),
        text=text,
    )


def _sentence(hint: str) -> str:
    text = f"Hint: {_readable(hint)}"
    return text if text.endswith("?") else f"{text}."


def _readable(template: str) -> str:
    """Return a message template with its facts as `…`."""
    return re.sub(r"\{[^{}]*\}", "…", template)
