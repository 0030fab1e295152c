"""What panes and the engine's thread ask of the app: messages become actions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from textual import on

from desire_tui.desktop.engine_messages import EngineMessage
from desire_tui.desktop.lasting_app import LastingApp
from desire_tui.editor.completion_popup import CompletionPopup
from desire_tui.editor.editor_pane import EditorPane
from desire_tui.panes.command_pane import CommandPane
from desire_tui.panes.console_view import Console
from desire_tui.panes.graph_pane import GraphPane
from desire_tui.panes.problems_pane import ProblemsPane
from desire_tui.panes.quantities_pane import QuantitiesPane
from desire_tui.panes.side_pane import SidePane
from desire_tui.panes.sliders import Sliders
from desire_tui.panes.status_bar import StatusBar

if TYPE_CHECKING:
    from desire_tui.desktop.command_line import CommandLine
    from desire_tui.desktop.live_chart import LivePage
    from desire_tui.desktop.live_mode import LiveMode
    from desire_tui.desktop.message_handlers import MessageHandlers


class AskedApp(LastingApp):
    """Passes on what panes ask for."""

    message_handlers: MessageHandlers
    command_line: CommandLine
    live_mode: LiveMode
    live_page: LivePage

    def do(self, command_id: str, argument: str = "") -> Any:
        """Carry out an action of the command table."""
        raise NotImplementedError

    @on(EngineMessage)
    def _engine_says(self, message: EngineMessage) -> None:
        self.message_handlers.handle(message)

    @on(CommandPane.LinesEntered)
    def _lines(self, event: CommandPane.LinesEntered) -> None:
        if event.answer:
            self.listener.answer(event.lines[0])
        else:
            self.command_line.enter(event.lines)

    @on(EditorPane.ActionRequested)
    def _wanted(self, event: EditorPane.ActionRequested) -> None:
        self.do(event.command_id, event.argument)

    @on(EditorPane.CheckRequested)
    def _check_requested(self, event: EditorPane.CheckRequested) -> None:
        if not self.engine.is_ready:
            return  # every text is checked once the engine is there
        buffer = event.area.buffer
        if not buffer.is_program:
            return
        self.checker.ask(buffer, self.editor.versions.get(buffer.number, 0), event.area.text)

    @on(CompletionPopup.OptionSelected, "#completion")
    def _completion_clicked(self) -> None:
        self.completer.insert_chosen()

    @on(Console.PlaceChosen)
    def _place_chosen(self, event: Console.PlaceChosen) -> None:
        area = next((a for a in self.editor.areas if a.buffer.name == event.place.name), None)
        if area is not None:
            self.editor.show(area, focus=True)
            area.go_to(event.place.row - 1, event.place.column - 1)

    @on(ProblemsPane.Chosen)
    def _problem_chosen(self, event: ProblemsPane.Chosen) -> None:
        area = self.editor.find(event.tab)
        if area is not None:  # it may have been closed
            self.editor.show(area, focus=True)
            area.go_to(event.mark.row, event.mark.start)

    @on(SidePane.PageRequested)
    def _page_requested(self, event: SidePane.PageRequested) -> None:
        self.open_side(event.name)
        if event.name == "help":
            self.help_pane.show_topic("")

    @on(QuantitiesPane.Edited)
    def _quantity_edited(self, event: QuantitiesPane.Edited) -> None:
        self.command_line.enter([event.text])

    @on(QuantitiesPane.PlotRequested)
    def _plot_requested(self, event: QuantitiesPane.PlotRequested) -> None:
        self.do("graph.chart", event.name)

    @on(Sliders.Moved)
    def _slider_moved(self, event: Sliders.Moved) -> None:
        if self.live_page.is_shown:
            self.live_page.moved(event.values)
        else:
            self.live_mode.ask(event.values, overlay=event.overlay, quantity=event.quantity)

    @on(QuantitiesPane.SliderRequested)
    def _slider_requested(self, event: QuantitiesPane.SliderRequested) -> None:
        self.do("run.live", event.name)

    @on(StatusBar.Clicked)
    def _status_clicked(self, event: StatusBar.Clicked) -> None:
        self.do(event.command_id)

    @on(GraphPane.TurnRequested)
    def _turn_requested(self, event: GraphPane.TurnRequested) -> None:
        self.do("graph.older" if event.step < 0 else "graph.newer")

    @on(GraphPane.Pointed)
    def _pointed(self, event: GraphPane.Pointed) -> None:
        if self.live_page.is_shown:
            self.live_page.pointed(event.x, event.y)

    @on(GraphPane.PauseRequested)
    def _pause_requested(self) -> None:
        if self.engine.is_busy:
            self.do("run.pause", "at once")
