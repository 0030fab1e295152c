"""What the desktop remembers of how the user wants it: the theme he chose, where the panes meet."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from desire_tui.common.paths import state_folder
from desire_tui.engine.user_folders import write_private

if TYPE_CHECKING:
    from pathlib import Path


def remembered() -> dict[str, Any]:
    """Return what is kept by key; nothing where the file is none of ours."""
    try:
        kept = json.loads(_file().read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return kept if isinstance(kept, dict) else {}


def remember(**entries: Any) -> None:
    """Keep entries beside the others; a state folder that cannot be written keeps nothing."""
    kept = remembered()
    if kept != (new := kept | entries):
        try:
            write_private(str(_file()), json.dumps(new).encode(), sync=False)
        except OSError:
            return


def _file() -> Path:
    return state_folder() / "look.json"
