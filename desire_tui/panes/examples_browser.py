"""The examples browser: programs by chapter, a search, and what each draws, says and is."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, NamedTuple

from rich.text import Text
from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import Input, OptionList, Static
from textual.widgets.option_list import Option

from desire_tui.common.dialogs import Question
from desire_tui.common.paths import examples_folder
from desire_tui.panes.example_catalogue import Example, examples, search
from desire_tui.panes.example_preview import Preview, Previewer
from desire_tui.panes.thumbnail import Thumbnail

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.timer import Timer

REST_S = 0.06
"""A program is run for its picture when the list stands still for so long."""
NAME_COLUMNS, WIDE, LOW_BELOW, TINY_BELOW = 30, 110, 32, 18
_previews: dict[str, Preview] = {}
"""Pictures made since the start, by the program's text."""
PREVIEWS_MAX = 64


class ExampleChoice(NamedTuple):
    """The program to open, and whether to run it at once."""

    example: Example
    run: bool


class ExamplesScreen(Question["ExampleChoice | None"]):
    """Dismissed with the program chosen, or None."""

    DEFAULT_CSS = """
    ExamplesScreen { align: center middle; background: $background 60%; }
    ExamplesScreen > Vertical { width: 96%; height: 94%; background: $surface; border: round $primary;
                                border-title-color: $accent; border-subtitle-color: $text-muted; }
    ExamplesScreen Input { height: 1; border: none; padding: 0 1; background: $panel; }
    ExamplesScreen Input:focus { border: none; }
    ExamplesScreen OptionList { width: 2fr; border: none; padding: 0; background: $surface; height: 1fr;
                                text-wrap: nowrap; text-overflow: ellipsis; overflow-x: hidden; }
    ExamplesScreen #preview { width: 3fr; border-left: solid $panel; height: 1fr; }
    ExamplesScreen #about { height: auto; max-height: 7; padding: 0 1; }
    ExamplesScreen #program { height: 2fr; padding: 0 1; border-top: solid $panel;
                              text-wrap: nowrap; text-overflow: ellipsis; }
    ExamplesScreen.-low #program { display: none; }
    ExamplesScreen.-tiny Thumbnail { display: none; }
    ExamplesScreen.-tiny #about { max-height: 100%; }
    ExamplesScreen Thumbnail { height: 3fr; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "dismiss(None)", "Close"),
        Binding("f5", "run", show=False, priority=True),
        Binding("down", "move(1)", show=False),
        Binding("up", "move(-1)", show=False),
        Binding("pagedown", "move(10)", show=False),
        Binding("pageup", "move(-10)", show=False),
    ]

    class Previewed(Message):
        """A program's picture is there."""

        def __init__(self, preview: Preview) -> None:
            super().__init__()
            self.preview = preview

    def __init__(self) -> None:
        super().__init__()
        self._examples = examples()
        self._listed: dict[str, Example] = {}
        self._shown: Example | None = None
        self._timer: Timer | None = None
        self._previewer = Previewer(lambda preview: self.post_message(self.Previewed(preview)))

    def compose(self) -> ComposeResult:
        """Search field, list, preview."""
        box = Vertical()
        box.border_title = "Examples"
        box.border_subtitle = "Enter opens a copy · F5 opens and runs · Esc"
        with box:
            yield Input(placeholder="type words to search · ↑↓ choose", id="examples-filter")
            with Horizontal():
                yield OptionList()
                with Vertical(id="preview"):
                    yield Static(id="about", markup=False)
                    yield Thumbnail()
                    yield Static(id="program", markup=False)

    def on_mount(self) -> None:
        """Show all."""
        self._list("")
        self.query_one(OptionList).can_focus = False

    def on_resize(self) -> None:
        """Where there is little room, the picture gets it all; where there is hardly any, the description."""
        self.set_class(self.app.size.height < LOW_BELOW, "-low")
        self.set_class(self.app.size.height < TINY_BELOW, "-tiny")

    def on_unmount(self) -> None:
        """Let the previewer's thread end."""
        self._previewer.close()

    # ------------------------------------------------------------------------------------------------- list

    def _list(self, wanted: str) -> None:
        options = self.query_one(OptionList)
        options.clear_options()
        found = search(wanted, self._examples)
        self._listed = {example.path.as_posix(): example for example in found}
        chapter = ""
        for example in found:
            if not wanted.strip() and example.chapter != chapter:  # hits stand in the order of their rank
                chapter = example.chapter
                head = Text.assemble((chapter, "bold"), "  ", (example.subject, "dim italic"), no_wrap=True)
                options.add_option(Option(head, disabled=True))
            name = f"{example.folder}/{example.name}" if wanted.strip() else f" {example.name}"
            line = Text(name, no_wrap=True)
            if self.app.size.width >= WIDE:
                line.append(" " * max(NAME_COLUMNS - len(name), 1))
                line.append(example.about)
            options.add_option(Option(line, example.path.as_posix()))
        if not found:
            none = "No such example." if self._examples else f"No examples in {examples_folder()}"
            options.add_option(Option(Text(none), disabled=True))
            self._show(None)
            return
        options.action_first()
        options.scroll_home(animate=False)

    @on(Input.Changed)
    def _filter(self, event: Input.Changed) -> None:
        self._list(event.value)

    def action_move(self, step: int) -> None:
        """Move through the list while the search keeps the focus."""
        options = self.query_one(OptionList)
        at = options.highlighted
        if not self._listed or at is None:
            return
        chosen, to = at, at
        while 0 <= to + (1 if step > 0 else -1) < options.option_count and step:
            to += 1 if step > 0 else -1
            if not options.get_option_at_index(to).disabled:
                chosen, step = to, step - (1 if step > 0 else -1)
        options.highlighted = chosen
        if chosen == 1:
            options.scroll_home(animate=False)  # the first chapter's heading

    # ---------------------------------------------------------------------------------------------- preview

    @property
    def highlighted(self) -> Example | None:
        """The program under the bar."""
        options = self.query_one(OptionList)
        at = options.highlighted
        return None if at is None else self._listed.get(options.get_option_at_index(at).id or "")

    @on(OptionList.OptionHighlighted)
    def _moved(self) -> None:
        self._show(self.highlighted)

    def _show(self, example: Example | None) -> None:
        if example is self._shown and example is not None:
            return
        self._shown = example
        if self._timer is not None:
            self._timer.stop()
        about = Text()
        if example is not None:
            about = Text.assemble((example.name.replace("_", " "), "bold"), f"  {example.chapter}\n")
            about.append(example.about)
        self.query_one("#about", Static).update(about)
        program = self.query_one("#program", Static)
        program.update(example.body if example is not None else "")
        if example is None:
            self.query_one(Thumbnail).show(None)
        elif (known := _previews.get(example.text)) is not None:
            self._put(known)
        else:
            self.query_one(Thumbnail).show(None, "drawing …")
            self._timer = self.set_timer(REST_S, lambda: self._previewer.ask(example))

    @on(Previewed)
    def _previewed(self, event: Previewed) -> None:
        preview = event.preview
        if len(_previews) >= PREVIEWS_MAX:
            del _previews[next(iter(_previews))]
        _previews[preview.example.text] = preview
        if self._shown is not None and preview.example.text == self._shown.text:
            self._put(preview)

    def _put(self, preview: Preview) -> None:
        thumbnail = self.query_one(Thumbnail)
        if preview.graph is not None and not preview.graph.is_empty:
            thumbnail.show(preview.graph)
        else:
            thumbnail.show_text(preview.printed or preview.problem or "draws and prints nothing")

    # --------------------------------------------------------------------------------------------- the end

    @on(OptionList.OptionSelected)
    def _clicked(self) -> None:
        self._choose(run=False)

    @on(Input.Submitted)
    def _open(self) -> None:
        self._choose(run=False)

    def action_run(self) -> None:
        """Open the program and run it."""
        self._choose(run=True)

    def _choose(self, *, run: bool) -> None:
        if (example := self.highlighted) is not None:
            self.dismiss(ExampleChoice(example, run))
