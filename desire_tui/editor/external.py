"""The user's own editor for a while."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from textual.app import App, SuspendNotSupported

if TYPE_CHECKING:
    from desire_tui.editor.area import CodeArea


def edit_outside(app: App[None], area: CodeArea) -> None:
    """Stop the screen, start $VISUAL or $EDITOR on a copy of the text, take the text back as one change."""
    words = shlex.split(os.environ.get("VISUAL") or os.environ.get("EDITOR") or "vi")
    if not words or shutil.which(words[0]) is None:
        app.notify(f"No editor '{' '.join(words)}': set $EDITOR.", severity="error", markup=False)
        return
    with tempfile.TemporaryDirectory(prefix="desire-") as folder:
        copy = Path(folder) / (area.buffer.path.name if area.buffer.path else "program.src")
        copy.write_text(area.text, encoding="utf-8")
        try:
            with app.suspend():
                status = subprocess.run([*words, str(copy)], check=False).returncode  # noqa: S603 - the user's own choice
        except SuspendNotSupported:
            app.notify("This terminal cannot be handed to another program.", severity="error")
            return
        text = copy.read_text(encoding="utf-8", errors="replace")
    if status:
        app.notify(
            f"{words[0]} ended with status {status}; the text is unchanged.", severity="warning", markup=False
        )
    elif text != area.text:
        area.rewrite_rows(0, area.document.line_count - 1, text.removesuffix("\n").split("\n"))
