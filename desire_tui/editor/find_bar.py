"""The find bar below the text: what is searched for, how, and what it is replaced by."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import Input, Label

from desire_tui.editor.find_and_replace import Finder
from desire_tui.editor.text_search import HITS_MAX, Unsearchable

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual import events
    from textual.timer import Timer

    from desire_tui.editor.code_area import CodeArea

SWITCHES = {
    "case": ("Aa", "Match case · Alt+C"),
    "word": ("W", "Whole words · Alt+W"),
    "regex": (".*", "Regular expression · Alt+X"),
    "within": ("≡", "In the lines selected · Alt+M"),
}
"""Ways of searching: what is shown for each."""
COUNT_AFTER_S = 0.15
"""Occurrences are counted again when nobody changed the text for so long."""


class FindBar(Vertical):
    """Searches a text as it is typed."""

    DEFAULT_CSS = """
    FindBar { height: auto; display: none; background: $panel; }
    FindBar Horizontal { height: 1; }
    FindBar Input { border: none; height: 1; width: 1fr; padding: 0 1; background: $surface; }
    FindBar Input:focus { border: none; background: $boost; }
    FindBar Label { width: auto; padding: 0 1; color: $text-muted; }
    FindBar .switch:hover, FindBar .button:hover { background: $primary; color: $background; }
    FindBar .switch.-on { background: $primary; color: $background; text-style: bold; }
    FindBar .button { color: $foreground; }
    FindBar #replacing, FindBar #wrong { display: none; }
    FindBar.-replace #replacing { display: block; }
    FindBar.-wrong #wrong { display: block; width: 1fr; color: $text-error; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "close", "Close", show=False),
        Binding("down", "step(1)", "Next", show=False),
        Binding("up", "step(-1)", "Previous", show=False),
    ]

    class Closed(Message):
        """The user is done searching."""

    def __init__(self) -> None:
        super().__init__()
        self.finder = Finder()
        self._timer: Timer | None = None
        self._counted = ""
        """The text whose occurrences are counted."""

    def _compose_once(self) -> None:
        """Mount the rows when they are first needed: a fifth of the desktop's widgets; few sessions search.

        Two rows, each a field and what can be clicked; a third if something is wrong.
        """
        if self.children:
            return
        searching, replacing = Horizontal(), Horizontal(id="replacing")
        self.mount(searching, replacing, Label("", id="wrong", markup=False))
        searching.mount(
            Input(placeholder="find", id="wanted", select_on_focus=True),
            *(
                Label(sign, id=f"find-{name}", classes="switch", markup=False).with_tooltip(tip)
                for name, (sign, tip) in SWITCHES.items()
            ),
            Label("", id="found", markup=False),
        )
        replacing.mount(
            Input(placeholder="replace by", id="replacement", select_on_focus=True),
            Label("Enter one", id="replace-one", classes="button", markup=False),
            Label("Alt+A all", id="replace-all", classes="button", markup=False),
        )

    # ------------------------------------------------------------------------------------ opening and closing

    def open(self, area: CodeArea, wanted: str = "", *, replace: bool = False) -> None:
        """Show the bar for a text; several lines that are selected are where it searches."""
        self._compose_once()
        finder = self.finder
        finder.look_at(area)
        if area.selection.start[0] != area.selection.end[0]:
            finder.limit_to_selection()
        elif not self.display:
            finder.limit_to_nothing()
        self.display = True
        self.set_class(replace, "-replace")
        field = self.query_one("#wanted", Input)
        if wanted:
            field.value = wanted
        self.screen.set_focus(field)  # at once: the letters typed next are for it
        self._show()

    def follow(self, area: CodeArea) -> None:
        """Search another text from now on: another tab came to the front."""
        if self.finder.area is not area:
            self.finder.look_at(area)
            if self.display:
                self._show()

    def text_changed(self) -> None:
        """Count anew, once nobody types."""
        area = self.finder.area
        if not self.display or area is None or area.text is self._counted:  # changed by the bar itself
            return
        if self._timer is not None:
            self._timer.stop()
        self._timer = self.set_timer(COUNT_AFTER_S, self._show)

    def action_close(self) -> None:
        """Hide the bar."""
        finder = self.finder
        if finder.area is not None:
            self.screen.set_focus(finder.area)  # at once: letters typed next belong there
        finder.limit_to_nothing()
        finder.show_hits(())
        self.display = False
        self.post_message(self.Closed())

    # --------------------------------------------------------------------------------------------- searching

    def switch(self, name: str) -> None:
        """Turn a way of searching (a key of SWITCHES) on or off."""
        if not self.finder.switch(name):
            self.notify("Select some lines first: then only these are searched.", timeout=3)
        self._from_here()

    def action_step(self, step: int) -> None:
        """Select the next (1) or the previous (-1) occurrence, going round at the end."""
        self._go(lambda: self.finder.step(step))

    def _from_here(self) -> None:
        self._go(self.finder.first)

    def _go(self, move: Callable[[], int | None]) -> None:
        try:
            number = move()
        except Unsearchable as why:
            self._show(wrong=str(why))
            return
        self._show(number)

    def _show(self, number: int | None = None, *, told: str = "", wrong: str = "") -> None:
        """Show the switches, and how much was found or why nothing can be."""
        self._compose_once()  # the next occurrence may be asked for before the bar was ever seen
        finder = self.finder
        for name in SWITCHES:
            self.query_one(f"#find-{name}").set_class(finder.is_on(name), "-on")
        try:
            hits = finder.hits()
        except Unsearchable as why:
            hits, wrong = [], str(why)
        finder.show_hits(hits if self.display else ())
        self._counted = finder.area.text if finder.area is not None else ""
        count = f"{len(hits)}+" if len(hits) == HITS_MAX else str(len(hits))
        if number is not None:
            told = f"{number + 1} of {count}"
        elif not told and finder.wanted.text and not wrong:
            told = f"{count} found" if hits else "not found"
        self.query_one("#found", Label).update(" ".join(filter(None, (told, finder.place))))
        self.query_one("#wrong", Label).update(wrong)
        self.set_class(bool(wrong), "-wrong")

    def on_input_changed(self, event: Input.Changed) -> None:
        """Go to the first occurrence from the cursor on."""
        event.stop()
        if event.input.id == "wanted":
            self.finder.search_for(event.value)
            self._from_here()

    # --------------------------------------------------------------------------------------------- replacing

    @property
    def _by(self) -> str:
        return self.query_one("#replacement", Input).value

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Enter: next occurrence; in the second field, replace this one first."""
        event.stop()
        if event.input.id == "replacement":
            self._replace_one()
        else:
            self.action_step(1)

    def _replace_one(self) -> None:
        def replace() -> int | None:
            self.finder.replace_one(self._by)
            return self.finder.step(1)

        self._go(replace)

    def replace_all(self) -> None:
        """Replace every occurrence, as one undoable change."""
        if not self.has_class("-replace"):
            return
        try:
            places = self.finder.replace_all(self._by)
        except Unsearchable as why:
            self._show(wrong=str(why))
            return
        self._show(told=f"{places} replaced" if places else "")

    def on_click(self, event: events.Click) -> None:
        """Turn a switch, press a button."""
        name = (event.widget.id or "") if event.widget is not None else ""
        if name.startswith("find-"):
            self.switch(name.removeprefix("find-"))
        elif name == "replace-one":
            self._replace_one()
        elif name == "replace-all":
            self.replace_all()
