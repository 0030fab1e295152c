"""What a notebook's entries look like: Markdown, from texts and runs. Nothing here touches a file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.session.report import WHY

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from desire_tui.engine.runtime.run_record import RunRecord

OUTPUT_MAX = 20_000
"""Characters of output kept of one command."""
_CONTROL = dict.fromkeys((*range(9), *range(11, 32), 127), "\N{REPLACEMENT CHARACTER}")
_SPECIAL = re.compile(r"([\\`*_\[\]<>#|])")


def block(kind: str, text: str) -> str:
    """Return a fenced block; the fence is longer than any row of backquotes inside."""
    longest = max((len(row) for row in re.findall(r"`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    return f"{fence}{kind}\n{text.rstrip()}\n{fence}\n"


def plain(text: str) -> str:
    """Return text in which Markdown finds nothing to interpret."""
    return _SPECIAL.sub(r"\\\1", text)


def program_page(name: str, version: int, text: str, before: str | None) -> str:
    """Return a program's version: the first whole, a later one as unified diff unless nothing is left."""
    head = f"**{plain(name)}**, version {version}\n\n"
    if before is None:
        return head + block("desire", text)
    from difflib import unified_diff  # 1 ms at every start

    old, new = (version_text.rstrip("\n").split("\n") for version_text in (before, text))
    names = (f"{name} version {version - 1}", f"{name} version {version}")
    difference = list(unified_diff(old, new, *names, lineterm=""))
    if any(line.startswith(" ") and line.strip() for line in difference):
        return head + block("diff", "\n".join(difference))
    return head + block("desire", text)


def console_page(text: str, dropped: int) -> str:
    """Return commands and what they printed; `dropped` characters were too many to keep."""
    text = text.translate(_CONTROL)
    if dropped:
        text = f"{text.rstrip()}\n… {dropped} more characters"
    return block("text", text)


def run_line(record: RunRecord, settings: Mapping[str, float]) -> str:
    """Return a run's settings, length and end as an item of a list."""
    name = f" {plain(record.segment)}" if record.segment else ""
    with_ = "".join(f", {plain(parameter)} = {value:.6g}" for parameter, value in settings.items())
    why = f": {plain(record.message)}" if record.message else ""
    return (
        f"- Run {record.number}{name}{with_}: rule {record.rule}, t = {record.t0:g} … {record.end_time:g}, "
        f"DT = {record.dt:g}, {record.steps} steps, {WHY[record.ended]}{why}\n"
    )


def picture_page(path: Path, folder: Path) -> str:
    """Return a picture, named from the notebook's folder where it lies in or below it."""
    target = path.relative_to(folder) if path.is_relative_to(folder) else path
    return f"![{plain(path.stem)}](<{target.as_posix()}>)\n"
