"""Sequences of edits in panes of every height, compared with a list of lines.

By hand: `python -m tests.fuzz.editor SECONDS [SEED]`. A failure names its seed.
"""

from __future__ import annotations

import asyncio
import random
import sys
from time import monotonic
from typing import TYPE_CHECKING, Any

from textual import events
from textual.geometry import Region
from textual.widgets import Input
from textual.widgets.text_area import Selection

from desire_tui.common.themes import THEMES
from desire_tui.desktop.themed_app import ThemedApp
from desire_tui.editor import indent
from desire_tui.editor.buffer import Buffer
from desire_tui.editor.editor_pane import EditorPane
from desire_tui.editor.find_bar import FindBar

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.pilot import Pilot

    from desire_tui.editor.code_area import CodeArea

LINES = (
    "",
    "x = 1",
    "  d/dt x = -x",
    "-- about x",
    "y=(x+[a])*{b}",
    "wörd\tx 界界",
    "x" * 150,
    "   ",
    "a\fb",
)
LETTERS = "xyz()=+ é界\t"
OPERATIONS = (
    "letter", "letter", "letter", "enter", "paste", "paste", "backspace", "delete", "delete_line", "cut",
    "indent", "dedent", "comment", "move_up", "move_down", "duplicate", "replace_all", "find", "all",
    "undo", "undo", "undo", "redo", "redo", "select", "select", "go", "page", "view", "draw",
)  # fmt: skip


class NoCompletion:
    """Nothing is completed."""

    def handle_key(self, event: events.Key, target: Any) -> bool:
        return False

    def letter_typed(self, target: Any) -> None: ...

    text_changed = focus_lost = offer = letter_typed


class EditorApp(ThemedApp):
    """The editor pane alone."""

    def __init__(self) -> None:
        super().__init__()
        self.editor = EditorPane(NoCompletion())
        self.fault: Exception | None = None
        self.theme = THEMES[0].name

    def _handle_exception(self, error: Exception) -> None:
        self.fault = self.fault or error

    def compose(self) -> ComposeResult:
        yield self.editor


def some_text(rng: random.Random) -> str:
    lines = rng.choice((0, 1, 2, 5, 30, 45, 300))
    return "\n".join(rng.choice(LINES) for _ in range(rng.randint(0, lines)))


def spliced(text: str, start: tuple[int, int], end: tuple[int, int], new: str) -> str:
    """The model: what stands between two places of a text is replaced."""
    lines = text.split("\n")
    start, end = sorted((start, end))
    before = [*lines[: start[0]], lines[start[0]][: start[1]]]
    after = [lines[end[0]][end[1] :], *lines[end[0] + 1 :]]
    return "\n".join(before) + new + "\n".join(after)


