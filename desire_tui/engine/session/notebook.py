"""The notebook: a session's commands, programs, results and pictures, as Markdown [B 5.5.3; form X].

A session goes on without it: when it cannot be written any more it is switched off, which is reported once.
"""

from __future__ import annotations

import os
from contextlib import contextmanager
from datetime import datetime
from threading import RLock
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.files import writing
from desire_tui.engine.program_files import open_for_program
from desire_tui.engine.session import notebook_markdown

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from pathlib import Path

    from desire_tui.engine.graph.model import Graph
    from desire_tui.engine.runtime.run_record import RunRecord
    from desire_tui.engine.source import Source

RUNS_MAX = 8
"""Runs of a command that are noted one by one; of more, only the last."""


class Notebook:
    """Writes to one file at a time, always appending.

    What a command prints is written together when something else is to be noted or the command ends; every
    other entry is on the disk when the call returns. Any thread may call.
    """

    def __init__(self, warn: Callable[[Diagnostic], object], draw: Callable[[Graph, Path], object]) -> None:
        self.path: Path | None = None
        self.is_on = False
        self._warn = warn
        self._draw = draw
        self._lock = RLock()
        self._versions: dict[str, tuple[int, str]] = {}  # of each program: number and text
        self._program = ""  # the one noted last
        self._pending, self._dropped = "", 0  # a command and what it printed
        self._has_output = False
        self._runs, self._last_run = 0, ""
        self._live = 0  # re-runs of live mode since the last command
        self._in_list = False
        self._depth = 0
        self._picture_due = False
        self._drawn: tuple[object, ...] = ()
        self._pictures = 0

    # ------------------------------------------------------------------ on and off

    def open(self, path: Path) -> None:
        """Start or go on with a notebook. DesireError 106 where it cannot be written."""
        with self._lock:
            self._flush()
            if path != self.path:
                self._versions.clear()
            self.path, self.is_on = path, True
            self._forget()
            try:
                with writing(path):
                    self._put(self._heading(path))
            except DesireError:
                self.is_on = False
                raise

    def switch(self, *, on: bool) -> None:
        """`notebook on`, `notebook off`."""
        with self._lock:
            if not on and not self._has_output:
                self._pending = ""  # the command that switches off says nothing
            self._flush()
            self.is_on = on and self.path is not None

    def _forget(self) -> None:
        self._program = self._pending = self._last_run = ""
        self._dropped = self._runs = self._live = 0
        self._has_output = False

    def _heading(self, path: Path) -> str:
        try:
            is_new = not path.stat().st_size
        except OSError:
            is_new = True
        title = f"# {notebook_markdown.plain(path.stem)}\n\n" if is_new else "\n"
        return f"{title}## {datetime.now().astimezone():%Y-%m-%d %H:%M}\n"

    # ------------------------------------------------------------------ entries

    @contextmanager
    def task(self, command: str, graph: Callable[[], Graph | None]) -> Iterator[None]:
        """Frame of a command: its line before, its output, problem and graph after. May nest.

        `command` empty: a re-run of live mode; only the last one before the next command is noted.
        """
        if self._depth == 0:
            self._begin(command)
        self._depth += 1
        try:
            yield
        except DesireError as error:
            if self._depth == 1:
                for diagnostic in error.diagnostics:
                    self.output(f"{diagnostic.severity} {diagnostic.code}: {diagnostic.message}\n")
            raise
        finally:
            self._depth -= 1
            if self._depth == 0:
                self._finish(graph() if command else None)

    def _begin(self, command: str) -> None:
        with self._lock:
            if not self.is_on:
                return
            if command:
                self._flush()
                self._runs, self._live, self._picture_due = 0, 0, True
                self._pending = f"> {command}\n"
                return
            if not self._live:
                self._flush()
            self._live += 1
            self._pending, self._dropped = "", 0

    def output(self, text: str) -> None:
        """Keep what is printed."""
        if not self.is_on:  # nearly always: no lock for every line that a program prints
            return
        with self._lock:
            room = max(notebook_markdown.OUTPUT_MAX - len(self._pending), 0)
            self._pending += text[:room]
            self._dropped += len(text[room:])
            self._has_output = True

    def program(self, source: Source) -> None:
        """Keep the program's text, if it changed since it was kept last."""
        with self._lock:
            if not self._is_there():
                return
            number, before = self._versions.get(source.name, (0, None))
            if source.text == before and source.name == self._program:
                return
            if self._has_output:
                self._flush()  # else the command that brings the program stands below it
            self._program, self._picture_due, self._runs = source.name, True, 0
            if source.text == before:
                self._append(f"**{notebook_markdown.plain(source.name)}**, version {number}, again\n")
                return
            self._versions[source.name] = (number + 1, source.text)
            self._append(notebook_markdown.program_page(source.name, number + 1, source.text, before))

    def run_ended(self, record: RunRecord, settings: Mapping[str, float]) -> None:
        """Keep a run's settings and why it ended; `settings` are the values that live mode gave."""
        with self._lock:
            if not self.is_on:
                return
            line = notebook_markdown.run_line(record, settings)
            self._runs += 1
            if self._runs > RUNS_MAX or self._live:
                self._last_run = line
                return
            self._flush()
            self._append(line, item=True)

    def note(self, text: str) -> None:
        """Keep a line of the user's own."""
        with self._lock:
            if self._pending.startswith("> note") and not self._has_output:
                self._pending = ""
            self._flush()
            self._append(f"{text}\n")

    def picture(self, path: Path) -> None:
        """Show a picture file."""
        with self._lock:
            if self.path is not None:
                self._flush()
                self._append(notebook_markdown.picture_page(path, self.path.parent))

    # ------------------------------------------------------------------ the end of a command

    def _finish(self, graph: Graph | None) -> None:
        with self._lock:
            if self._live:
                return
            self._flush()
            if not self.is_on or self.path is None or graph is None or graph.is_empty:
                return
            state = (graph.number, len(graph.curves), graph.points.count, graph.erased, len(graph.shown))
            if not self._picture_due or state == self._drawn:
                return
            self._drawn, self._picture_due = state, False
            path = self._free_name(self.path)
            try:
                self._draw(graph, path)
            except DesireError as error:
                self._lost(error.diagnostics[0].facts["reason"])
            else:
                self.picture(path)

    def _free_name(self, path: Path) -> Path:
        while True:
            self._pictures += 1
            picture = path.with_name(f"{path.stem}-{self._pictures}.png")
            if not os.path.lexists(picture):
                return picture

    def _flush(self) -> None:
        pending, dropped, last = self._pending, self._dropped, self._last_run
        more, live = self._runs - RUNS_MAX, self._live
        self._pending, self._dropped, self._last_run, self._has_output = "", 0, "", False
        self._live = 0
        if live and last:
            self._append(f"Live mode, {live} times; the last run:\n\n{last}")
        elif last:
            head = f"- … {more - 1} more\n" if more > 1 else ""
            self._append(head + last, item=True)
        if pending:
            self._append(notebook_markdown.console_page(pending, dropped))

    # ------------------------------------------------------------------ the file

    def _append(self, text: str, *, item: bool = False) -> None:
        """Write an entry, a blank line before it; none between an `item` and the one before."""
        if not self._is_there():
            return
        joins, self._in_list = item and self._in_list, item
        try:
            self._put(text if joins else f"\n{text}")
        except OSError as reason:
            self._lost(reason)

    def _is_there(self) -> bool:
        """Whether there is a file to write to; one that vanished begins anew, with whole programs."""
        if not self.is_on or self.path is None:
            return False
        try:
            if not self.path.exists():
                self._versions.clear()
                self._put(self._heading(self.path))
                self._warn(Diagnostic("notebook-vanished", facts={"path": self.path}, severity="warning"))
        except OSError as reason:
            self._lost(reason)
        return self.is_on

    def _put(self, text: str) -> None:
        assert self.path is not None
        with open_for_program(self.path, "a") as file:
            file.write(text)

    def _lost(self, reason: object) -> None:
        self.is_on = False
        reason = getattr(reason, "strerror", None) or reason
        self._warn(Diagnostic("notebook-lost", facts={"path": self.path, "reason": reason}))
