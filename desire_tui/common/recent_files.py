"""The files opened and saved last, newest first, kept from session to session."""

from __future__ import annotations

import json
from pathlib import Path

from desire_tui.common.paths import exists, state_folder
from desire_tui.engine.user_folders import write_private

KEPT = 30


def recent_files() -> list[Path]:
    """Return the files that are still there."""
    return [path for path in _stored() if exists(path)]


def note_recent(path: Path) -> None:
    """Put a file first; a state folder that cannot be written keeps no list."""
    stored = _stored()
    if stored[:1] == [path]:
        return
    others = [other for other in stored if other != path]
    try:
        text = json.dumps([str(entry) for entry in (path, *others)][:KEPT])
        write_private(str(_file()), text.encode("utf-8", "surrogatepass"), sync=False)
    except OSError:
        return


def _stored() -> list[Path]:
    try:
        entries = json.loads(_file().read_text(encoding="utf-8", errors="surrogatepass"))
    except (OSError, ValueError):
        return []
    return [Path(entry) for entry in entries if isinstance(entry, str)] if isinstance(entries, list) else []


def _file() -> Path:
    return state_folder() / "recent-files.json"
