"""Help: a page, a search over all pages, and the list of keys."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.text import Text
from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical, VerticalScroll
from textual.content import Content
from textual.message import Message
from textual.widgets import Input, OptionList, Static
from textual.widgets.option_list import Option

from desire_tui.commands import BY_ID, COMMANDS, Command
from desire_tui.common.key_names import key_names

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from textual.app import ComposeResult

    from desire_tui.help.page_catalogue import Topic

HITS_MAX = 200
WELCOME = """\
Type above to search all pages; Enter opens the first, ↓ goes to the others.

**F5** runs the program in front, **Ctrl+C** pauses, **F1** on a word explains it, **Ctrl+P** lists every
action. `help 'dispt'` on the command line opens a page too, `help 94` an error's.
"""
WELCOME_LINKS = (
    "first steps",
    "running programs",
    "the graph",
    "DYNAMIC",
    "drun",
    "functions",
    "the examples",
)
LINKS_MAX = 9


class LinkRow(Static):
    """The pages that a page names, each with the digit that opens it."""

    DEFAULT_CSS = """
    LinkRow { height: auto; max-height: 3; padding: 0 1; background: $panel; color: $text-muted;
              display: none; }
    """

    class Followed(Message):
        """A link was clicked."""

        def __init__(self, number: int) -> None:
            super().__init__()
            self.number = number

    def offer(self, words: Sequence[str], *, back: bool) -> None:
        """Show links, and how to get back."""
        parts = [
            Content.from_markup(f"[@click=follow({number})][b]{number}[/b] $word[/]", word=word)
            for number, word in enumerate(words, 1)
        ]
        if back:
            parts.append(Content("⌫ back"))
        self.update(Content("  ·  ").join(parts))
        self.display = bool(parts)

    def action_follow(self, number: int) -> None:
        """Open a link."""
        self.post_message(self.Followed(number))


class HelpPane(Vertical):
    """One page at a time; Esc goes back to where the focus was."""

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
    HelpPane MarkdownFence > Label { padding: 0 1; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Back", show=False),
        Binding("slash", "search", "Search", show=False),
        Binding("backspace", "back", "Back", show=False),
        *(Binding(str(n), f"follow({n})", show=False) for n in range(1, LINKS_MAX + 1)),
    ]

    def __init__(self, keys: Mapping[str, str]) -> None:
        """`keys`: those of each command id that the user configured."""
        super().__init__(id="help")
        self._keys = keys
        self._way: list[str] = []  # the pages that led here
        self._links: tuple[str, ...] = ()

    def compose(self) -> ComposeResult:
        """Search field, hits, page."""
        yield Input(placeholder="search help", id="help-search")
        yield OptionList()
        yield VerticalScroll()
        yield LinkRow()

    def show_topic(self, word: str) -> None:
        """Show a page; without one, the search for the word."""
        from desire_tui.help.page_catalogue import find

        field = self.query_one("#help-search", Input)
        page = find(word) if word else None
        if word == "keys":
            self._show_page(self.keys_page(), "keys", ("settings",))
        elif page is not None:
            text = page.markdown.partition("\nSee also: ")[0]  # the row below has them
            self._show_page(text + self._actions_of(page), page.name, page.see)
        elif word:
            field.value = word
        else:
            with field.prevent(Input.Changed):
                field.value = ""
            self._way.clear()
            self._show_page(WELCOME, "", WELCOME_LINKS)
        if not word or (page is None and word != "keys"):
            field.focus()
        else:
            self.query_one(VerticalScroll).focus()

    def keys_page(self) -> str:
        """Return the list of all actions with keys and words."""
        return "# Keys\n\n" + self._table(COMMANDS)

    def _actions_of(self, page: Topic) -> str:
        """Return the table of what a page of the desktop is about."""
        return "\n" + self._table([BY_ID[name] for name in page.actions]) if page.actions else ""

    def _table(self, commands: Sequence[Command]) -> str:
        rows = []
        for command in commands:
            keys = key_names(self._keys.get(command.id, command.keys))
            words = ", ".join(f"`{word}`" for word in command.words)
            rows.append(f"| {keys} | {command.title} | {words} |")
        return "| key | action | command |\n| --- | --- | --- |\n" + "\n".join(rows) + "\n"

    def _show_page(self, text: str, name: str, links: Sequence[str]) -> None:
        if not self._way or self._way[-1] != name:
            self._way.append(name)
        self._links = tuple(links)[:LINKS_MAX]
        self.query_one(LinkRow).offer(self._links, back=len(self._way) > 1)
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
        from desire_tui.help.help_search import search

        event.stop()
        hits = self.query_one(OptionList)
        if not event.value.strip():
            hits.display = False
            self.query_one(VerticalScroll).display = True
            return
        hits.clear_options()
        for page in search(event.value)[:HITS_MAX]:
            hits.add_option(
                Option(
                    Text.assemble((f"{page.name:<16} ", "bold"), page.summary, no_wrap=True),
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

    @on(LinkRow.Followed)
    def _followed(self, event: LinkRow.Followed) -> None:
        event.stop()
        self.action_follow(event.number)

    def action_follow(self, number: int) -> None:
        """Open the link with that digit."""
        if number <= len(self._links):
            self.show_topic(self._links[number - 1])

    def action_back(self) -> None:
        """Show the page before."""
        if len(self._way) > 1:
            self._way.pop()
            self.show_topic(self._way.pop())

    def action_search(self) -> None:
        """Move to the search field."""
        self.query_one("#help-search", Input).focus()

    async def action_leave(self) -> None:
        """Hide the pane."""
        await self.app.run_action("do('view.hide')")
