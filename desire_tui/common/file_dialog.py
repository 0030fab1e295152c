"""textual-fspicker's dialog, name first: the cursor stands in the name, the list follows what is typed."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from rich.style import Style
from rich.text import Text
from textual.await_complete import AwaitComplete
from textual.binding import Binding, BindingType
from textual.widgets import Input
from textual_fspicker.base_dialog import Dialog
from textual_fspicker.file_dialog import BaseFileDialog
from textual_fspicker.icons import Icons
from textual_fspicker.parts import CurrentDirectory, DirectoryNavigation
from textual_fspicker.parts.directory_navigation import DirectoryEntry, DirectoryEntryStyling
from textual_fspicker.path_filters import Filter
from textual_fspicker.safe_tests import is_dir

from desire_tui.common.paths import can_name_a_file, exists, full
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from typing import Self

    from textual.app import ComposeResult
    from textual.widgets import OptionList

HINT = "part of a name · ↑↓ choose · Tab completes · / ~/ ../ folder"
MOVES = {"down": "cursor_down", "up": "cursor_up", "pagedown": "page_down", "pageup": "page_up"}
RECENT_MOST = 5


_FOLDER, _FILE = Text("▸"), Text(" ")


def _sign(path: str | Path) -> Text:
    return _FOLDER if is_dir(Path(path)) else _FILE


Icons.set_picker(_sign)  # emoji are coloured pictures of other widths, or boxes, in many terminals
DirectoryEntry.LINK_ICON = Text("→")  # type: ignore[misc]  # the library's own would be one, too


class FileList(DirectoryNavigation):
    """Files opened last, then the folder's entries: those whose names have a part that was typed."""

    def __init__(self, folder: Path, suffix: str, recent: Sequence[Path]) -> None:
        self.paths: list[Path] = []
        self._first_folder, self._suffix, self._recent, self._part = folder, suffix, recent, ""
        super().__init__(folder)
        self.can_focus = False  # the cursor stays in the name

    def narrow(self, part: str) -> None:
        """List names with `part` in them: of none folders and programs, of a dot hidden ones, too."""
        self._part = part.casefold()
        self.show_hidden = part.startswith(".")
        self.file_filter = Filter(part, lambda path: bool(part) or path.suffix.casefold() == self._suffix)

    def hide(self, path: Path) -> bool:
        """Narrow folders, too; entries of the folder just left are no choice any more."""
        return self._part not in path.name.casefold() or path.parent != self.location or super().hide(path)

    def add_options(self, new_options: Iterable[object]) -> Self:
        """Begin with recent files, keep each name in its line, highlight the best match."""
        recent = self._recent if self.is_mounted and self.location == self._first_folder else ()
        recent = [path for path in recent if self._part in path.name.casefold()][:RECENT_MOST]
        plain = DirectoryEntryStyling(*[Style.null()] * 4)
        first = [] if self.option_count else [DirectoryEntry(path, plain) for path in recent]
        new = [new for new in new_options if isinstance(new, DirectoryEntry) and new.location not in recent]
        super().add_options([*first, *new])
        self.paths = [entry.location for entry in self.options if isinstance(entry, DirectoryEntry)]
        for at, path in enumerate(self.paths):
            label = f"{path.name} · recent, {path.parent}" if path in recent else path.name
            if visible_line(label) != path.name:
                self.replace_option_prompt_at_index(at, Text(f"    {visible_line(label)}"))

        def unlikely(at: int) -> tuple[bool, bool, bool]:
            name = self.paths[at].name
            return name == "..", not name.casefold().startswith(self._part), is_dir(self.paths[at])

        # the library highlights an entry when it saves, too, though Enter then takes it after an arrow only
        self.highlighted = min(range(self.option_count), key=unlikely, default=None)
        return self

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        """Leave folders to the dialog, too."""
        event.stop()
        event.prevent_default()
        self.post_message(self.Selected(self, self.paths[event.option_index]))


