"""The program that is analysed, and what is given besides: values, data files, the place on the desktop."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from desire_tui.api.instance import LoadOptions
from desire_tui.api.model import Model
from desire_tui.engine.data_classes import dataclass, field
from desire_tui.studies.task import Task

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from desire_tui.engine.session.session import BackendName
    from desire_tui.engine.source import Source


@dataclass
class Subject:
    """A program. Analyses change nothing of it.

    `settings` replace values of the script, as `--set` does; `here` holds the states as the desktop has them
    now, None without a desktop; `data` names files of measurements given besides the program's own.
    """

    source: Source
    settings: Mapping[str, float] = field(default_factory=dict)
    segment: str | None = None
    answers: tuple[str, ...] = ()
    backend: BackendName = "native"
    data: tuple[Path, ...] = ()
    here: Mapping[str, float] | None = None
    allow_shell: bool = False
    allow_write: bool = False

    @property
    def name(self) -> str:
        """The program's name, as pages and messages show it."""
        return self.source.file_name

    @cached_property
    def model(self) -> Model:
        """The program brought to its first run, compiled; `settings` are still to be given to its runs.

        DesireError: the program has mistakes, or does not come to a run.
        """
        return Model(
            self.source,
            LoadOptions(self.segment, self.answers, self.backend, self.allow_shell, self.allow_write),
        )

    def task(self, keep: str, names: tuple[str, ...]) -> Task:
        """Return what the study engine needs for runs in which `names` vary and `keep` is kept of each."""
        source = self.source
        return Task(
            text=source.text,
            name=source.name,
            path=None if source.path is None else str(source.path.absolute()),
            keep=keep,
            names=names,
            fixed=tuple((name, value) for name, value in self.settings.items() if name not in names),
            segment=self.segment,
            answers=self.answers,
            backend=self.backend,
            allow_shell=self.allow_shell,
            allow_write=self.allow_write,
        )
