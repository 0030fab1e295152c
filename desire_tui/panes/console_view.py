"""Scrollback of the command pane: lines of text, pieces of which may be places in a program to go to."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip

from desire_tui.common import themes
from desire_tui.panes.scrollback import Scrollback

if TYPE_CHECKING:
    from textual import events
    from textual.selection import Selection

    from desire_tui.panes.scrollback import Kind, OutputLine, Place


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
        self.scrollback = Scrollback()
        self.found: tuple[str, int] | None = None
        """Text searched, line it was found in."""

    # -------------------------------------------------------------------------------------------- the lines

    def write(self, text: str, kind: Kind = "output") -> None:
        """Append text exactly as it comes; a line may come in pieces."""
        if text:
            at_end = self.is_vertical_scroll_end
            self.scrollback.write(text, kind)
            self._settle(at_end)

    def add(self, text: str, kind: Kind = "notice", place: Place | None = None) -> None:
        """Append whole lines; an unfinished one before is finished."""
        at_end = self.is_vertical_scroll_end
        self.scrollback.add(text, kind, place)
        self._settle(at_end)

    def clear(self) -> None:
        """Forget everything."""
        self.scrollback.clear()
        self._settle(at_end=True)

    @property
    def text(self) -> str:
        """All lines."""
        return "\n".join(line.text for line in self.scrollback.lines)

    def _settle(self, at_end: bool) -> None:
        self.virtual_size = Size(self.scrollback.width, len(self.scrollback.rows))
        if at_end:
            self.scroll_end(animate=False, immediate=True)
        self.refresh()

    def on_resize(self) -> None:
        """Break the lines anew."""
        at_end = self.is_vertical_scroll_end
        if self.scrollback.set_width(self.scrollable_content_region.width):
            self._settle(at_end)

    # --------------------------------------------------------------------------------------------- drawing

    def render_line(self, y: int) -> Strip:
        """Draw a row."""
        base = self.rich_style
        row = y + self.scroll_offset.y
        if row >= len(self.scrollback.rows):
            return Strip.blank(self.size.width, base)
        number, start, end = self.scrollback.rows[row]
        line = self.scrollback.lines[number]
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

    def _style(self, line: OutputLine) -> Style:
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
        count = len(self.scrollback.lines)
        here = self.found[1] if self.found is not None and self.found[0] == wanted else count
        at = self.scrollback.find(wanted, here, -1 if backwards else 1)
        self.found = (wanted, count if at is None else at)
        if at is not None:
            row = self.scrollback.row_of(at)
            self.scroll_to(y=max(0, row - self.size.height // 2), animate=False, immediate=True)
        self.refresh()
        return at is not None

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
        rows = self.scrollback.rows
        if 0 <= row < len(rows) and (place := self.scrollback.lines[rows[row].line].place) is not None:
            self.post_message(self.PlaceChosen(place))
