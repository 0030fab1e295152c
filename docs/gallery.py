"""The gallery: a picture of every example, drawn by `desire run` when the site is built, never committed."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.panes.example_catalogue import CHAPTERS, Example, examples

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

ROOT = Path(__file__).parents[1]
OPTIONS = ("--size", "6x3.75", "--dpi", "96", "--quiet", "--timeout", "300")
LINES_MOST = 14
"""Of console text that stands in a picture's place."""
INTRO = """\
# Gallery

{count} examples, each with its last graph or with what it writes. F11 opens them on the
desktop, `desire examples --copy DIR` copies them."""


@dataclass(frozen=True)
class Drawn:
    """What there is to show of an example: a picture, or the beginning of its console text."""

    picture: Path | None
    console: str = ""


def draw_all(folder: Path) -> dict[str, Drawn]:
    """Return what to show of each example, drawn in `folder` unless that is newer than all of the program."""
    folder.mkdir(parents=True, exist_ok=True)
    every = examples(ROOT / "examples")
    sources = [*(ROOT / "desire_tui").rglob("*.py"), *(example.path for example in every)]
    done = folder / "done"
    if not done.exists() or done.stat().st_mtime < max(path.stat().st_mtime for path in sources):
        for old in folder.iterdir():
            old.unlink()
        _draw(every, folder)
        done.touch()
    return {example.name: _found(example.name, folder) for example in every}


def _found(name: str, folder: Path) -> Drawn:
    """Look for NAME.png, or the last of NAME-1.png, NAME-2.png …, or the console text."""
    numbers = [path.stem.removeprefix(f"{name}-") for path in folder.glob(f"{name}-*.png")]
    last = max((int(number) for number in numbers if number.isdecimal()), default=None)
    picture = folder / (f"{name}.png" if last is None else f"{name}-{last}.png")
    text = folder / f"{name}.txt"
    return Drawn(picture if picture.exists() else None, text.read_text("utf-8") if text.exists() else "")


def _draw(every: Iterable[Example], folder: Path) -> None:
    """Run copies of all, so that their data files lie elsewhere; those that ask get their answers."""
    with tempfile.TemporaryDirectory() as name:
        copies = Path(name)
        shutil.copytree(ROOT / "examples", copies, dirs_exist_ok=True)
        silent = [e for e in every if not e.answers]
        _run([f"{e.folder}/{e.path.name}" for e in silent], folder, copies, "-j", "0")
        for example in every:
            if example.answers:
                answers = copies / "answers.txt"
                answers.write_text("\n".join(example.answers) + "\n", encoding="utf-8")
                _run([f"{example.folder}/{example.path.name}"], folder, copies, "--input", str(answers))


def _run(programs: list[str], folder: Path, where: Path, *options: str) -> None:
    """Run programs; one that ends with an error, which some are about, has the graph that it came to.

    Messages go to standard error, where whoever builds the site sees them.
    """
    files = ("--png", f"{folder}/", "--json", f"{folder}/")
    command = [sys.executable, "-m", "desire_tui", "run", *programs, *files, *OPTIONS, *options]
    subprocess.run(command, cwd=where, check=False, stdin=subprocess.DEVNULL)  # noqa: S603 - our own command
    for path in folder.glob("*.json"):
        lines = json.loads(path.read_text(encoding="utf-8"))["console"].splitlines()
        shown = [*lines[:LINES_MOST], "…"] if len(lines) > LINES_MOST else lines
        path.with_suffix(".txt").write_text("\n".join(shown) + "\n", encoding="utf-8")
        path.unlink()


def gallery_page(drawn: Mapping[str, Drawn]) -> str:
    """Return the page in Markdown."""
    every = examples(ROOT / "examples")
    parts = [INTRO.format(count=len(every))]
    for folder, title in CHAPTERS.items():
        here = [example for example in every if example.folder == folder]
        parts.append(f"## {here[0].chapter}. {title}")
        for example in here:
            name = f"[{example.name}](../examples/{folder}/{example.path.name})"
            parts += [f"### {example.name.replace('_', ' ')}", f"{name}: {_plain(example.about)}"]
            found = drawn[example.name]
            if found.picture is not None:
                parts.append(f"![{example.name}](gallery/{example.name}.png)")
            elif found.console.strip():
                parts.append(f"```text\n{found.console}```")
    return "\n\n".join(parts) + "\n"


def _plain(text: str) -> str:
    return text.replace("*", "\\*").replace("|", "\\|").replace("_", "\\_").replace("<", "&lt;")
