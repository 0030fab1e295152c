"""The sheet of all keys, over the whole screen; a search narrows it, Enter carries an action out."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, NamedTuple

from rich.text import Text
from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical, VerticalScroll
from textual.widgets import Input, Static

from desire_tui.commands import BY_ID, COMMANDS
from desire_tui.common.command_search import is_described
from desire_tui.common.dialogs import Question
from desire_tui.common.key_names import key_names

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from textual.app import ComposeResult

HEADINGS = {
    "run": "Running", "file": "Files and tabs", "edit": "Editing", "graph": "The graph", "study": "Studies",
    "analysis": "After the curve",
    "view": "Panes and screen", "help": "Help",
}  # fmt: skip
KEY_CELLS, COLUMN_CELLS = 17, 42


class Entry(NamedTuple):
    """An action and its keys; `part` is the heading it stands under.

    `command_id` is empty for what only a pane's own keys do, and only there.
    """

    part: str
    command_id: str
    keys: str
    title: str


def entries(keys: Mapping[str, str], of_panes: Mapping[str, Sequence[BindingType]]) -> list[Entry]:
    """Return all that has a key. `keys`: those the user changed; `of_panes`: panes' own, by heading."""
    rows = [
        Entry(command.id.partition(".")[0], command.id, shown, command.title)
        for command in COMMANDS
        if (shown := key_names(keys.get(command.id) or command.keys))
    ]
    for heading, bindings in of_panes.items():
        rows += [Entry(heading, *own) for own in keys_of(bindings)]
    return rows


def keys_of(bindings: Sequence[BindingType]) -> list[tuple[str, str, str]]:
    """Return what a pane's own keys do: the action of the table or an empty text, keys, title."""
    shown = []
    for binding in bindings:
        if not isinstance(binding, Binding):
            continue
        is_of_table = binding.action.startswith(_DO)
        command_id = binding.action[len(_DO) : -2] if is_of_table else ""
        title = binding.description or (BY_ID[command_id].title if command_id else "")
        if title:
            shown.append((command_id, key_names(binding.key), title[0].upper() + title[1:]))
    return shown


_DO = "app.do('"


def found(rows: Sequence[Entry], query: str) -> list[Entry]:
    """Return what a query finds: a key by its name, an action by words of title, description, synonyms."""
    wanted = query.casefold().replace(" ", "")
    return [
        row
        for row in rows
        if not wanted
        or any(wanted in key.casefold() for key in row.keys.replace(",", " ").split())
        or all(word in f"{row.part} {row.title}".casefold() for word in query.casefold().split())
        or (row.command_id and is_described(BY_ID[row.command_id], query))
    ]


def likeliest(rows: Sequence[Entry], query: str) -> int:
    """Return the place of what the query names by title or word, of which others only speak; else 0."""
    named = query.strip().casefold()

    def names(row: Entry) -> set[str]:
        return {row.title.casefold(), *(BY_ID[row.command_id].words if row.command_id else ())}

    return next((place for place, row in enumerate(rows) if named in names(row)), 0)


