"""The desktop without its wiring: panes by name, what is shown, what is told to the user."""

from __future__ import annotations

import os
from contextlib import suppress
from typing import IO, TYPE_CHECKING

from textual import events

from desire_tui.common import config, paths
from desire_tui.common.dialogs import Choice
from desire_tui.common.reach import Reach
from desire_tui.desktop import alt_keys
from desire_tui.desktop.completer import Completer
from desire_tui.desktop.engine_thread import EngineThread
from desire_tui.desktop.key_ordering import KeyOrdering
from desire_tui.desktop.main_screen import MainScreen
from desire_tui.desktop.screen_listener import ScreenListener
from desire_tui.desktop.themed_app import ThemedApp
from desire_tui.engine.session.status import State
from desire_tui.engine.user_folders import make_private
from desire_tui.engine.visible_text import visible_line
from desire_tui.panes.command_history import CommandHistory
from desire_tui.panes.problems_pane import ProgramProblems

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from textual.driver import Driver
    from textual.message import Message
    from textual.notifications import SeverityLevel
    from textual.widget import Widget

    from desire_tui.desktop.layout_rules import Pane
    from desire_tui.desktop.served_driver import ServedWebDriver
    from desire_tui.editor.editor_pane import EditorPane
    from desire_tui.engine.session.permissions import Permissions
    from desire_tui.engine.session.session import Session
    from desire_tui.panes.command_pane import CommandPane
    from desire_tui.panes.graph_pane import GraphPane
    from desire_tui.panes.help_pane import HelpPane
    from desire_tui.panes.quantities_pane import QuantitiesPane
    from desire_tui.panes.side_pane import Side


