"""The IDE: wiring of panes, actions and the engine's thread; `desktop.main_screen` is what is shown."""

from __future__ import annotations

import inspect
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from textual import on
from textual.app import SystemCommand
from textual.screen import ModalScreen

from desire_tui import commands
from desire_tui.actions.analysis_actions import AnalysisActions
from desire_tui.actions.edit_actions import EditActions
from desire_tui.actions.file_actions import FileActions
from desire_tui.actions.graph_actions import GraphActions
from desire_tui.actions.help_actions import HelpActions
from desire_tui.actions.run_actions import RunActions
from desire_tui.actions.study_actions import StudyActions
from desire_tui.actions.view_actions import ViewActions
from desire_tui.common import config, paths, plain_characters
from desire_tui.common.key_names import key_names
from desire_tui.common.reach import Reach
from desire_tui.desktop import alt_keys, visible_screen
from desire_tui.desktop.analysis_runner import AnalysisRunner
from desire_tui.desktop.asked_app import AskedApp
from desire_tui.desktop.command_line import CommandLine
from desire_tui.desktop.engine_messages import CheckFinished
from desire_tui.desktop.first_tabs import open_first
from desire_tui.desktop.frame_pacing import FramePacing
from desire_tui.desktop.live_chart import LivePage
from desire_tui.desktop.live_mode import LiveMode
from desire_tui.desktop.main_screen import MainScreen
from desire_tui.desktop.message_handlers import MessageHandlers
from desire_tui.desktop.study_runner import StudyRunner
from desire_tui.desktop.tour import Tour
from desire_tui.editor.editor_pane import EditorPane
from desire_tui.language.live_check import LiveChecker

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from textual.binding import BindingType
    from textual.command import Provider
    from textual.screen import Screen

    from desire_tui.actions import Controller
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.session.permissions import Permissions
    from desire_tui.engine.source import Source

STATUS_EVERY_S, QUANTITIES_EVERY_S = 0.1, 0.6
"""Numbers to read: drawing the table of quantities takes as long as five frames of the graph."""
ENGINE_AFTER_S = 0.05
"""A key typed as soon as the desktop is seen is answered first: Python imports in one thread at a time."""
EDITOR_ONLY = {"edit.undo", "edit.redo", "edit.select_all", "edit.comment", "file.close"}
"""Their keys mean something else inside a one-line field."""
IN_EDITOR_ONLY = {
    "edit.duplicate", "edit.move_up", "edit.move_down", "edit.dedent", "edit.cut", "edit.copy", "edit.paste",
}  # fmt: skip
"""Their keys mean something else outside the editor."""


def _palette() -> type[Provider]:
    from desire_tui.desktop.palette import Actions

    return Actions


