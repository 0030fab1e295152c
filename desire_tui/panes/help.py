"""Help: a page, a search over all pages, and the list of keys."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.text import Text
from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical, VerticalScroll
from textual.widgets import Input, OptionList
from textual.widgets.option_list import Option

from desire_tui.commands import COMMANDS
from desire_tui.panes.keynames import key_names

if TYPE_CHECKING:
    from collections.abc import Mapping

    from textual.app import ComposeResult

HITS_MAX = 200
WELCOME = """\
Type above to search all pages; Enter opens the first.

**F5** runs the program in front, **Ctrl+C** pauses, **F1** on a word explains it, **Ctrl+P** lists every
action. `help 'dispt'` on the command line opens a page too.
"""


class HelpPane(Vertical):
    """One page at a time; Esc goes back to where the keys were."""

    DEFAULT_CSS = """
    HelpPane { background: $surface; }
    HelpPane Input { height: 1; border: none; padding: 0 1; background: $panel; }
    HelpPane Input:focus { border: none; background: $boost; }
    HelpPane OptionList { display: none; height: 1fr; border: none; padding: 0; background: $surface; }
    HelpPane VerticalScroll { height: 1fr; padding: 0 1; scrollbar-size-vertical: 1; }
    HelpPane Markdown { padding: 0; margin: 0; background: $surface; }
    HelpPane MarkdownH1 { content-align: left middle; margin: 0; padding: 0; text-style: bold;
            color: $primary; }
    HelpPane MarkdownParagraph { margin: 0 0 1 0; }
    HelpPane MarkdownFence { margin: 0 0 1 0; max-height: 40; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Back", show=False),
        Binding("slash", "search", "Search", show=False),
    ]

    def __init__(self) -> None:
        super().__init__(id="help")
        self.keys: Mapping[str, str] = {}
        """Command id → keys as configured."""

    def compose(self) -> ComposeResult:
        """Search field, hits, page."""
        yield Input(placeholder="search help", id="help-search")
        yield OptionList()
        yield VerticalScroll()

    def show_topic(self, word: str) -> None:
        """Show a page; without one, the search for the word."""
        from desire_tui import help as pages

        field = self.query_one("#help-search", Input)
        page = pages.find(word) if word else None
        if word == "keys":
            self._show_page(self.keys_page())
        elif page is not None:
            self._show_page(page.markdown)
        elif word:
            field.value = word
        else:
            with field.prevent(Input.Changed):
                field.value = ""
            self._show_page(WELCOME)
        if not word or (page is None and word != "keys"):
            field.focus()
        else:
            self.query_one(VerticalScroll).focus()

    def keys_page(self) -> str:
        """Return the list of all actions with keys and words."""
        rows = []
        for command in COMMANDS:
            keys = key_names(self.keys.get(command.id, command.keys))
            words = ", ".join(f"`{word}`" for word in command.words)
            rows.append(f"| {keys} | {command.title} | {words} |")
        return "# Keys\n\n| key | action | command |\n| --- | --- | --- |\n" + "\n".join(rows) + "\n"

    def _show_page(self, text: str) -> None:
        self.query_one(OptionList).display = False
        scroll = self.query_one(VerticalScroll)
        scroll.display = True
        text = text.replace("```desire", "```")
        from textual.widgets import Markdown  # brings a Markdown parser: not before somebody wants help

        if page := self.query(Markdown):
            page.first().update(text)
        else:
            scroll.mount(Markdown(text, open_links=False))
        scroll.scroll_home(animate=False)

    @on(Input.Changed, "#help-search")
    def _search(self, event: Input.Changed) -> None:
        from desire_tui import help as pages

        event.stop()
        hits = self.query_one(OptionList)
        if not event.value.strip():
            hits.display = False
            self.query_one(VerticalScroll).display = True
            return
        hits.clear_options()
        for page in pages.search(event.value)[:HITS_MAX]:
            hits.add_option(
                Option(
                    Text.assemble((f"{page.name:<16} ", "bold"), (page.summary, "dim"), no_wrap=True),
                    page.name,
                )
            )
        if not hits.option_count:
            hits.add_option(Option("Nothing found.", disabled=True))
        hits.display = True
        self.query_one(VerticalScroll).display = False

    @on(Input.Submitted, "#help-search")
    def _first(self, event: Input.Submitted) -> None:
        event.stop()
        hits = self.query_one(OptionList)
        if hits.display and hits.option_count and (name := hits.get_option_at_index(0).id):
            self.show_topic(name)

    def on_key(self, event: object) -> None:
        """Down moves from the field to the hits."""
        if getattr(event, "key", "") == "down" and self.query_one("#help-search").has_focus:
            hits = self.query_one(OptionList)
            (hits if hits.display else self.query_one(VerticalScroll)).focus()

    @on(OptionList.OptionSelected)
    def _chosen(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        if event.option.id:
            self.show_topic(event.option.id)

    def action_search(self) -> None:
        """Move to the search field."""
        self.query_one("#help-search", Input).focus()

    async def action_leave(self) -> None:
        """Hide the pane."""
        await self.app.run_action("do('view.hide')")
