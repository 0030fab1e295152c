"""The IDE: wiring between the panes, the actions and the engine's thread. What is shown is in `desk`."""

from __future__ import annotations

import asyncio
import inspect
import os
import signal
import threading
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from textual import on
from textual.app import App, SystemCommand
from textual.screen import ModalScreen

from desire_tui import commands, config, places, themes
from desire_tui.actions.edit import EditActions
from desire_tui.actions.file import FileActions
from desire_tui.actions.graph import GraphActions
from desire_tui.actions.help import HelpActions
from desire_tui.actions.run import RunActions
from desire_tui.actions.view import ViewActions
from desire_tui.desk import Desk
from desire_tui.editor.area import CodeArea
from desire_tui.editor.checking import Checker
from desire_tui.editor.completer import Completer
from desire_tui.editor.keeper import Keeper
from desire_tui.editor.pane import EditorPane
from desire_tui.editor.popup import CompletionPopup
from desire_tui.engine.session import State
from desire_tui.engine_thread import EngineThread, ScreenListener
from desire_tui.line import CommandLine
from desire_tui.live import Live
from desire_tui.messages import Checked, EngineFault, EngineMessage
from desire_tui.news import EngineNews
from desire_tui.panes.command import CommandPane
from desire_tui.panes.console import Console
from desire_tui.panes.graph import GraphPane
from desire_tui.panes.help import HelpPane
from desire_tui.panes.history import History
from desire_tui.panes.keynames import key_names
from desire_tui.panes.problems import ProblemsPane
from desire_tui.panes.prompt import Prompt
from desire_tui.panes.quantities import QuantitiesPane
from desire_tui.panes.status import StatusBar
from desire_tui.startup import open_first
from desire_tui.tour import Tour

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from textual.binding import BindingType
    from textual.screen import Screen
    from textual.widget import Widget

    from desire_tui.actions import Controller
    from desire_tui.desk import Side
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.session import Permissions, Session

STATUS_EVERY_S, QUANTITIES_EVERY_S = 0.1, 0.35
EDITOR_ONLY = {"edit.undo", "edit.redo", "edit.select_all", "edit.comment", "file.close", "view.editor"}
"""Their keys mean something else inside a one-line field."""


