"""The command pane: what programs print, and the line where commands are typed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual import on
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import Input, Label

from desire_tui.panes.console_view import Console
from desire_tui.panes.pending_lines import PendingLines
from desire_tui.panes.prompt import Prompt
from desire_tui.panes.scrollback import Place

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from textual.app import ComposeResult

    from desire_tui.common.completion_hook import CompletionHook
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.panes.command_history import CommandHistory

PROMPT = "> "
PENDING_NOTICE = "Stopped at this line; those after it wait. ↑↓ edit them, Enter goes on, Esc gives them up."


class CommandPane(Vertical):
    """Output above, prompt below, a search field between them while it is wanted."""

    DEFAULT_CSS = """
    CommandPane > Horizontal { height: 1; background: $surface; }
    CommandPane #sign { width: auto; padding: 0 0 0 1; color: $primary; text-style: bold; }
    CommandPane #sign.-asking { color: $accent; }
    CommandPane #output-search { display: none; height: 1; border: none; padding: 0 1; background: $panel; }
    CommandPane #output-search:focus { border: none; }
    """

    class LinesEntered(Message):
        """Command lines to carry out, or the answer to an `input`."""

        def __init__(self, lines: list[str], *, answer: bool) -> None:
            super().__init__()
            self.lines = lines
            self.answer = answer

    def __init__(self, history: CommandHistory, completion: CompletionHook) -> None:
        super().__init__(id="command")
        self._completion = completion
        self.border_title = "Command"
        self._history = history
        self._asked: str | None = None

    def compose(self) -> ComposeResult:
        """Output, search field, prompt."""
        yield Console()
        yield Input(id="output-search", placeholder="search output · Enter upwards · Esc")
        pending = PendingLines()
        yield pending
        with Horizontal():
            yield Label(PROMPT, id="sign", markup=False)
            yield Prompt(self._history, pending, self._completion, self._entered)

    @property
    def console(self) -> Console:
        """The output."""
        return self.query_one(Console)

    @property
    def prompt(self) -> Prompt:
        """The line to type in."""
        return self.query_one(Prompt)

    @property
    def is_asking(self) -> bool:
        """Whether the next line answers an `input`."""
        return self._asked is not None

    def ask(self, prompt: str) -> None:
        """Take the next line as the answer to an `input`."""
        self._asked = prompt
        self._sign(prompt, asking=True)
        self.prompt.focus()

    def stop_asking(self) -> None:
        """Take lines as commands again."""
        self._asked = None
        self._sign(PROMPT)

    def keep_pending(self, lines: Sequence[str]) -> None:
        """Put lines that were not carried out back to where they can be edited, the first into the prompt."""
        unfinished = self.prompt.value
        self.query_one(PendingLines).keep([*lines, unfinished] if unfinished.strip() else lines)
        self.prompt.value = lines[0]
        self.prompt.cursor_position = len(lines[0])
        self.console.add(PENDING_NOTICE, "notice")

    def _sign(self, text: str, *, asking: bool = False) -> None:
        sign = self.query_one("#sign", Label)
        sign.update(text)
        sign.set_class(asking, "-asking")

    def problems(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Print problems with the line of the program and carets; a click goes to the place."""
        from desire_tui.engine.diagnostics import render

        for diagnostic in diagnostics:
            place = None
            if diagnostic.span is not None and diagnostic.source is not None:
                at = diagnostic.source.position(diagnostic.span.start)
                place = Place(diagnostic.source.name, at.row, at.column)
            head, *rest = render(diagnostic).splitlines() or [diagnostic.message]
            self.console.add(head, "warning" if diagnostic.severity == "warning" else "error", place)
            for line in rest:
                self.console.add(line, "code", place)

    def _entered(self, lines: list[str]) -> None:
        if self._asked is not None and lines:
            answer = lines[0]
            self.console.write(self._asked + answer + "\n", "output")
            self.stop_asking()
            self.app.post_message(self.LinesEntered([answer], answer=True))
            lines.pop(0)
            if not lines:
                return
        for line in lines:
            self.prompt.history.add(line)
        # not by way of all ancestors: a command begins some milliseconds sooner
        self.app.post_message(self.LinesEntered(lines, answer=False))

    @on(Prompt.Searching)
    def _searching(self, event: Prompt.Searching) -> None:
        event.stop()
        self._sign(PROMPT if event.pattern is None else f"search '{event.pattern}': ")

    def open_search(self) -> None:
        """Show the field that searches the output."""
        field = self.query_one("#output-search", Input)
        field.display = True
        field.focus()

    @on(Input.Submitted, "#output-search")
    def _search(self, event: Input.Submitted) -> None:
        event.stop()
        if not self.console.search(event.value) and event.value:
            self.notify("Not found in the output.", timeout=2)

    def key_escape(self) -> None:
        """Close the search field."""
        field = self.query_one("#output-search", Input)
        if field.display:
            field.display = False
            self.console.search("")
            self.prompt.focus()
