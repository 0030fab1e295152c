"""The gallery: a picture of every example, drawn by `desire run` when the site is built, never committed."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.panes.example_catalogue import CHAPTERS, Example, examples

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

ROOT = Path(__file__).parents[1]
OPTIONS = ("--size", "6x3.75", "--dpi", "96", "--quiet", "--timeout", "300")
INTRO = """\
# Gallery

{drawn} of {count} examples, each with its last graph; the others write to the console. F11 opens them on the
desktop, `desire examples --copy DIR` copies them."""


def draw_all(folder: Path) -> dict[str, Path]:
    """Return the pictures by the examples' names, drawn in `folder` unless newer than all of the program.

    Examples without a graph have none.
    """
    folder.mkdir(parents=True, exist_ok=True)
    newest = max(path.stat().st_mtime for path in (ROOT / "desire_tui").rglob("*.py"))
    done = folder / "done"
    every = examples(ROOT / "examples")
    newest = max(newest, *(example.path.stat().st_mtime for example in every))
    if not done.exists() or done.stat().st_mtime < newest:
        for old in folder.glob("*.png"):
            old.unlink()
        _draw(every, folder)
        done.touch()
    found: dict[str, Path] = {}
    for example in every:
        numbered = folder.glob(f"{example.name}-*.png")
        of_several = [path for path in numbered if path.stem.rpartition("-")[2].isdecimal()]
        one = folder / f"{example.name}.png"
        pictures = (
            [one] if one.exists() else sorted(of_several, key=lambda path: int(path.stem.rpartition("-")[2]))
        )
        if pictures:
            found[example.name] = pictures[-1]
    return found


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
    command = [
        sys.executable,
        "-m",
        "desire_tui",
        "run",
        *programs,
        "--png",
        f"{folder}/",
        *OPTIONS,
        *options,
    ]
    subprocess.run(command, cwd=where, check=False, stdin=subprocess.DEVNULL)  # noqa: S603 - our own command


def gallery_page(pictures: Mapping[str, Path]) -> str:
    """Return the page in Markdown."""
    every = examples(ROOT / "examples")
    drawn = sum(example.name in pictures for example in every)
    parts = [INTRO.format(drawn=drawn, count=len(every))]
    for folder, title in CHAPTERS.items():
        here = [example for example in every if example.folder == folder]
        parts.append(f"## {here[0].chapter}. {title}")
        for example in here:
            name = f"[{example.name}](../examples/{folder}/{example.path.name})"
            picture = f"\n\n![{example.name}](gallery/{example.name}.png)" if example.name in pictures else ""
            parts.append(f"### {example.name.replace('_', ' ')}\n\n{name}: {_plain(example.about)}{picture}")
    return "\n\n".join(parts) + "\n"


def _plain(text: str) -> str:
    return text.replace("*", "\\*").replace("|", "\\|").replace("_", "\\_").replace("<", "&lt;")