class FileDialog(BaseFileDialog):
    """Dismissed with a path, Esc: None. With a name it asks where to save; the stem is selected."""

    DEFAULT_CSS = """
    FileDialog Dialog { width: 90%; height: 90%; max-width: 90; border: round $primary; padding: 0 1; }
    FileDialog CurrentDirectory { border: none; padding: 0; color: $text-muted; }
    FileDialog DirectoryNavigation, FileDialog DirectoryNavigation:focus { border: none; padding: 0; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("tab", "complete", show=False, priority=True),
        *(Binding(key, f"move('{move}')", show=False, priority=True) for key, move in MOVES.items()),
    ]

    def __init__(self, folder: Path, suffix: str, *, name: str = "", recent: Sequence[Path] = ()) -> None:
        super().__init__(title="Save as" if name else "Open")
        self._saves, self._suffix, self._moved = bool(name), suffix, False
        there = next(path for path in (full(folder), *full(folder).parents) if is_dir(path))
        self._list = FileList(there, suffix, recent)
        self._field = Input(name, HINT, compact=True, select_on_focus=False)

    def compose(self) -> ComposeResult:
        """Put the name above the list."""
        with Dialog() as dialog:
            dialog.border_title = self._title
            yield CurrentDirectory(markup=False)
            yield self._field
            yield self._list

    def on_mount(self) -> None:
        """Begin in the field."""
        stem = len(self._field.value.removesuffix(self._suffix))
        self._field.selection = type(self._field.selection)(0, stem)
        self._list.narrow("")

    def dismiss(self, result: Path | None = None) -> AwaitComplete:
        """Answer once; what has no ending gets that of programs."""
        if result is not None and not result.suffix and not exists(result):
            result = result.with_name(result.name + self._suffix)
        return super().dismiss(result) if self.is_current else AwaitComplete()

    def on_input_changed(self, event: Input.Changed) -> None:
        """Narrow the list; a folder is gone into at its slash."""
        self._moved = False
        head, slash, name = event.value.rpartition("/")
        with suppress(OSError, ValueError):  # a name too long, or one that no file can have
            if slash and is_dir(folder := full(Path(head + slash), self._list.location)):
                cursor = self._field.cursor_position - len(head + slash)
                self._list.location, self._field.value, self._field.cursor_position = folder, name, cursor
        self._list.narrow("" if self._saves else name)

    async def action_move(self, move: str) -> None:
        """Choose in the list, which then counts more than what was typed."""
        await self._list.run_action(move)
        self._moved = True

    def action_complete(self) -> None:
        """Complete what was typed."""
        if self._list.highlighted is not None:
            self._take(self._list.paths[self._list.highlighted])

    def _take(self, path: Path) -> None:
        """Go into a folder, or put a file's name into the field."""
        self._moved = False
        if not is_dir(path):
            self._field.value = path.name
        else:
            self._list.location = full(path)
            self._field.value = self._field.value if self._saves else ""
        self._field.action_end()

    def on_directory_navigation_selected(self, event: DirectoryNavigation.Selected) -> None:
        """Open the file; to save, take over its name."""
        event.prevent_default()
        self._take(event.path) if self._saves or is_dir(event.path) else self.dismiss(event.path)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Take the list's entry if the arrows chose it, or what was typed to open is no file."""
        if not can_name_a_file(event.value):
            self._set_error("No file can be called so")
            event.prevent_default()
            return
        try:
            is_there = bool(event.value) and (self._list.location / event.value).exists()
        except OSError as error:  # a name too long
            self._set_error(error.strerror or "")
            event.prevent_default()
            return
        if self._moved or not (self._saves or is_there):
            event.prevent_default()
            at = self._list.highlighted
            if at is not None and (self._moved or self._list.paths[at].name != ".."):
                self._list.action_select()
            else:
                self._set_error("No such file here")
