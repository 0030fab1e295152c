"""The graph as a picture, as `snapshot` saves it: sharp where the terminal shows pictures, else in blocks."""

from __future__ import annotations

import io
import os
import sys
from importlib.util import find_spec
from threading import Lock
from typing import TYPE_CHECKING, ClassVar

from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Container
from textual.message import Message
from textual.strip import Strip
from textual.widget import Widget
from textual.widgets import Label

from desire_tui.common.dialogs import Question
from desire_tui.panes.terminal_graphics import Graphics, graphics

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any

    from textual.app import ComposeResult
    from textual.timer import Timer

    from desire_tui.engine.graph.model import Graph
    from desire_tui.panes.graph_pane import GraphPane

RESIZED_S = 0.2
CELLS_MAX = 290
"""Kitty's placeholders number rows and columns with 297 marks."""
BLOCK_DOTS = 4
"""Dots of the picture for half a character."""
KEYS = "s saves · PgUp PgDn other graphs · Esc"
COARSE = "This terminal shows no pictures: blocks instead (F7: the graph in characters)"
INSTALL = "Sharp pictures: pip install 'desire-tui[pictures]'"
_asking = Lock()


def is_installed() -> bool:
    """Whether the library that speaks to kitty and sixel terminals is there."""
    return find_spec("textual_image") is not None


def sharp_widget(how: Graphics, png: bytes) -> Widget:
    """Return the widget of textual-image that shows a picture in this terminal."""
    # Imported outside a terminal, the library does not ask questions that the input thread would swallow
    os.environ["TEXTUAL_CELL_WIDTH"], os.environ["TEXTUAL_CELL_HEIGHT"] = map(str, how.cell)
    terminal, sys.__stdout__ = sys.__stdout__, io.StringIO()  # type: ignore[misc,assignment]
    try:
        from textual_image import widget
    finally:
        sys.__stdout__ = terminal  # type: ignore[misc]
    kind: Any = widget.SixelImage if how.kind == "sixel" else widget.TGPImage
    shown: Widget = kind(io.BytesIO(png))
    return shown


class Blocks(Widget):
    """A picture in half blocks: two dots a character, of each place the colour that stands out most."""

    DEFAULT_CSS = "Blocks { width: 100%; height: 100%; }"

    def __init__(self, png: bytes, columns: int, rows: int) -> None:
        super().__init__()
        import numpy as np
        from PIL import Image

        with Image.open(io.BytesIO(png)) as image:
            size = (columns * BLOCK_DOTS, 2 * rows * BLOCK_DOTS)
            dots = np.asarray(image.convert("RGB").resize(size), dtype=np.int16)
        ground = dots[0, 0]
        places = dots.reshape(2 * rows, BLOCK_DOTS, columns, BLOCK_DOTS, 3).swapaxes(1, 2)
        places = places.reshape(2 * rows, columns, BLOCK_DOTS**2, 3)
        strongest = np.abs(places - ground).sum(axis=3).argmax(axis=2)
        self.dots = np.take_along_axis(places, strongest[:, :, None, None], axis=2)[:, :, 0].tolist()
        """Red, green, blue by row and column; two rows a character."""

    def render_line(self, y: int) -> Strip:
        """Draw a row of characters."""
        if 2 * y + 1 >= len(self.dots):
            return Strip.blank(self.size.width)
        return Strip(
            [
                Segment("▀", Style(color=Color.from_rgb(*above), bgcolor=Color.from_rgb(*below)))
                for above, below in zip(self.dots[2 * y], self.dots[2 * y + 1], strict=True)
            ]
        )


class PictureScreen(Question[bool]):
    """Shows the graph pane's page. Dismissed with whether it is to be saved."""

    DEFAULT_CSS = """
    PictureScreen { background: $background; layout: vertical; }
    PictureScreen > Container { height: 1fr; align: center middle; }
    PictureScreen #paper { width: 100%; height: 1fr; overflow: hidden; }
    PictureScreen > Label { width: 1fr; height: 1; padding: 0 1; background: $panel; color: $text-muted;
                            text-wrap: nowrap; text-overflow: ellipsis; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q", "dismiss(False)", "Close"),
        Binding("s", "dismiss(True)", "Save"),
        Binding("pageup", "turn(-1)", show=False),
        Binding("pagedown", "turn(1)", show=False),
    ]
    known: ClassVar[Graphics | None] = None
    """What the terminal answered; it is asked once."""

    class Drawn(Message):
        """The picture is there."""

        def __init__(self, number: int, png: bytes, how: Graphics, columns: int, rows: int) -> None:
            super().__init__()
            self.number, self.png, self.how = number, png, how
            self.columns, self.rows = columns, rows

    def __init__(self, graph: GraphPane, in_background: Callable[[Callable[[], None]], object]) -> None:
        super().__init__()
        self._graph = graph
        self._in_background = in_background
        self._number = 0
        self._timer: Timer | None = None

    def compose(self) -> ComposeResult:
        """Place for the picture, a row of keys."""
        yield Container(Label("drawing …"), id="paper")
        yield Label(KEYS, id="picture-keys", markup=False)

    def on_resize(self) -> None:
        """Draw for the size there is now."""
        if self._timer is not None:
            self._timer.stop()
        if self._number:
            self._timer = self.set_timer(RESIZED_S, self._draw)
        else:
            self.call_after_refresh(self._draw)

    def action_turn(self, step: int) -> None:
        """Show the graph before or after."""
        if self._graph.turn(step):
            self._draw()

    def _draw(self) -> None:
        page = self._graph.page
        size = self.query_one("#paper").size
        if page is None or not size.width or not size.height:
            return
        self._number += 1
        number, columns, rows = self._number, min(size.width, CELLS_MAX), min(size.height, CELLS_MAX)

        def work() -> None:
            how = self._how()
            png = _png(page, how, columns, rows)
            self.post_message(self.Drawn(number, png, how, columns, rows))

        self._in_background(work)

    def _how(self) -> Graphics:
        cls = type(self)
        with _asking:
            if cls.known is None:
                cls.known = graphics(self.app._driver)  # noqa: SLF001 - Textual is pinned; it has no public way
            return cls.known

    @on(Drawn)
    async def _drawn(self, event: Drawn) -> None:
        if event.number != self._number:  # the window was resized meanwhile
            return
        sharp = event.how.kind != "none" and is_installed()
        paper = self.query_one("#paper", Container)
        await paper.remove_children()
        if sharp:
            picture = sharp_widget(event.how, event.png)
            picture.styles.width, picture.styles.height = event.columns, event.rows
        else:
            picture = Blocks(event.png, event.columns, event.rows)
        await paper.mount(picture)
        hint = "" if sharp else INSTALL if event.how.kind != "none" else COARSE
        self.query_one("#picture-keys", Label).update(" · ".join(filter(None, (hint, KEYS))))


def _png(page: Graph, how: Graphics, columns: int, rows: int) -> bytes:
    from desire_tui.engine.outputs.matplotlib_figure import png_of

    width, height = how.cell if how.kind != "none" else (2 * BLOCK_DOTS, 4 * BLOCK_DOTS)
    return png_of(page, columns * width, rows * height)
