"""Take the pictures of docs/before_and_after.md that show how the desktop was: `python -m tests.app.before_pictures`

The desktop of the commit below is played in a worktree of its own, by its own scenes and `play`, with the
libraries of today's environment, whose versions are those it asked for.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

COMMIT = "c7d4fd2"
"""The last one before the work on the desktop's looks began."""
ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "pictures" / "before"
PLAYED = """
import asyncio, os, sys
from pathlib import Path
from tests.app.scenes import Scene, app_for, play
from tests.app.svg import tidy

FIRST, PLANE, FAILED = sys.argv[2:]
SCENES = (
    Scene("main-80x24", (80, 24)),
    Scene("main-160x50", (160, 50), ("alt+q",)),
    Scene("live-100x30", (100, 30), words=("live",)),
    Scene("first-model-100x30", (100, 30), text=FIRST, file="hares.src"),
    Scene("phase-plane-120x34", (120, 34), text=PLANE, file="hares.src"),
    Scene("failed-100x30", (100, 30), text=FAILED, file="hares.src"),
    Scene("palette-100x30", (100, 30), ("ctrl+p", *"csv")),
    Scene("save-100x30", (100, 30), ("ctrl+n", "x", "=", "1", "ctrl+s", *"my", "underscore", *"model")),
    Scene("keys-120x40", (120, 40), ("shift+f1",)),
)

async def main():
    for scene in SCENES:
        app = app_for(scene, Path.cwd())
        async with app.run_test(size=scene.size) as pilot:
            await play(app, pilot, scene)
            await pilot.pause(1)  # the palette searches for a while
            Path(sys.argv[1], f"{scene.name}.svg").write_text(tidy(app.export_screenshot(title="Desire")))
        Path(scene.file).unlink()

asyncio.run(main())
"""


def main() -> None:
    """Take them."""
    from tests.app.scenes import FAILED, FIRST
    from tests.app.svg import smaller

    FOLDER.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as places:
        tree, models = Path(places, "tree"), Path(places, "models")
        models.mkdir()
        _git("worktree", "add", "--quiet", "--detach", str(tree), COMMIT)
        try:
            subprocess.run(
                [sys.executable, "-c", PLAYED, str(FOLDER), FIRST, FIRST.replace("dispt", "dispxy"), FAILED],
                check=True, cwd=models,
                env={**os.environ, "PYTHONPATH": str(tree), "COLORTERM": "truecolor",
                     "XDG_CONFIG_HOME": places, "XDG_STATE_HOME": places},
            )  # fmt: skip
        finally:
            _git("worktree", "remove", "--force", str(tree))
    for path in sorted(FOLDER.glob("*.svg")):
        path.write_text(smaller(path.read_text()))
        print(path, path.stat().st_size)  # noqa: T201 - a tool of the command line


def _git(*words: str) -> None:
    subprocess.run(["git", *words], check=True, cwd=ROOT)


if __name__ == "__main__":
    main()
