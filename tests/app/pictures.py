"""Make what docs takes from the desktop: screenshots, the table of keys. `make pictures`"""

from __future__ import annotations

import asyncio
import os
import shutil
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

KEYS = Path(__file__).parents[2] / "docs" / "keys.md"
FOLDER = Path(__file__).parents[2] / "docs" / "pictures"
NOON = 1_767_268_800.0
"""When the files that dialogs show were changed."""


def keys_page() -> str:
    """Return docs/keys.md."""
    return f"""# Keys and commands of the desktop

Made by `make pictures` from the table in `desire_tui/commands.py`. Keys can be changed in the configuration file
(`desire config` prints where it is): `[keys]`, then a line such as `"run.start" = "f5"`.

{keys_table()}
{own_keys()}"""


def own_keys() -> str:
    """Return the keys that panes have for themselves, a Markdown table each."""
    from desire_tui.panes.key_sheet import keys_of
    from desire_tui.panes.own_keys import OWN_KEYS

    tables = []
    for heading, bindings in OWN_KEYS.items():
        rows = [f"| {keys} | {title} |" for _, keys, title in keys_of(bindings)]
        tables.append(
            "\n".join([f"## {heading.capitalize()}", "", "| key | action |", "| --- | --- |", *rows, ""])
        )
    return "\n".join(tables)


def keys_table() -> str:
    """Return all actions with their keys and words as a Markdown table."""
    from desire_tui.commands import COMMANDS
    from desire_tui.common.key_names import key_names

    rows = ["| key | action | | command |", "| --- | --- | --- | --- |"]
    for command in COMMANDS:
        argument = f" {command.argument}" if command.argument else ""
        words = ", ".join(f"`{word}{argument}`" for word in command.words).replace("|", "\\|")
        rows.append(f"| {key_names(command.keys)} | {command.title} | {command.help} | {words} |")
    return "\n".join(rows) + "\n"


@contextmanager
def a_folder() -> Iterator[Path]:
    """Work in a folder that is called the same each time, for dialogs that show it."""
    outer = Path(tempfile.gettempdir()) / "desire-pictures"
    folder = outer / "models"
    folder.mkdir(parents=True)
    try:
        os.chdir(folder)
        yield folder
    finally:
        os.chdir(FOLDER)
        shutil.rmtree(outer)


async def main() -> None:
    """Play every scene and keep its last picture."""
    from .scenes import PICTURES, app_for, play
    from .svg import smaller, tidy

    FOLDER.mkdir(parents=True, exist_ok=True)
    KEYS.write_text(keys_page())
    for scene in PICTURES:
        with a_folder() as folder:
            app = app_for(scene, folder)
            for path in (folder.parent, *folder.iterdir()):
                os.utime(path, (NOON, NOON))
            async with app.run_test(size=scene.size) as pilot:
                await play(app, pilot, scene)
                (FOLDER / f"{scene.name}.svg").write_text(
                    smaller(tidy(app.export_screenshot(title="Desire")))
                )
        print(FOLDER / f"{scene.name}.svg")  # noqa: T201 - a tool of the command line


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as places:
        for kind in ("CONFIG", "STATE"):
            os.environ[f"XDG_{kind}_HOME"] = places
        os.environ["COLORTERM"] = "truecolor"
        asyncio.run(main())
