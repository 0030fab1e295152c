"""Which file to open, or to save as: a name typed, with a list that follows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from rich.text import Text
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.widgets import Input, Label, OptionList
from textual.widgets.option_list import Option

from desire_tui.common.dialogs import Question
from desire_tui.common.file_listing import UP, Entry, listed, short, split_typed
from desire_tui.common.paths import exists, full
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from textual.app import ComposeResult

HINTS = {
    "open": "type a part of a name · ↑↓ choose · Tab completes · / and ~ change the folder",
    "save": "Enter saves · ↑↓ take a name · Tab completes · / and ~ change the folder",
}


class FileDialog(Question["Path | None"]):
    """Dismissed with a path, Esc: None. To save, the cursor stands in the name, its stem selected."""

    DEFAULT_CSS = """
    FileDialog { align: center middle; background: $background 60%; }
    FileDialog > Vertical { width: 76; max-width: 96%; height: 90%; max-height: 30; padding: 0 1;
            background: $panel; border: round $primary; border-title-color: $accent;
            border-subtitle-color: $text-error; }
    FileDialog Label { width: 1fr; height: 1; color: $text-muted; text-overflow: ellipsis;
            text-wrap: nowrap; }
    FileDialog Input { border: none; height: 1; padding: 0 1; background: $surface; }
    FileDialog Input:focus { border: none; }
    FileDialog OptionList { border: none; padding: 0; height: 1fr; background: $panel; text-wrap: nowrap;
            text-overflow: ellipsis; overflow-x: hidden; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "dismiss(None)", "Cancel"),
        Binding("down", "move(1)", show=False, priority=True),
        Binding("up", "move(-1)", show=False, priority=True),
        Binding("pagedown", "move(10)", show=False, priority=True),
        Binding("pageup", "move(-10)", show=False, priority=True),
        Binding("tab", "complete", show=False, priority=True),
    ]

    def __init__(
        self,
        purpose: Literal["open", "save"],
        folder: Path,
        *,
        name: str = "",
        recent: Sequence[Path] = (),
        suffix: str,
    ) -> None:
        super().__init__()
        self._purpose = purpose
        self._folder = self._first_folder = full(folder)
        self._proposed = name
        self._recent = recent
        self._suffix = suffix
        self._entries: list[Entry] = []
        self._put = name
        """What the dialog itself put into the field."""
        self._moved = False
        """Whether the arrows chose the entry, which then counts more than what was typed."""

    def compose(self) -> ComposeResult:
        """Folder, name, list, keys."""
        box = Vertical()
        box.border_title = "Open" if self._purpose == "open" else "Save as"
        with box:
            yield Label("", id="folder", markup=False)
            yield Input(self._proposed, placeholder="name", id="file-name", select_on_focus=False)
            yield OptionList()
            yield Label(HINTS[self._purpose], markup=False)

    def on_mount(self) -> None:
        """Begin in the field."""
        self.query_one(OptionList).can_focus = False
        field = self._field
        self.set_focus(field)
        stem = len(self._proposed.removesuffix(self._suffix))
        field.selection = type(field.selection)(0, stem)
        self._list()

    @property
    def _field(self) -> Input:
        return self.query_one("#file-name", Input)

    @property
    def _chosen(self) -> Entry | None:
        at = self.query_one(OptionList).highlighted
        return self._entries[at] if at is not None and at < len(self._entries) else None

    def _list(self) -> None:
        typed = self._field.value
        if self._purpose == "save":  # what is there already; a whole name typed hides nothing
            typed = typed[: typed.rfind("/") + 1]
        base, _ = split_typed(self._folder, typed)
        self.query_one("#folder", Label).update(visible_line(short(base)))
        recent = self._recent if self._folder == self._first_folder else ()
        self._entries = listed(self._folder, typed, recent, (self._suffix,))
        options = self.query_one(OptionList)
        options.clear_options()
        options.add_options([Option(self._drawn(entry)) for entry in self._entries])
        if self._purpose == "open":  # Enter opens the first file, it never goes up by itself
            wanted = (n for n, entry in enumerate(self._entries) if entry.label != f"{UP}/")
            options.highlighted = next(wanted, 0 if self._entries else None)

    def _drawn(self, entry: Entry) -> Text:
        theme = self.app.current_theme
        label = visible_line(entry.label)
        if entry.is_folder:
            return Text(label, style=str(theme.primary))
        return Text(f"{label}  · recent", style=str(theme.accent)) if entry.is_recent else Text(label)

    def on_input_changed(self, event: Input.Changed) -> None:
        """Follow what is typed."""
        event.stop()
        if event.value != self._put:
            self._put = event.value
            self._moved = False
            self.query_one(Vertical).border_subtitle = ""
            self._list()

    def action_move(self, by: int) -> None:
        """Choose another entry; to save, its name is taken over."""
        options, count = self.query_one(OptionList), len(self._entries)
        if not count:
            return
        self._moved = True
        at = options.highlighted
        options.highlighted = (0 if by > 0 else count - 1) if at is None else min(max(at + by, 0), count - 1)
        chosen = self._chosen
        if self._purpose == "save" and chosen is not None and not chosen.is_folder:
            self._fill(self._typed_folder + chosen.path.name)

    def action_complete(self) -> None:
        """Put the chosen entry into the field."""
        if (chosen := self._chosen) is not None:
            self._enter(chosen) if chosen.is_folder else self._fill(self._typed_folder + chosen.path.name)

    @property
    def _typed_folder(self) -> str:
        value = self._field.value
        return value[: value.rfind("/") + 1]

    def _fill(self, text: str) -> None:
        self._put = text
        self._field.value = text
        self._field.cursor_position = len(text)

    def _enter(self, entry: Entry) -> None:
        """Go into a folder; the name to save stays."""
        name = self._field.value[len(self._typed_folder) :] if self._purpose == "save" else ""
        self._folder = full(entry.path)
        self._fill(name)
        self._list()

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        """Take the entry clicked."""
        event.stop()
        entry = self._entries[event.option_index]
        if entry.is_folder:
            self._enter(entry)
        elif self._purpose == "open":
            self.dismiss(entry.path)
        else:
            self._fill(self._typed_folder + entry.path.name)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Open or save; a folder is gone into."""
        event.stop()
        chosen, typed = self._chosen, event.value.strip()
        base, name = split_typed(self._folder, typed)
        path = full(base / name)
        if chosen is not None and (self._moved or not (typed and exists(path))):
            if chosen.is_folder:
                self._enter(chosen)
                return
            if self._purpose == "open":
                self.dismiss(chosen.path)
                return
        if not typed:
            self._wrong("A name, please.")
            return
        if path.is_dir():
            self._folder = path
            self._fill("")
            self._list()
        elif self._purpose == "save":
            named = path if path.suffix or exists(path) else path.with_name(path.name + self._suffix)
            self.dismiss(named)
        elif exists(path):
            self.dismiss(path)
        else:
            self._wrong(f"No file {visible_line(typed)} here.")

    def _wrong(self, sentence: str) -> None:
        self.query_one(Vertical).border_subtitle = sentence
