"""The app's panes by name, and which of them are shown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.desktop.themed_app import ThemedApp
from desire_tui.panes.problems_pane import ProgramProblems

if TYPE_CHECKING:
    from textual.widget import Widget

    from desire_tui.desktop.engine_thread import EngineThread
    from desire_tui.desktop.layout_rules import Pane
    from desire_tui.desktop.main_screen import MainScreen
    from desire_tui.editor.editor_pane import EditorPane
    from desire_tui.engine.session.session import Session
    from desire_tui.panes.command_pane import CommandPane
    from desire_tui.panes.graph_pane import GraphPane
    from desire_tui.panes.help_pane import HelpPane
    from desire_tui.panes.quantities_pane import QuantitiesPane
    from desire_tui.panes.side_pane import Side


class PanedApp(ThemedApp):
    """What actions and messages do with the panes."""

    main_screen: MainScreen
    engine: EngineThread

    @property
    def session(self) -> Session:
        """The engine; waits for it during the first moments."""
        return self.engine.session

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