class DesireApp(AskedApp):
    """`DesireApp(files).run()` opens the IDE with these files in tabs."""

    TITLE = "Desire"
    CSS_PATH = "app.tcss"
    BINDINGS: ClassVar[list[BindingType]] = list(commands.bindings())
    COMMAND_PALETTE_BINDING = "ctrl+p"
    COMMANDS: ClassVar[set[type[Provider] | Callable[[], type[Provider]]]] = {_palette}
    ENABLE_COMMAND_PALETTE = True

    def __init__(self, files: Sequence[Path] = (), *, permissions: Permissions | None = None) -> None:
        alt_keys.teach()
        super().__init__(permissions)
        visible_screen.teach(plain=self.settings.plain_characters or plain_characters.are_needed())
        self.files = [Path(file) for file in files]
        self.begin_with_theme(self.settings.theme)
        self.message_handlers = MessageHandlers(self)
        self.frame_pacing = FramePacing(self)
        self.command_line = CommandLine(self)
        self.live_mode = LiveMode(self)
        self.studies = StudyRunner(self)
        self.analyses = AnalysisRunner(self)
        self.live_page = LivePage(self)
        self.tour = Tour(self)
        self.run_actions = RunActions(self)
        self.file_actions = FileActions(self)
        self.view_actions = ViewActions(self)
        self._controllers: dict[str, Controller] = {
            "run": self.run_actions, "file": self.file_actions, "edit": EditActions(self),
            "graph": GraphActions(self), "study": StudyActions(self), "analysis": AnalysisActions(self),
            "view": self.view_actions, "help": HelpActions(self),
        }  # fmt: skip
        self.checker = LiveChecker(
            partial(self._check, quick=True), self._checked, self.report_fault, self._check
        )
        self.is_ready = False
        """Whether the tabs are open and the timers run."""
        self.stylesheet.set_variables(self.get_css_variables())

    def limit_to_visitors(self, folder: Path, *, allow_shell: bool, allow_write: bool) -> None:
        """Give whoever is here, and programs, what the one who serves allows, and ask for nothing more."""
        from desire_tui.engine.session.permissions import Permissions

        self.engine.permissions = Permissions(allow_shell, allow_write, asks=False)
        if not allow_write:
            self.reach = Reach(folder.resolve())

    # ------------------------------------------------------------------------------------- start and end

    def get_default_screen(self) -> Screen[Any]:
        """Return the desktop."""
        return self.main_screen

    def refresh_css(self, animate: bool = True) -> None:
        """Style everything anew; not for the first theme, in whose colours the style sheet was made."""
        if self.main_screen.is_running:
            super().refresh_css(animate)

    @on(MainScreen.Ready)
    async def _begin(self) -> None:
        """Open what is to be opened; the engine is imported meanwhile."""
        self.set_keymap(config.keymap(self.settings))
        await open_first(self)
        for sentence in (*self.config_errors, *self._theme_errors()):
            self.report_error(sentence, code=None)
        self.main_screen.set_interval(self.settings.checkpoint_seconds, self.checkpoint_soon)
        self.listen_to_signals()
        self.theme_changed_signal.subscribe(self.main_screen, lambda _: self.follow_theme())
        self.call_later(self._show)

    async def _show(self) -> None:
        """Draw the desktop for the first time, now that everything stands in its place."""
        self.main_screen.release()
        self.is_shown = True
        await self.take_typed_ahead()
        self.main_screen.set_timer(ENGINE_AFTER_S, self.engine.start)

    def engine_ready(self) -> None:
        """Begin to colour, check and show what only the engine knows."""
        for area in self.editor.areas:
            area.marks_changed()
            self._check_requested(EditorPane.CheckRequested(area))
        self.main_screen.set_interval(1 / self.settings.frames_per_second, self.frame_pacing.frame)
        self.main_screen.set_interval(STATUS_EVERY_S, self.show_status)
        self.main_screen.set_interval(QUANTITIES_EVERY_S, lambda: self.quantities.show(self.session.values))
        self.is_ready = True
        self.command_line.next()

    def _check(self, source: Source, *, quick: bool = False) -> tuple[Diagnostic, ...]:
        from desire_tui.engine.session.session import CHECK_SECONDS

        return self.session.check(source, quick=quick, seconds=CHECK_SECONDS)

    def _checked(self, number: int, version: int, problems: tuple[Diagnostic, ...]) -> None:
        self.post_message(CheckFinished(number, version, problems))

    def _theme_errors(self) -> list[str]:
        wanted = self.settings.theme
        if wanted in self.available_themes:
            return []
        return [f"{paths.config_file()}: no theme '{wanted}'; there are: {', '.join(self.available_themes)}"]

    def show_problems(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Show problems as those of a program."""
        self.message_handlers.show(diagnostics)

    def on_app_focus(self) -> None:
        """Take notice of what happened to files while the window did not have the focus."""
        if self.is_ready:
            self.file_actions.save_and_reload.notice_changes()

    def _stop_engine(self) -> None:
        self.studies.stop()
        self.analyses.stop()
        super()._stop_engine()

    # --------------------------------------------------------------------------------------------- actions

    def call(self, command_id: str, argument: str = "") -> Any:
        """Begin an action of the command table; one that asks the user something is a coroutine to await."""
        part, _, name = command_id.partition(".")
        if part == "run":
            self.checkpoint_soon()  # a program can end the process
        return getattr(self._controllers[part], name)(argument)

    def do(self, command_id: str, argument: str = "") -> None:
        """Carry out an action of the command table."""
        result = self.call(command_id, argument)
        if inspect.iscoroutine(result):
            self.key_ordering.action_begun = self.run_worker(result, name=command_id, exit_on_error=True)

    def action_do(self, command_id: str) -> None:
        """Carry out what a key is bound to."""
        self.do(command_id)

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """No action of the desktop while a dialog is open, and no editor's key in a one-line field."""
        if action == "do":
            from textual.widgets import Input

            from desire_tui.editor.code_area import CodeArea
            from desire_tui.editor.find_bar import FindBar

            if isinstance(self.screen, ModalScreen):
                return False
            if parameters[0] in IN_EDITOR_ONLY and not isinstance(self.focused, CodeArea):
                return False
            if isinstance(self.focused, Input) and parameters[0] in EDITOR_ONLY:
                in_find_bar = any(isinstance(ancestor, FindBar) for ancestor in self.focused.ancestors)
                return in_find_bar and parameters[0] in ("edit.undo", "edit.redo")
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
