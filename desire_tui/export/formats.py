"""The formats that a program's run can be exported to: one row each."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.engine.source import Source


@dataclass(frozen=True)
class Export:
    """What is exported, besides the program: as for `desire run`."""

    source: Source
    settings: Mapping[str, float] = field(default_factory=dict)
    segment: str | None = None
    answers: tuple[str, ...] = ()
    allow_shell: bool = False
    allow_write: bool = False
    inputs: tuple[str, ...] = ()
    """Parameters that an FMU gets from others while it runs."""


@dataclass(frozen=True)
class ExportFormat:
    """A format: its option (`--c`), its files' ending, and the module whose `content` makes a file."""

    name: str
    ending: str
    about: str
    module: str

    def content(self, export: Export) -> bytes:
        """Return the file. DesireError: the program has mistakes, or something that the format has not."""
        made: bytes = import_module(self.module).content(export)
        return made


FORMATS = (
    ExportFormat(
        "c",
        ".c",
        "One C99 file with the run: the segment, the rule, samples as CSV",
        "desire_tui.export.c.content",
    ),
    ExportFormat(
        "fmu",
        ".fmu",
        "An FMU (FMI 3.0), compiled here by cc: co-simulation and model exchange",
        "desire_tui.export.fmu.content",
    ),
    ExportFormat(
        "latex",
        ".tex",
        "The equations for a paper, with tables of parameters and initial values",
        "desire_tui.export.latex.content",
    ),
)