class KeySheet(Question[str]):
    """Dismissed with the id of the action to carry out, or an empty text."""

    DEFAULT_CSS = """
    KeySheet { background: $background; }
    KeySheet > Vertical { width: 100%; height: 100%; background: $surface; border: round $primary;
                          border-title-color: $accent; border-subtitle-color: $foreground; }
    KeySheet Input { height: 1; border: none; padding: 0 1; background: $panel; }
    KeySheet Input:focus { border: none; }
    KeySheet VerticalScroll { padding: 0 1; scrollbar-size-vertical: 1; }
    KeySheet #keys-about { height: 1; padding: 0 1; background: $panel; text-overflow: ellipsis;
                           text-wrap: nowrap; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,f1,shift+f1", "dismiss('')", "Close"),
        Binding("down", "move(1)", show=False),
        Binding("up", "move(-1)", show=False),
        Binding("pagedown", "page(1)", show=False),
        Binding("pageup", "page(-1)", show=False),
    ]

    def __init__(self, rows: list[Entry]) -> None:
        super().__init__()
        self._rows, self._found = rows, rows
        self._at: int | None = None

    def compose(self) -> ComposeResult:
        """Put a field above the sheet, a sentence about the action marked below it."""
        box = Vertical()
        box.border_title = "Keys"
        box.border_subtitle = "Enter carries out · Esc closes"
        with box:
            yield Input(placeholder="search: a key, or what you want to do")
            with VerticalScroll(can_focus=False):
                yield Static(id="keys-sheet", markup=False)
            yield Static(id="keys-about", markup=False)

    def on_mount(self) -> None:
        """Show all."""
        self._show()

    def on_resize(self) -> None:
        """Follow the screen's width."""
        self._show()

    @on(Input.Changed)
    def _search(self, event: Input.Changed) -> None:
        event.stop()
        self._found = found(self._rows, event.value)
        self._at = likeliest(self._found, event.value) if event.value.strip() and self._found else None
        self._show()

    @on(Input.Submitted)
    def _carry_out(self, event: Input.Submitted) -> None:
        event.stop()
        if self._at is not None:
            self.dismiss(self._found[self._at].command_id)

    def action_move(self, step: int) -> None:
        """Mark the action below or above."""
        if self._found:
            before = -1 if self._at is None else self._at
            self._at = min(max(before + step, 0), len(self._found) - 1)
            self._show()

    def action_page(self, step: int) -> None:
        """Scroll by a page."""
        sheet = self.query_one(VerticalScroll)
        sheet.scroll_relative(y=step * max(sheet.size.height - 1, 1), animate=False)

    # -------------------------------------------------------------------------------------------- the sheet

    def _show(self) -> None:
        scroll = self.query_one(VerticalScroll)
        width = max(scroll.size.width - 2, 20)
        columns = max(width // COLUMN_CELLS, 1)
        pieces = self._pieces(width // columns - 1)
        high = -(-len(pieces) // columns)
        if columns > 1:
            high = max(high, 1)
        text = Text("\n", no_wrap=True).join(
            Text(" ").join(
                pieces[row + high * column][0]
                for column in range(columns)
                if row + high * column < len(pieces)
            )
            for row in range(high)
        )
        self.query_one("#keys-sheet", Static).update(text if pieces else "Nothing found. Esc closes.")
        about = BY_ID.get(self._found[self._at].command_id) if self._at is not None else None
        words = f"  ·  {' '.join(about.words)}" if about is not None and about.words else ""
        self.query_one("#keys-about", Static).update(f"{about.help}{words}" if about is not None else "")
        at = next((n for n, (_, number) in enumerate(pieces) if number is not None and number == self._at), 0)
        row = at % max(high, 1)
        if not scroll.scroll_offset.y <= row < scroll.scroll_offset.y + scroll.size.height:
            scroll.scroll_to(y=row - scroll.size.height // 2, animate=False)

    def _pieces(self, cells: int) -> list[tuple[Text, int | None]]:
        """Return the lines of the sheet, each with its number in what was found; headings have none."""
        theme = self.app.current_theme
        pieces: list[tuple[Text, int | None]] = []
        part = ""
        for number, entry in enumerate(self._found):
            if entry.part != part:
                part = entry.part
                if pieces:
                    pieces.append((Text(" " * cells), None))
                heading = HEADINGS.get(part, part.capitalize())
                pieces.append((Text(heading[:cells].ljust(cells), f"bold {theme.accent}"), None))
            line = Text(entry.keys[: KEY_CELLS - 1].ljust(KEY_CELLS), f"bold {theme.primary}")
            line.append(
                entry.title[: cells - KEY_CELLS].ljust(cells - KEY_CELLS), f"not bold {theme.foreground}"
            )
            if number == self._at:
                line.stylize(f"not bold {theme.background} on {theme.primary}")
            pieces.append((line, number))
        return pieces
