"""The desktop without its wiring: its parts, the keys in their order, what is shown of the engine."""

from __future__ import annotations

import os
from typing import IO, TYPE_CHECKING

from textual import events

from desire_tui.common import config, paths
from desire_tui.common.dialogs import Choice
from desire_tui.desktop import alt_keys
from desire_tui.desktop.completer import Completer
from desire_tui.desktop.engine_thread import EngineThread
from desire_tui.desktop.key_ordering import KeyOrdering
from desire_tui.desktop.main_screen import MainScreen
from desire_tui.desktop.screen_listener import ScreenListener
from desire_tui.desktop.telling_app import TellingApp
from desire_tui.engine.session.status import State
from desire_tui.panes.command_history import CommandHistory

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.driver import Driver
    from textual.message import Message

    from desire_tui.engine.session.permissions import Permissions


class AppBase(TellingApp):
    """What actions and messages use of the app."""

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

    def get_driver_class(self) -> type[Driver]:
        """Return what speaks to the terminal, or the browser."""
        chosen = super().get_driver_class()
        if chosen.__name__ == "LinuxDriver":  # its module is there, on every system that has terminals
            from desire_tui.desktop.terminal_driver import TerminalDriver

            return TerminalDriver
        return chosen

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

    # --------------------------------------------------------------------------------------------- refresh

    def show_status(self) -> None:
        """Bring the status bar up to date."""
        self.main_screen.status_bar.status = self.session.status
        self.show_hint()
        if self.is_web:
            self._served_driver.tell_unsaved(self.editor.has_unsaved_work)

    def show_hint(self) -> None:
        """Say in the status row what a paused or waiting program expects."""
        hints = {
            State.PAUSED: "Paused · Enter goes on · Space Enter ends",
            State.ASKING: "The program waits for input · Ctrl+C breaks off",
            State.STOPPED: "Stopped · F10 or go continues",
        }
        self.main_screen.status_bar.hint = hints.get(self.session.status.state, "")

    @property
    def clipboard_hint(self) -> str:
        """What stands between OSC 52 and the clipboard."""
        if os.environ.get("TMUX"):
            return "In tmux this needs: set -g set-clipboard on"
        return ""

    def write_samples(self, file: IO[str], delimiter: str = ",") -> None:
        """Write the last run's samples as a table: t, then every variable that it recorded."""
        from desire_tui.engine.outputs.csv_file import write_csv
        from desire_tui.engine.outputs.results import run_data

        write_csv([run_data(self.session.runs[-1])], file, numbered=False, delimiter=delimiter)

    def send_breakpoints(self) -> None:
        """Send the engine the breakpoints of the active program."""
        area = self.editor.active or self.editor.front
        rows = (area.marks.row_then(row) for row in area.marks.breakpoints)
        self.session.set_breakpoints({row + 1 for row in rows if row is not None})
