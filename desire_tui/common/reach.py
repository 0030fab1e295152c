"""Which files the desktop's user may open and save: all; a visitor of a served one, those of its folder."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from pathlib import Path

_SAVED_ENDINGS = frozenset({".src", ".txt"})


@dataclass(frozen=True)
class Reach:
    """The files of `folder`; all if there is none."""

    folder: Path | None = None

    def may_read(self, path: Path) -> bool:
        """Whether a file may be opened, or looked for; links are followed, hidden names are private."""
        if self.folder is None:
            return True
        target = path.resolve()
        if not target.is_relative_to(self.folder):
            return False
        return not any(part.startswith(".") for part in target.relative_to(self.folder).parts)

    def may_write(self, path: Path, endings: frozenset[str] = _SAVED_ENDINGS) -> bool:
        """Whether a file may be saved: no ending by which another program would take it for its own."""
        return self.folder is None or (self.may_read(path) and path.resolve().suffix.lower() in endings)