class AppBase(ThemedApp):
    """What actions and messages use of the app."""

    errors_reported = 0
    """How many errors were reported to the user."""
    keeps_answers = False
    """Whether a command of the command line is being carried out: what it says stays in the output."""

    def __init__(self, permissions: Permissions | None) -> None:
        super().__init__()
        self.settings, self.config_errors = config.load()
        self.listener = ScreenListener(self.post_message)
        self.engine = EngineThread(self.listener, self.post_message, permissions)
        self.completer = Completer(self.settings, lambda: self.editor.front, lambda: self.session.values)
        self.main_screen = MainScreen(
            CommandHistory(paths.state_folder() / "history.json"),
            self.settings.keys,
            self.completer,
            lambda: list(self.session.graphs),
        )
        self.key_ordering = KeyOrdering(self)
        self._typed_ahead: list[events.Event] | None = []
        """Keys and pasted text that came before the tabs were open; None: they are."""
        self.reach = Reach()

    def get_driver_class(self) -> type[Driver]:
        """Return what speaks to the terminal, or the browser."""
        chosen = super().get_driver_class()
        if chosen.__name__ == "LinuxDriver":  # its module is there, on every system that has terminals
            from desire_tui.desktop.terminal_driver import TerminalDriver

            return TerminalDriver
        return chosen

    @property
    def session(self) -> Session:
        """The engine; waits for it during the first moments."""
        return self.engine.session

    async def on_event(self, event: events.Event) -> None:
        """Deal with an event; keys in the order in which they were typed. Alt with a letter types nothing."""
        if self._typed_ahead is not None and isinstance(event, events.Key | events.Paste):
            self._typed_ahead.append(event)
            return
        if isinstance(event, events.Key) and event.key.startswith("alt+"):
            event.character = None
            if event.key == "alt+f" and alt_keys.is_word_right(self.focused):
                event = events.Key("ctrl+right", None)
        if isinstance(event, events.Key) and isinstance(self.screen, Choice) and not self.screen.takes(event):
            return
        if isinstance(event, events.Key) and not event.is_forwarded and not event.is_printable:
            await self.key_ordering.carry_out(event, super().on_event)
        else:
            await super().on_event(event)

    async def take_typed_ahead(self) -> None:
        """Deal with what was typed while the desktop opened, now that it has the panes and tabs meant."""
        typed, self._typed_ahead = self._typed_ahead or [], None
        for event in typed:
            await self.on_event(event)

    async def _on_message(self, message: Message) -> None:
        """Deal with a message; while the desktop closes its panes are gone, and nobody handles it."""
        if self.is_running or isinstance(message, events.Event):
            await super()._on_message(message)

    def on_screen(self, act: Callable[..., object], *args: object, **options: object) -> None:
        """Call a function on the app's thread for another thread, as long as the desktop is there."""
        self.call_later(lambda: self.is_running and act(*args, **options))

    # ----------------------------------------------------------------------------------------------- panes

    @property
    def editor(self) -> EditorPane:
        """The editor pane."""
        return self.main_screen.editor

    @property
    def command(self) -> CommandPane:
        """The command pane."""
        return self.main_screen.command

    @property
    def graph(self) -> GraphPane:
        """The graph pane."""
        return self.main_screen.graph

    @property
    def quantities(self) -> QuantitiesPane:
        """The quantities pane."""
        return self.main_screen.side_pane.quantities

    @property
    def help_pane(self) -> HelpPane:
        """The help pane."""
        return self.main_screen.side_pane.help

    # ----------------------------------------------------------------------------------------------- layout

    def open_side(self, name: Side, *, toggle: bool = False) -> None:
        """Show a page of the side pane and move there; with `toggle`, hide it if it has the focus."""
        screen = self.main_screen
        if toggle and screen.side == name and screen.pane_of(self.focused) == "side":
            self.close_side()
            return
        screen.open_side(name)
        if name == "quantities":
            self.quantities.show(self.session.values)
        elif name == "problems":
            self.list_problems()
        if name != "help" and (widget := self.side_focus()) is not None:  # help finds its own place
            self.move_focus(widget)

    def close_side(self) -> None:
        """Hide the side pane."""
        if self.main_screen.close_side():
            self.move_focus(self.command.prompt)

    def side_focus(self) -> Widget | None:
        """Return what gets the focus in the side pane, None if it is hidden."""
        match self.main_screen.side:
            case "quantities":
                return self.quantities.table
            case "problems":
                return self.main_screen.side_pane.problems
            case "help":
                return self.help_pane.query_one("#help-search")
        return None

    def move_focus(self, widget: Widget) -> bool:
        """Move the focus to a widget; where only one pane is shown, it becomes the widget's."""
        self.main_screen.make_visible(widget)
        self.main_screen.set_focus(
            widget
        )  # at once: widget.focus() waits, and keys typed meanwhile would go astray
        return widget.focusable

    def show_run(self) -> None:
        """Where the editor fills a small screen, give way to the graph and the command line."""
        if self.main_screen.only_pane is None and not {"graph", "command"} & self.main_screen.shown:
            self.move_focus(self.command.prompt)

    def toggle_maximized(self, pane: Pane | None) -> None:
        """Show a pane (default: the focused one) alone, or all again."""
        screen = self.main_screen
        if screen.only_pane is not None:
            screen.show_only(None)
            return
        screen.show_only(pane or screen.pane_of(self.focused))
        if pane == "graph":
            self.move_focus(self.graph)

    # --------------------------------------------------------------------------------------------- refresh

    def show_status(self) -> None:
        """Bring the status bar up to date."""
        self.main_screen.status_bar.status = self.session.status
        self.show_hint()
        if self.is_web:
            self._served_driver.tell_unsaved(self.editor.has_unsaved_work)

    @property
    def clipboard_hint(self) -> str:
        """What stands between OSC 52 and the clipboard."""
        if os.environ.get("TMUX"):
            return "In tmux this needs: set -g set-clipboard on"
        return ""

    # ------------------------------------------------------------------------------------------------ telling

    def notify(
        self,
        message: str,
        *,
        title: str = "",
        severity: SeverityLevel = "information",
        timeout: float | None = None,
        markup: bool = True,
    ) -> None:
        """Show a sentence for a while; the answer to a typed command stays in the output, too."""
        if self.keeps_answers:
            self.command.console.add(message, "warning" if severity == "warning" else "notice")
        self._show_toast(message, title, severity, timeout, markup)

    def _show_toast(
        self, message: str, title: str, severity: SeverityLevel, timeout: float | None, markup: bool
    ) -> None:
        super().notify(message, title=title, severity=severity, timeout=timeout, markup=markup)

    def report_error(self, sentence: str, *, code: int | None) -> None:
        """Report an error of the user (`code` None: a warning)."""
        self.errors_reported += 1
        text = f"error {code}: {sentence}" if code else sentence
        self.command.console.add(text, "error" if code else "warning")
        self._show_toast(text, "", "error" if code else "warning", 6, markup=False)

    def is_file_name(self, name: str) -> bool:
        """Whether a file can be called so; the user is told if not."""
        if not paths.can_name_a_file(name):
            self.report_error(f"no file can be called {visible_line(name)}", code=38)
            return False
        return True

    def may_read(self, path: Path) -> bool:
        """Whether the user may open a file; he is told if not."""
        return self._within_reach(self.reach.may_read(path))

    def may_write(self, path: Path, *endings: frozenset[str]) -> bool:
        """Whether the user may save a file of a program, or one with such endings; he is told if not."""
        return self._within_reach(self.reach.may_write(path, *endings))

    def _within_reach(self, allowed: bool) -> bool:
        if not allowed:
            # the same words for every file: whether one is there is not for visitors either
            self.report_error(
                f"visitors open and save programs and results in {self.reach.folder} only", code=451
            )
        return allowed

    def list_problems(self) -> None:
        """Bring the problems pane up to date."""
        programs = [
            ProgramProblems(area.buffer.number, area.buffer.name, area.marks.all_problems())
            for area in self.editor.areas
        ]
        self.main_screen.side_pane.count_problems(self.main_screen.side_pane.problems.show(programs))

    def follow_theme(self) -> None:
        """Take over the colours of a new theme where they are not CSS's."""
        super().follow_theme()
        self.editor.follow_theme()
        self.list_problems()

    def snapshot_written(self, path: Path) -> None:
        """Report where the picture is."""
        self.command.console.add(f"{path}", "notice")
        self.file_written(path)

    def file_written(self, path: Path) -> None:
        """Say where a file is that was saved for the user; in a browser he gets a copy."""
        copied = False
        if self.is_web:
            with suppress(OSError):  # it stands where it was saved
                copied = self._served_driver.hand_over(path)
        copy = " and sent to the browser" if copied else ""
        self.notify(f"Saved {path}{copy}", timeout=3, markup=False)

    @property
    def _served_driver(self) -> ServedWebDriver:
        from desire_tui.desktop.served_driver import ServedWebDriver

        assert isinstance(self._driver, ServedWebDriver)
        return self._driver

    def write_samples(self, file: IO[str], delimiter: str = ",") -> None:
        """Write the last run's samples as a table: t, then every variable that it recorded."""
        from desire_tui.engine.outputs.csv_file import write_csv
        from desire_tui.engine.outputs.results import run_data

        write_csv([run_data(self.session.runs[-1])], file, numbered=False, delimiter=delimiter)

    def log_fault(self, summary: str, details: str) -> None:
        """Keep a fault of ours in a file and say so; the session goes on."""
        path = self.write_fault(details)
        where = f"; details in {path}" if path is not None else ""
        self.report_error(f"internal error (not yours): {summary}{where}", code=None)

    def write_fault(self, details: str) -> Path | None:
        """Write a fault up; returns where, None if the folder cannot be written."""
        path = paths.state_folder() / "faults.log"
        try:
            make_private(str(path.parent))
            with path.open("a", encoding="utf-8", errors="backslashreplace") as file:
                path.chmod(0o600)
                file.write(details + "\n")
        except OSError:
            return None
        return path

    def show_hint(self) -> None:
        """Say in the status row what a paused or waiting program expects."""
        hints = {
            State.PAUSED: "Paused · Enter goes on · Space Enter ends",
            State.ASKING: "The program waits for input · Ctrl+C breaks off",
            State.STOPPED: "Stopped · F10 or go continues",
        }
        self.main_screen.status_bar.hint = hints.get(self.session.status.state, "")

    def send_breakpoints(self) -> None:
        """Send the engine the breakpoints of the active program."""
        area = self.editor.active or self.editor.front
        rows = (area.marks.row_then(row) for row in area.marks.breakpoints)
        self.session.set_breakpoints({row + 1 for row in rows if row is not None})