class DesireApp(App[None]):
    """`DesireApp(files).run()` opens the IDE with these files in tabs."""

    TITLE = "Desire"
    CSS_PATH = "app.tcss"
    BINDINGS: ClassVar[list[BindingType]] = list(commands.bindings())
    COMMAND_PALETTE_BINDING = "ctrl+p"
    ENABLE_COMMAND_PALETTE = True

    def __init__(self, files: Sequence[Path] = (), *, permissions: Permissions | None = None) -> None:
        super().__init__()
        self.files = [Path(file) for file in files]
        self.settings, self._complaints = config.load()
        for theme in themes.THEMES:
            self.register_theme(theme)
        self.theme = self.settings.theme if self.settings.theme in self.available_themes else "dark"
        self.listener = ScreenListener(self.post_message)
        self.engine = EngineThread(self.listener, self.post_message, permissions)
        self.news = EngineNews(self)
        self.line = CommandLine(self)
        self.live = Live(self)
        self.tour = Tour(self)
        self.run_actions = RunActions(self)
        self.file = FileActions(self)
        self.actions_view = ViewActions(self)
        self._controllers: dict[str, Controller] = {
            "run": self.run_actions, "file": self.file, "edit": EditActions(self), "graph": GraphActions(self),
            "view": self.actions_view, "help": HelpActions(self),
        }  # fmt: skip
        self.is_ready = False
        """Whether the tabs are open and the timers run."""
        self.desk = Desk(History(places.state_folder() / "history.json"), self.settings.keys)

    @property
    def session(self) -> Session:
        """The engine; waits for it during the first moments."""
        return self.engine.session

    # ----------------------------------------------------------------------------------------------- panes

    @property
    def editor(self) -> EditorPane:
        """The editor pane."""
        return self.desk.query_one(EditorPane)

    @property
    def command(self) -> CommandPane:
        """The command pane."""
        return self.desk.query_one(CommandPane)

    @property
    def graph(self) -> GraphPane:
        """The graph pane."""
        return self.desk.query_one(GraphPane)

    @property
    def quantities(self) -> QuantitiesPane:
        """The quantities pane."""
        return self.desk.query_one(QuantitiesPane)

    @property
    def help_pane(self) -> HelpPane:
        """The help pane."""
        return self.desk.query_one(HelpPane)

    # ------------------------------------------------------------------------------------- start and end

    def get_default_screen(self) -> Screen[Any]:
        """Return the desktop."""
        return self.desk

    @on(Desk.Ready)
    async def _begin(self) -> None:
        """Open what is to be opened; the engine is imported meanwhile."""
        self.set_keymap(config.keymap(self.settings))
        self.keeper = Keeper(self.editor)
        self.completer = Completer(self, self.desk.query_one(CompletionPopup))
        await open_first(self)
        for sentence in (*self._complaints, *self._theme_complaint()):
            self.complain(sentence, code=None)
        self.desk.set_interval(self.settings.checkpoint_seconds, self.checkpoint)
        for number in (signal.SIGTERM, signal.SIGHUP):
            if threading.current_thread() is threading.main_thread():
                asyncio.get_running_loop().add_signal_handler(number, self._ended_from_outside)
        self.call_after_refresh(self.engine.start)

    def engine_ready(self) -> None:
        """Begin to colour, check and show what only the engine knows."""
        self.checker = Checker(self.session.check, self._checked, self._check_fault)
        for area in self.editor.areas:
            area.marks_changed()
            self._check_wanted(EditorPane.CheckWanted(area))
        self.desk.set_interval(1 / self.settings.frames_per_second, self.draw_frame)
        self.desk.set_interval(STATUS_EVERY_S, self.show_status)
        self.desk.set_interval(QUANTITIES_EVERY_S, lambda: self.quantities.show(self.session.values))
        self.is_ready = True

    def _checked(self, number: int, version: int, problems: tuple[Diagnostic, ...]) -> None:
        self.post_message(Checked(number, version, problems))

    def _check_fault(self, error: Exception) -> None:
        self.post_message(
            EngineFault(f"{type(error).__name__}: {error}", "".join(traceback.format_exception(error)))
        )

    def _theme_complaint(self) -> list[str]:
        wanted = self.settings.theme
        if wanted in self.available_themes:
            return []
        return [f"{places.config_file()}: no theme '{wanted}'; there are: {', '.join(self.available_themes)}"]

    def _ended_from_outside(self) -> None:
        """SIGTERM or a lost connection: keep the work in the recovery file, restore the terminal."""
        self.checkpoint()
        self._stop_engine()
        self.exit()

    def leave(self) -> None:
        """End well."""
        self.keeper.leave()
        self._stop_engine()
        self.exit()

    def _stop_engine(self) -> None:
        if self.engine.is_up:
            self.session.end()

    def checkpoint(self) -> None:
        """Write unsaved work to the recovery file."""
        if not self.keeper.checkpoint():
            folder = places.state_folder()
            self.notify(
                f"Unsaved work cannot be kept safe: {folder} cannot be written.",
                severity="warning",
                markup=False,
            )

    def on_app_blur(self) -> None:
        """Keep the work safe when the window loses the focus."""
        self.checkpoint()

    def _handle_exception(self, error: Exception) -> None:
        """Keep the work before Textual takes the screen down."""
        if hasattr(self, "keeper"):
            self.keeper.checkpoint()
        super()._handle_exception(error)

    # --------------------------------------------------------------------------------------------- actions

    def do(self, command_id: str, argument: str = "") -> None:
        """Carry out an action of the command table."""
        part, _, name = command_id.partition(".")
        result = getattr(self._controllers[part], name)(argument)
        if inspect.iscoroutine(result):
            self.run_worker(result, name=command_id, exit_on_error=True)

    def action_do(self, command_id: str) -> None:
        """Carry out what a key is bound to."""
        self.do(command_id)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """No action of the desktop while a dialog is open, and no editor's key in a one-line field."""
        if action == "do":
            from textual.widgets import Input

            if isinstance(self.screen, ModalScreen):
                return False
            if isinstance(self.focused, Input) and parameters[0] in EDITOR_ONLY:
                return False
        return True

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        """Fill the command palette from the table."""
        del screen
        for command in commands.COMMANDS:
            if command.id == "view.palette":
                continue
            keys = key_names(self.settings.keys.get(command.id, command.keys))
            title = f"{command.title}  {keys}" if keys else command.title
            yield SystemCommand(title, command.help, lambda command_id=command.id: self.do(command_id))

    def in_background(self, job: Callable[[], None]) -> None:
        """Do something slow that is not the engine's, such as drawing a picture."""
        threading.Thread(target=job, daemon=True, name="desire-picture").start()

    # ----------------------------------------------------------------------------------------------- layout

    def open_side(self, name: Side, *, toggle: bool = False) -> None:
        """Show a side pane and move there."""
        if not self.desk.open_side(name, toggle=toggle):
            self.bring(self.command.prompt)
            return
        if name == "quantities":
            self.quantities.show(self.session.values)
            self.quantities.table.focus()
        elif name == "problems":
            self.list_problems()
            self.desk.query_one("#problems").focus()

    def close_side(self) -> None:
        """Hide the side pane."""
        if self.desk.close_side():
            self.command.prompt.focus()

    def side_focus(self) -> Widget | None:
        """Return what gets the keys in the side pane, None if it is hidden."""
        match self.desk.side:
            case "quantities":
                return self.quantities.table
            case "problems":
                return self.desk.query_one("#problems")
            case "help":
                return self.help_pane.query_one("#help-search")
        return None

    def bring(self, widget: Widget) -> bool:
        """Move the keys to a widget; a pane shown alone gives way to the widget's."""
        if self.desk.alone is not None:
            self.desk.show_alone(self.desk.pane_of(widget))
        widget.focus()
        return widget.focusable

    def toggle_maximized(self, pane: Widget | None) -> None:
        """Show a pane (default: the focused one) alone, or all again."""
        if self.desk.alone is not None:
            self.desk.show_alone(None)
            return
        self.desk.show_alone(pane or self.desk.pane_of(self.focused))
        if pane is not None:
            pane.focus()

    # --------------------------------------------------------------------------------------------- refresh

    def show_status(self) -> None:
        """Bring the status bar up to date."""
        self.desk.query_one(StatusBar).status = self.session.status
        self.show_hint()

    def draw_frame(self) -> None:
        """Draw what is new in the graph, unless the terminal has not yet taken the last frame."""
        if not self.output_is_backed_up:
            self.graph.tick()

    @property
    def output_is_backed_up(self) -> bool:
        """Whether the terminal is slower than the app."""
        writer = getattr(self._driver, "_writer_thread", None)
        return writer is not None and writer._queue.qsize() > 0  # noqa: SLF001 - Textual is pinned; it has no public way

    @property
    def clipboard_hint(self) -> str:
        """What stands between OSC 52 and the clipboard."""
        if os.environ.get("TMUX"):
            return "In tmux this needs: set -g set-clipboard on"
        return ""

    # -------------------------------------------------------------------------------------- what panes ask for

    @on(EngineMessage)
    def _engine_says(self, message: EngineMessage) -> None:
        if self.desk.is_running:  # what arrives while the desktop closes has nobody to tell
            self.news.handle(message)

    @on(CommandPane.LinesEntered)
    def _lines(self, event: CommandPane.LinesEntered) -> None:
        if event.answer:
            self.listener.answer(event.lines[0])
        else:
            self.line.enter(event.lines)

    @on(EditorPane.Wanted)
    def _wanted(self, event: EditorPane.Wanted) -> None:
        self.do(event.command_id)

    @on(EditorPane.CheckWanted)
    def _check_wanted(self, event: EditorPane.CheckWanted) -> None:
        if not self.engine.is_up:
            return
        buffer = event.area.buffer
        self.checker.ask(buffer, self.editor.versions.get(buffer.number, 0), event.area.text)

    @on(EditorPane.Typed)
    def _typed(self) -> None:
        self.completer.open(forced=False)

    @on(CodeArea.PopupKey)
    @on(Prompt.PopupKey)
    def _popup_key(self, event: CodeArea.PopupKey | Prompt.PopupKey) -> None:
        self.completer.key(event.key)

    @on(Prompt.CompletionWanted)
    def _completion_wanted(self) -> None:
        self.completer.open(forced=True)

    @on(CompletionPopup.OptionSelected, "#completion")
    def _completion_clicked(self) -> None:
        self.completer.take()

    @on(Console.PlaceChosen)
    def _place_chosen(self, event: Console.PlaceChosen) -> None:
        area = next((a for a in self.editor.areas if a.buffer.name == event.place.name), None)
        if area is not None:
            self.editor.show(area, focus=True)
            area.go_to(event.place.row - 1, event.place.column - 1)

    @on(ProblemsPane.Chosen)
    def _problem_chosen(self, event: ProblemsPane.Chosen) -> None:
        self.editor.show(event.area, focus=True)
        event.area.go_to(event.mark.row, event.mark.start)

    @on(QuantitiesPane.Edited)
    def _quantity_edited(self, event: QuantitiesPane.Edited) -> None:
        self.line.enter([event.text])

    @on(QuantitiesPane.SliderMoved)
    def _slider_moved(self, event: QuantitiesPane.SliderMoved) -> None:
        self.live.ask(event.values, overlay=event.overlay)

    @on(GraphPane.PauseWanted)
    def _pause_wanted(self) -> None:
        if self.engine.is_busy:
            self.do("run.pause")

    # ------------------------------------------------------------------------------------------------ telling

    def complain(self, sentence: str, *, code: int | None) -> None:
        """Tell the user that something of his cannot be done."""
        text = f"error {code}: {sentence}" if code else sentence
        self.command.console.add(text, "error" if code else "warning")
        self.notify(text, severity="error" if code else "warning", markup=False, timeout=6)

    def show_problems(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Show problems as those of a program."""
        self.news.show(diagnostics)

    def list_problems(self) -> None:
        """Bring the problems pane up to date."""
        self.desk.query_one(ProblemsPane).show(self.editor.areas)

    def snapshot_written(self, path: Path) -> None:
        """Tell where the picture is."""
        self.command.console.add(f"{path}", "notice")
        self.notify(f"Saved {path}", markup=False, timeout=3)

    def samples(self, separator: str) -> str:
        """Return the last run's samples as a table: t, then every column."""
        record = self.session.runs[-1]
        head = separator.join(("t", *(column.name for column in record.columns)))
        rows = record.rows[: record.count].tolist()
        return "\n".join((head, *(separator.join(f"{value:.17g}" for value in row) for row in rows))) + "\n"

    def write_up(self, summary: str, details: str) -> None:
        """Keep a fault of ours in a file and say so; the session goes on."""
        path = places.state_folder() / "faults.log"
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("a", encoding="utf-8") as file:
                file.write(details + "\n")
            where = f"; details in {path}"
        except OSError:
            where = ""
        self.complain(f"a fault of this program, not of yours: {summary}{where}", code=None)

    def show_hint(self) -> None:
        """Say in the status row what a paused or waiting program expects."""
        hints = {
            State.PAUSED: "Paused · Enter goes on · Space Enter ends",
            State.ASKING: "The program waits for input · Ctrl+C breaks off",
            State.STOPPED: "Stopped · F10 or go continues",
        }
        self.desk.query_one(StatusBar).hint = hints.get(self.session.status.state, "")

    def send_breakpoints(self) -> None:
        """Tell the engine the breakpoints of the active program."""
        area = self.editor.active or self.editor.front
        self.session.set_breakpoints({row + 1 for row in area.marks.breakpoints})
