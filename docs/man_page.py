"""The manual page `desire.1`, made from the command line's own descriptions (man-pages(7))."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING

import click

from desire_tui.cli import main
from desire_tui.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterable

EXAMPLES = (
    ("desire", "Open the desktop; F1 there is help."),
    ("desire examples --copy examples", "Copy the example programs."),
    ("desire run examples/ch2/lorenz.src --png lorenz.png --csv lorenz.csv", "A graph and its samples."),
    ("desire run examples/ch3/*.src -j 0 --pdf graphs/", "Many programs at once, a PDF each."),
    (
        "desire check examples --sarif > desire.sarif",
        "Problems of all programs in a folder, for other tools.",
    ),
    ("desire help drun", "A page of the help."),
)
FILES = (
    (
        "~/.config/desire-tui/config.toml",
        "Settings of the desktop, threads of large models; desire config prints all with what they mean.",
    ),
    ("~/.cache/desire-tui", "Parse tables and native code, which only save time."),
    ("~/.local/state/desire-tui", "History, session and recovered programs of the desktop."),
)
STATUS = (
    ("0", "Done."),
    ("1", "A program failed, or a check found errors; messages are on standard error."),
    ("2", "Wrong usage."),
    ("3", "Stopped by a limit or Ctrl-C."),
)


def man_page() -> str:
    """Return the page as troff."""
    parts = [
        '.\\" made by python -m docs.generate from the command line',
        f'.TH DESIRE 1 "" "desire {__version__}" "Desire for the terminal"',
        ".SH NAME",
        "desire \\- interactive simulation of dynamic systems",
        ".SH SYNOPSIS",
        "\\fBdesire\\fR [\\fIFILE\\fR...]",
    ]
    commands = [command for command in main.commands.values() if not command.hidden]
    parts += [line for command in commands for line in (".br", _usage(command))]
    about = "A desktop for differential equations: editor, graphs, command line. Models are compiled."
    parts += [".SH DESCRIPTION", _text(about), *_paragraphs(main.help or ""), *_options(main), ".SH COMMANDS"]
    for command in commands:
        parts += [f'.SS "desire {command.name}"', _usage(command), *_paragraphs(command.help or "")]
        parts += _options(command)
    parts += [".SH EXIT STATUS", *_list(STATUS), ".SH FILES", *_list(FILES), ".SH EXAMPLES", *_list(EXAMPLES)]
    return "\n".join(parts) + "\n"


def _usage(command: click.Command) -> str:
    context = click.Context(command, info_name=command.name)
    words = command.collect_usage_pieces(context)
    return " ".join([f"\\fBdesire {command.name}\\fR", *(f"\\fI{_text(word)}\\fR" for word in words)])


def _paragraphs(text: str) -> list[str]:
    r"""Return the paragraphs of a help text; click's `\b` begins one whose lines stay as they are."""
    parts = []
    for paragraph in inspect.cleandoc(text).split("\n\n"):
        if paragraph.startswith("\b"):
            parts += [".PP", ".nf", *map(_text, paragraph[1:].strip("\n").split("\n")), ".fi"]
        elif paragraph.strip():
            parts += [".PP", _text(" ".join(paragraph.split()))]
    return parts


def _options(command: click.Command) -> list[str]:
    context = click.Context(command, info_name=command.name)
    records = [
        record
        for parameter in command.get_params(context)
        if (record := parameter.get_help_record(context)) is not None and record[1]
    ]
    return _list(records)


def _list(entries: Iterable[tuple[str, str]]) -> list[str]:
    return [line for name, about in entries for line in (".TP", f"\\fB{_text(name)}\\fR", _text(about))]


def _text(text: str) -> str:
    """Return text that troff shows as it stands."""
    shown = text.replace("\\", "\\e").replace("-", "\\-").replace("`", "").replace("…", "...")
    return f"\\&{shown}" if shown[:1] in (".", "'") else shown
