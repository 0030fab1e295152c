"""`desire help`: the desktop's pages in a shell, drawn for a terminal, as Markdown for a pipe."""

from __future__ import annotations

import sys
from textwrap import shorten

from desire_tui.engine.visible_text import visible
from desire_tui.help.help_search import search
from desire_tui.help.page_catalogue import HEADINGS, find, topics

SHOWN_MOST = 15
_SUMMARY_MOST = 90  # characters


def show_help(topic: str) -> int:
    """Print the page of a topic, else those that a search finds, all for an empty topic.

    Returns the exit status: 1 if there is nothing.
    """
    if not topic:
        sys.stdout.write(_overview())
        return 0
    page = find(topic)
    if page is not None:
        _show(page.markdown)
        return 0
    found = search(topic)
    if not found:
        sys.stderr.write(f"no help on '{visible(topic)}'; `desire help` lists all pages\n")
        return 1
    width = max(len(page.name) for page in found[:SHOWN_MOST])
    rows = [
        f"{page.name.ljust(width)}  {shorten(page.summary, _SUMMARY_MOST)}" for page in found[:SHOWN_MOST]
    ]
    more = [f"… and {len(found) - SHOWN_MOST} more"] if len(found) > SHOWN_MOST else []
    sys.stdout.write("\n".join([f"Pages with '{visible(topic)}':", *rows, *more]) + "\n")
    return 0


def _overview() -> str:
    """Return the names of all pages but the messages', under what they are about."""
    from textwrap import fill

    parts = [
        "desire help TOPIC shows one of these; desire help WORDS searches them. Messages: desire help 200."
    ]
    for heading in dict.fromkeys(HEADINGS.values()):
        names = sorted(
            (page.name for page in topics().values() if HEADINGS[page.kind] == heading), key=str.casefold
        )
        if heading != HEADINGS["error"]:
            text = fill(
                ", ".join(names), 98, initial_indent="  ", subsequent_indent="  ", break_on_hyphens=False
            )
            parts.append(f"{heading}\n{text}")
    return "\n\n".join(parts) + "\n"


def _show(markdown: str) -> None:
    if not sys.stdout.isatty():
        sys.stdout.write(markdown)
        return
    from rich.console import Console
    from rich.markdown import Markdown

    console = Console()
    page = Markdown(markdown, code_theme="ansi_dark", hyperlinks=False)
    console.print(page, width=min(console.width, 100))
