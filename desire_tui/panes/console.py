"""Scrollback of the command pane: lines of text, pieces of which may be places in a program to go to."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, Literal

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip

from desire_tui import themes

if TYPE_CHECKING:
    from textual import events
    from textual.selection import Selection

Kind = Literal["output", "command", "error", "warning", "notice", "code"]
LINES_MAX = 20_000
LINE_CHARS_MAX = 4_000
_CONTROL = {code: 0xFFFD for code in (*range(32), 127, *range(128, 160)) if code != 9}


@dataclass(frozen=True, slots=True)
class Place:
    """A place in a program that a line of output points at; row and column from 1."""

    name: str
    row: int
    column: int


@dataclass(slots=True)
class _Line:
    text: str
    kind: Kind
    place: Place | None = None


class Console(ScrollView):
    """Shows what programs print. Stays at the end unless the user scrolled up."""

    DEFAULT_CSS = """
    Console { height: 1fr; scrollbar-size-vertical: 1; scrollbar-size-horizontal: 0;
              overflow-x: hidden; overflow-y: scroll;
              padding: 0 1; background: $surface; }
    """
    can_focus = False
    ALLOW_SELECT = True

    class PlaceChosen(Message):
        """A position was clicked."""

        def __init__(self, place: Place) -> None:
            super().__init__()
            self.place = place

    def __init__(self) -> None:
        super().__init__(id="console")
        self._lines: list[_Line] = []
        self._open = False
        self._rows: list[tuple[int, int, int]] = []  # row on screen → line, first character, last + 1
        self._width = 0
        self.found: tuple[str, int] | None = None
        """Text searched, line it was found in."""

    # -------------------------------------------------------------------------------------------- the lines

    def write(self, text: str, kind: Kind = "output") -> None:
        """Append text exactly as it comes; a line may come in pieces."""
        if not text:
            return
        at_end = self.is_vertical_scroll_end
        pieces = text.split("\n")
        if self._open and self._lines and self._lines[-1].kind == kind:
            line = self._lines[-1]
            line.text = (line.text + pieces.pop(0).expandtabs(8).translate(_CONTROL))[:LINE_CHARS_MAX]
            self._lay_out(len(self._lines) - 1)
        if pieces and pieces[-1] == "":
            pieces.pop()
            ended = True
        else:
            ended = text.endswith("\n")
        first = len(self._lines)
        self._lines += [_Line(p.expandtabs(8).translate(_CONTROL)[:LINE_CHARS_MAX], kind) for p in pieces]
        self._open = not ended
        self._lay_out(first)
        self._settle(at_end)

    def add(self, text: str, kind: Kind = "notice", place: Place | None = None) -> None:
        """Append whole lines; an unfinished one before is finished."""
        at_end = self.is_vertical_scroll_end
        first = len(self._lines)
        for line in text.split("\n"):
            self._lines.append(_Line(line.expandtabs(8).translate(_CONTROL)[:LINE_CHARS_MAX], kind, place))
        self._open = False
        self._lay_out(first)
        self._settle(at_end)

    def clear(self) -> None:
        """Forget everything."""
        self._lines.clear()
        self._open = False
        self._lay_out(0)
        self._settle(at_end=True)

    @property
    def text(self) -> str:
        """All lines."""
        return "\n".join(line.text for line in self._lines)

    def _lay_out(self, first: int) -> None:
        """Break lines from number `first` on into rows of the pane's width."""
        if len(self._lines) > LINES_MAX:
            del self._lines[: len(self._lines) - LINES_MAX]
            first = 0
        while self._rows and self._rows[-1][0] >= first:
            self._rows.pop()
        if first == 0:
            self._rows.clear()
        width = max(self._width, 10)
        for number, line in enumerate(islice(self._lines, first, None), first):
            start, end = 0, len(line.text)
            while end - start > width:
                cut = line.text.rfind(" ", start + width // 2, start + width + 1) + 1 or start + width
                self._rows.append((number, start, cut))
                start = cut
            self._rows.append((number, start, end))

    def _settle(self, at_end: bool) -> None:
        self.virtual_size = Size(self._width, len(self._rows))
        if at_end:
            self.scroll_end(animate=False, immediate=True)
        self.refresh()

    def on_resize(self) -> None:
        """Break the lines anew."""
        width = self.scrollable_content_region.width
        if width != self._width:
            self._width = width
            at_end = self.is_vertical_scroll_end
            self._lay_out(0)
            self._settle(at_end)

    # --------------------------------------------------------------------------------------------- drawing

    def render_line(self, y: int) -> Strip:
        """Draw a row."""
        base = self.rich_style
        row = y + self.scroll_offset.y
        if row >= len(self._rows):
            return Strip.blank(self.size.width, base)
        number, start, end = self._rows[row]
        line = self._lines[number]
        text = line.text[start:end]
        style = base + self._style(line)
        segments = [Segment(text, style)]
        if self.found and self.found[0] and self.found[0].casefold() in text.casefold():
            segments = self._marked(text, style, self.found[0])
        strip = Strip(segments, cell_len(text)).crop(0, self.size.width)
        strip = strip.adjust_cell_length(self.size.width, base).apply_offsets(start, number)
        if (selection := self.text_selection) is not None and (
            span := selection.get_span(number)
        ) is not None:
            first, last = span[0] - start, (len(text) if span[1] == -1 else span[1] - start)
            if last > 0 and first < len(text):
                chosen = self.screen.get_component_rich_style("screen--selection")
                first = max(first, 0)
                strip = Strip.join(
                    [strip.crop(0, first), strip.crop(first, last).apply_style(chosen), strip.crop(last)]
                )
        return strip

    def _style(self, line: _Line) -> Style:
        theme = self.app.current_theme
        match line.kind:
            case "error":
                return Style(color=str(theme.error), underline=line.place is not None)
            case "warning":
                return Style(color=str(theme.warning), underline=line.place is not None)
            case "command":
                return Style(color=str(theme.primary), bold=True)
            case "notice":
                return Style(color=str(theme.accent), italic=True)
            case "code":
                return Style(color=themes.quiet(theme))
            case _:
                return Style()

    @staticmethod
    def _marked(text: str, style: Style, wanted: str) -> list[Segment]:
        segments, at = [], 0
        lower, wanted = text.casefold(), wanted.casefold()
        while (hit := lower.find(wanted, at)) >= 0:
            segments += [
                Segment(text[at:hit], style),
                Segment(text[hit : hit + len(wanted)], style + Style(reverse=True)),
            ]
            at = hit + len(wanted)
        return [*segments, Segment(text[at:], style)]

    # ------------------------------------------------------------------------------------- search and copy

    def search(self, wanted: str, *, backwards: bool = True) -> bool:
        """Scroll to the next line that holds the text, upwards by default; False if there is none."""
        if not wanted:
            self.found = None
            self.refresh()
            return False
        count = len(self._lines)
        again = self.found is not None and self.found[0] == wanted
        here = self.found[1] if again and self.found else count
        order = range(here - 1, here - 1 - count, -1) if backwards else range(here + 1, here + 1 + count)
        for number in order:
            at = number % count if count else 0
            if count and wanted.casefold() in self._lines[at].text.casefold():
                self.found = (wanted, at)
                row = next(r for r, (line, *_) in enumerate(self._rows) if line == at)
                self.scroll_to(y=max(0, row - self.size.height // 2), animate=False, immediate=True)
                self.refresh()
                return True
        self.found = (wanted, count)
        self.refresh()
        return False

    def get_selection(self, selection: Selection) -> tuple[str, str] | None:
        """Return the text selected with the mouse."""
        return selection.extract(self.text), "\n"

    def selection_updated(self, selection: Selection | None) -> None:
        """Draw again."""
        del selection
        self.refresh()

    def on_click(self, event: events.Click) -> None:
        """Go to the place that the line names."""
        row = int(event.y) + self.scroll_offset.y
        if 0 <= row < len(self._rows) and (place := self._lines[self._rows[row][0]].place) is not None:
            self.post_message(self.PlaceChosen(place))
