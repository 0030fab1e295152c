"""Make the screenshots in docs/pictures. `make pictures`"""

from __future__ import annotations

import asyncio
import os
import tempfile
from pathlib import Path

FOLDER = Path(__file__).parents[2] / "docs" / "pictures"


async def main() -> None:
    """Play every scene and keep its last picture."""
    from .scenes import SCENES, app_for, play

    FOLDER.mkdir(parents=True, exist_ok=True)
    for scene in SCENES:
        with tempfile.TemporaryDirectory() as name:
            app = app_for(scene, Path(name))
            async with app.run_test(size=scene.size) as pilot:
                await play(app, pilot, scene)
                (FOLDER / f"{scene.name}.svg").write_text(app.export_screenshot(title="Desire"))
        print(FOLDER / f"{scene.name}.svg")  # noqa: T201 - a tool of the command line


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as places:
        for kind in ("CONFIG", "STATE"):
            os.environ[f"XDG_{kind}_HOME"] = places
        asyncio.run(main())
