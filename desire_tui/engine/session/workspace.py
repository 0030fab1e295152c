"""A session's workspace: the active program, its folder, its compiled segments, the notebook."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.session.compiled_segments import CompiledSegments
from desire_tui.engine.session.permissions import Asker
from desire_tui.engine.source import Source
from desire_tui.engine.values import Values

if TYPE_CHECKING:
    from desire_tui.engine.codegen.compiler_state import CompilerState
    from desire_tui.engine.nodes.program import Placed, Program
    from desire_tui.engine.session.notebook import Notebook
    from desire_tui.engine.session.permissions import Ask, Permissions
    from desire_tui.engine.structure.structure import Structure
    from desire_tui.engine.warm_start.program_start import ProgramStart

STORED_LEAST = 10_000
"""Characters of programs for which later processes find what this one knows."""
_NO_SOURCE = Source("", "<none>")


class Workspace:
    """State of a session that belongs to the program rather than to a run."""

    def __init__(
        self,
        backend: str,
        folder: Path | None,
        permissions: Permissions,
        notebook: Notebook,
        compiler: CompilerState | None = None,
        elements_most: int | None = None,
    ) -> None:
        self.values = Values(elements_most)
        self.segments = CompiledSegments(self.values, backend, compiler)
        self.permissions = permissions
        self.program: Program | None = None
        self.structure: Structure | None = None
        self.own: tuple[Program, Structure] | None = None
        """The active program as its text says, without overrides."""
        self.command: Source | None = None
        """The command line being carried out, None while the script runs."""
        self.overrides: dict[str, float] = {}
        """See `overrides`: by names such as `a` and `A[1,3]`."""
        self.breakpoints: frozenset[int] = frozenset()
        """Lines of the script (from 1) before which it stops as at a STOP."""
        self.parse_seconds = 0.0
        self.notebook = notebook
        self._folder = folder

    def accept(self, source: Source, *, is_checked: bool) -> Program:
        """Make a text the active program, with the overrides there are; return it as the text says.

        `is_checked`: all of it will be read at once, so that nothing is won by what earlier processes know.
        """
        from desire_tui.engine.structure.structure import structure
        from desire_tui.engine.syntax.parse import parse

        began = perf_counter()
        own = self.own if self.segments.are_remembered else None
        if own is not None and own[0].source is not source:
            own = None
        if own is None:
            start = self.segments.start = None if is_checked else _start(source)
            own = start.own if start is not None else None
        program = own[0] if own is not None else parse(source)
        self.parse_seconds = perf_counter() - began
        if own is None:
            own = program, structure(program)
        self.own = active, script = own
        if self.overrides:
            from desire_tui.engine.session.overrides import with_overrides

            active = with_overrides(program, script, self.overrides)
            script = structure(active)
        self.program, self.structure = active, script
        return program

    def run_as_written(self) -> None:
        """Take the active program as its text says, if it was changed for the last run only."""
        if self.own is not None and not self.overrides:
            self.program, self.structure = self.own

    def forget(self) -> None:
        """Have no program."""
        self.program = self.structure = self.own = None

    @property
    def faulty(self) -> tuple[Diagnostic, ...]:
        """Errors of the active program's text that stop it where they are reached, and nowhere else."""
        if self.program is None or self.structure is None:
            return ()
        return tuple(p for p in (*self.program.problems, *self.structure.problems) if p.severity == "error")

    @property
    def source(self) -> Source:
        """The active program's text."""
        return self.program.source if self.program is not None else _NO_SOURCE

    @property
    def folder(self) -> Path:
        """Where relative names start: the program's folder, the one given, or the working directory."""
        path = self.source.path
        if path is not None:
            return path.expanduser().resolve().parent
        return (self._folder if self._folder is not None else Path.cwd()).expanduser().resolve()

    def permit(self, path: Path, mode: Literal["read", "write"], ask: Ask) -> Path:
        """Return the resolved path if the program may open it; DesireError 451."""
        return self.permissions.file(path, mode, self.asker, ask)

    @property
    def asker(self) -> Asker:
        """The active program, as permissions know it."""
        path = self.source.path
        return Asker(self.folder, path.expanduser().resolve() if path is not None else None)

    def stash_path(self, mode: Literal["read", "write"], ask: Ask) -> Path:
        """Where `stash` writes and `recover` reads: beside the program, `NAME.stash.npy`. DesireError 451."""
        path = self.source.path
        return self.permit(Path(f"{path.stem if path is not None else 'untitled'}.stash.npy"), mode, ask)

    def runnable(self) -> tuple[Program, Structure]:
        """Return the program and its structure.

        DesireError 215: there is none; or all its problems, if some of its text is no statement at all. A
        statement that is wrong stops a program that gets there.
        """
        if self.program is None or self.structure is None:
            raise DesireError(Diagnostic("no-program"))
        if self.program.unreadable:
            from desire_tui.engine.check.checker import check

            # the whole text's errors at once, not only those that keep it from starting
            every = (p.within(self.program.source) for p in check(self.program))
            raise DesireError(*(p for p in every if p.severity == "error"))
        return self.program, self.structure

    def source_of(self, placed: Placed) -> Source:
        """Return the text a statement stands in: the command line's or the program's."""
        del placed
        return self.command if self.command is not None else self.source

    def line_of(self, placed: Placed) -> int:
        """Return a statement's line in the program; 0 for a command."""
        return 0 if self.command is not None else self.source.position(placed.at).row


def _start(source: Source) -> ProgramStart | None:
    """Return the start of a program that is large enough to be stored."""
    if len(source.text) < STORED_LEAST:
        return None
    from desire_tui.engine.warm_start.program_start import program_start

    return program_start(source)
