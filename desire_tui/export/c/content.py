"""A run as the bytes of a C file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.export.c.model_file import ModelFile
from desire_tui.export.run import exported_run

if TYPE_CHECKING:
    from desire_tui.export.formats import Export


def content(export: Export) -> bytes:
    """Return the file. DesireError 530: what C does not have here; others: the program has mistakes."""
    return ModelFile(exported_run(export)).text().encode()