class Sequence:
    """One text, its edits, and the text that there should be."""

    def __init__(self, editor: EditorPane, rng: random.Random, text: str) -> None:
        self.editor, self.rng, self.text = editor, rng, text
        self.states = [text]
        """The text for each depth of the undo stack."""

    @property
    def area(self) -> CodeArea:
        return self.editor.front

    async def operation(self, name: str) -> None:
        history = self.area.history
        depth, forward = len(history.undo_stack), len(history.redo_stack)
        expected = self.text
        if name == "undo":
            expected = self.states[depth - 1] if depth else self.text
            self.area.action_undo()
        elif name == "redo":
            expected = self.states[depth + 1] if forward else self.text
            self.area.action_redo()
        elif (change := getattr(self, f"_{name}", None)) is not None:
            await change()
        else:
            expected = await self._edit(name)
        now = len(history.undo_stack)
        if name not in ("undo", "redo") and (expected != self.text or now > depth):
            self.states[now:] = [expected]
            assert len(self.states) == now + 1
        self.text = expected
        self.check()

    def check(self, *, drawn: bool = False) -> None:
        """Text, cursor, selection and every view fit together, and every row can be drawn."""
        area = self.area
        assert area.text == area.document.text == self.text
        for view in area.views:
            document = view.document
            for row, column in view.selection:
                assert 0 <= row < document.line_count
                assert 0 <= column <= len(document.get_line(row))
            if view.display and view.size:
                assert view.virtual_size.height == document.line_count
                if drawn:  # a find bar that opens takes its rows at the next layout
                    assert 0 <= view.scroll_offset.y <= max(0, document.line_count - view.size.height)
                width, height = view.size
                for y in range(height) if drawn else (0, height - 1):
                    view.render_lines(Region(0, y, width, 1))

    # ------------------------------------------------------------------------------------------- edits

    async def _edit(self, name: str) -> str:
        """Carry out an edit; returns the text that should be there afterwards."""
        area, rng, text = self.area, self.rng, self.text
        lines = text.split("\n")
        start, end = sorted(area.selection)
        (top, left), bottom = start, end[0]
        if bottom > top and end[1] == 0:
            bottom -= 1
        match name:
            case "letter":
                letter = rng.choice(LETTERS)
                area._replace_via_keyboard(letter, *area.selection)
                return spliced(text, start, end, letter)
            case "enter":
                area._new_line()
                blanks = lines[top][:left]
                blanks = blanks[: len(blanks) - len(blanks.lstrip())]
                return spliced(text, start, end, "\n" + blanks)
            case "paste":
                new = some_text(rng)
                ends = rng.choice(("\n", "\r\n", "\r"))
                await area._on_paste(events.Paste(new.replace("\n", ends)))
                return spliced(text, start, end, new)
            case "cut" | "backspace" | "delete":
                (area.action_cut if name == "cut" and start != end else area.action_delete_left if name != "delete"
                 else area.action_delete_right)()  # fmt: skip
                if start == end and name != "delete":
                    start = (top, left - 1) if left else (top - 1, len(lines[top - 1])) if top else start
                elif start == end:
                    last = top == len(lines) - 1
                    end = (top, left + 1) if left < len(lines[top]) else end if last else (top + 1, 0)
                return spliced(text, start, end, "")
            case "delete_line":
                area.action_delete_line()
                if bottom + 1 < len(lines):
                    return "\n".join([*lines[:top], *lines[bottom + 1 :]])
                return spliced(text, (top, 0), (bottom, len(lines[bottom])), "")
            case "indent" | "dedent":
                area.shift_lines(1 if name == "indent" else -1)
                lines[top : bottom + 1] = indent.shift(lines[top : bottom + 1], 1 if name == "indent" else -1)
            case "comment":
                area.toggle_comment()
                lines[top : bottom + 1] = indent.toggle_comment(lines[top : bottom + 1])
            case "move_up" | "move_down":
                step = -1 if name == "move_up" else 1
                area.move_line(step)
                if step < 0 < top:
                    lines.insert(bottom, lines.pop(top - 1))
                elif step > 0 and bottom + 1 < len(lines):
                    lines.insert(top, lines.pop(bottom + 1))
            case "duplicate":
                row = area.cursor_location[0]
                area.duplicate_line()
                lines.insert(row, lines[row])
            case "replace_all":
                by = rng.choice(("", "q", "xx", r"\n", "longer than x"))
                bar = self._open_bar("x")
                bar.query_one("#replacement", Input).value = by
                bar.replace_all()
                return text.replace("x", by)
        return "\n".join(lines)

    def _open_bar(self, wanted: str) -> FindBar:
        bar = self.editor.query_one(FindBar)
        bar.open(self.area, wanted, replace=True)
        bar.finder.limit_to_nothing()
        bar.finder.search_for(wanted)
        return bar

    # -------------------------------------------------------------------------- what leaves the text alone

    def _place(self) -> tuple[int, int]:
        row = self.rng.choice(
            (0, self.area.document.line_count - 1, self.rng.randrange(self.area.document.line_count))
        )
        return row, self.rng.randint(0, len(self.area.document.get_line(row)))

    async def _find(self) -> None:
        self._open_bar("x").action_step(self.rng.choice((-1, 1)))

    async def _all(self) -> None:
        self.area.select_all()

    async def _select(self) -> None:
        self.area.selection = Selection(self._place(), self._place())

    async def _go(self) -> None:
        self.area.go_to(*self._place())

    async def _page(self) -> None:
        self.rng.choice((self.area.action_cursor_page_up, self.area.action_cursor_page_down))()

    async def _view(self) -> None:
        others = [view for view in self.area.views if view is not self.area]
        if others and self.rng.random() < 0.6:
            self.editor.show(others[0], focus=True)
        else:
            await self.editor.show_twice()

    async def _draw(self) -> None:
        await settled()
        self.check(drawn=True)


async def settled() -> None:
    """Let the app deal with all that it was sent."""
    loop: Any = asyncio.get_running_loop()
    for _ in range(2):
        await asyncio.sleep(0.001)
        for _ in range(1000):
            if not loop._ready:
                break
            await asyncio.sleep(0)


async def one_sequence(app: EditorApp, pilot: Pilot[None], seed: int) -> None:
    """Edit one text, take everything back, and do all of it again."""
    rng = random.Random(seed)
    if rng.random() < 0.5:
        await pilot.resize_terminal(rng.choice((20, 60, 100)), rng.randint(1, 40) + 2)
    text = some_text(rng)
    old = app.editor.front.tab
    area = await app.editor.add(Buffer(label=f"seed-{seed}"), text)
    if old is not area:
        await app.editor.close_tab(old)
    await settled()
    done: list[str] = []
    sequence = Sequence(app.editor, rng, text)
    try:
        for _ in range(rng.randint(5, 40)):
            done.append(rng.choice(OPERATIONS))
            await sequence.operation(done[-1])
        await settled()
        sequence.check(drawn=True)
        for move, wanted in (
            (area.action_undo, text),
            (area.action_redo, sequence.states[-1]),
            (area.action_undo, text),
        ):
            for _ in range(100):
                move()
            sequence.text = wanted
            sequence.check()
            await settled()
            sequence.check(drawn=True)
    except Exception as error:
        raise AssertionError(f"seed {seed}: {done}") from error


async def run(seeds: range, seconds: float = float("inf")) -> int:
    """Run sequences until the time is over; returns how many."""
    app, stop, count = EditorApp(), monotonic() + seconds, 0
    async with app.run_test(size=(80, 20)) as pilot:
        await pilot.pause()  # what the pane is made of comes after it
        await app.editor.add(Buffer())
        for seed in seeds:
            await one_sequence(app, pilot, seed)
            count += 1
            if app.fault is not None:
                raise AssertionError(f"seed {seed}") from app.fault
            if monotonic() > stop:
                break
    return count


SEQUENCES = 5
"""An app takes longer to start than a sequence: so many share one."""


def generate(rng: random.Random) -> str:
    """Return the first seed of some sequences."""
    return str(rng.randrange(10**9))


def check(made: str) -> None:
    """Run them."""
    asyncio.run(run(range(int(made), int(made) + SEQUENCES)))


if __name__ == "__main__":
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    number = asyncio.run(run(range(first, sys.maxsize), float(sys.argv[1])))
    sys.stdout.write(f"{number} sequences of edits from seed {first} on, no failure\n")
