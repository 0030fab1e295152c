"""Searching a tab's text: what is wanted, where it stands, which one is selected, what replaces it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.editor.text_search import SearchRequest, Unsearchable, span
from desire_tui.engine.data_classes import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.document._document import Location

    from desire_tui.editor.code_area import CodeArea
    from desire_tui.editor.program_lines import ProgramLines
    from desire_tui.editor.text_search import Hit, Range


class Finder:
    """Searches one text at a time. Occurrences are looked for again only if something changed."""

    def __init__(self) -> None:
        self.area: CodeArea | None = None
        self.wanted = SearchRequest("")
        self._within: Range | None = None
        self._document: ProgramLines | None = None
        """The lines whose changes `_within` follows."""
        self._found: tuple[object, list[Hit] | Unsearchable] = (None, [])

    # ------------------------------------------------------------------------------------ where and how

    def look_at(self, area: CodeArea) -> None:
        """Search another text."""
        if area is self.area:
            return
        self.show_hits(())
        if self.area is None or area.tab is not self.area.tab:
            self.limit_to_nothing()
        self.area = area

    def search_for(self, text: str) -> None:
        """Search for another text, in the same way."""
        self.wanted = replace(self.wanted, text=text)

    def is_on(self, name: str) -> bool:
        """Whether a way of searching is on: `case`, `word`, `regex`, `within`."""
        match name:
            case "case":
                return self.wanted.minds_case
            case "within":
                return self._within is not None
        return bool(getattr(self.wanted, name))

    def switch(self, name: str) -> bool:
        """Turn a way of searching on or off. False if nothing is selected to search in."""
        if name == "within":
            if self._within is None:
                return self.limit_to_selection()
            self.limit_to_nothing()
        else:
            on = not self.is_on(name)
            match name:
                case "case":
                    self.wanted = replace(self.wanted, case=on)
                case "word":
                    self.wanted = replace(self.wanted, word=on)
                case _:
                    self.wanted = replace(self.wanted, regex=on)
        return True

    def limit_to_selection(self) -> bool:
        """Search inside the selection only, wherever it moves; False if nothing is selected."""
        if self.area is None or self.area.selection.is_empty:
            return False
        self.limit_to_nothing()
        start, end = sorted(self.area.selection)
        self._within, self._document = (start, end), self.area.document
        self._document.followers.append(self._follow)
        return True

    def limit_to_nothing(self) -> None:
        """Search the whole text."""
        if self._document is not None:
            self._document.followers.remove(self._follow)
        self._within = self._document = None

    def _follow(self, top: Location, bottom: Location, end: Location) -> None:
        assert self._within is not None
        assert self._document is not None
        start, last = self._within
        followed = self._document.followed
        self._within = followed(start, top, bottom, end), followed(last, top, bottom, end)

    @property
    def place(self) -> str:
        """Where it searches, if not everywhere."""
        return f"in {self._within[0][0] + 1}–{self._within[1][0] + 1}" if self._within else ""

    # --------------------------------------------------------------------------------------------- searching

    def hits(self) -> list[Hit]:
        """Return all occurrences. Raises Unsearchable."""
        if self.area is None:
            return []
        key = (self.area.text, self.wanted, self._within)
        if self._found[0] != key:
            try:
                self._found = key, self.wanted.hits(self.area.document.lines, self._within)
            except Unsearchable as why:
                self._found = key, why  # it took its time: not again at the next key
        found = self._found[1]
        if isinstance(found, Unsearchable):
            raise found
        return found

    def first(self) -> int | None:
        """Select the first occurrence from the selection's start on; returns its number."""
        hits = self.hits()
        if self.area is None or not hits:
            return None
        here = min(self.area.selection)
        return self._select(next((n for n, hit in enumerate(hits) if span(hit)[0] >= here), 0))

    def step(self, step: int) -> int | None:
        """Select the next (1) or the previous (-1) occurrence, going round; returns its number."""
        hits = self.hits()
        if self.area is None or not hits:
            return None
        start, end = sorted(self.area.selection)
        if step > 0:
            beyond = (n for n, hit in enumerate(hits) if span(hit)[0] >= end and span(hit) != (start, end))
            return self._select(next(beyond, 0))
        before = (n for n in reversed(range(len(hits))) if span(hits[n])[0] < start)
        return self._select(next(before, len(hits) - 1))

    def has_selected(self, area: CodeArea) -> bool:
        """Whether a text's selection is an occurrence of what is wanted."""
        selected = tuple(sorted(area.selection))
        try:
            return area is self.area and any(span(hit) == selected for hit in self.hits())
        except Unsearchable:
            return False

    def _select(self, number: int) -> int:
        assert self.area is not None
        start, end = span(self.hits()[number])
        self.area.move_cursor(start, center=True)
        self.area.move_cursor(end, select=True)
        return number

    def show_hits(self, hits: Sequence[Hit]) -> None:
        """Mark occurrences in the text."""
        if self.area is None:
            return
        found: dict[int, list[tuple[int, int]]] = {}
        for row, start, end in hits:
            found.setdefault(row, []).append((start, end))
        if found != self.area.marks.found:
            self.area.marks.found = found
            self.area.marks_changed()

    # --------------------------------------------------------------------------------------------- replacing

    def replace_one(self, by: str) -> None:
        """Replace the occurrence that is selected, if one is. Raises Unsearchable."""
        if self.area is None:
            return
        selected = tuple(sorted(self.area.selection))
        hit = next((hit for hit in self.hits() if span(hit) == selected), None)
        if hit is not None:
            self.area.replace_as_one(self.wanted.replaced(self.area.document.lines, hit, by), *span(hit))

    def replace_all(self, by: str) -> int:
        """Replace every occurrence as one undoable change; returns how many. Raises Unsearchable."""
        if self.area is None or not self.wanted.text:
            return 0
        area = self.area
        change = self.wanted.all_replaced(area.document.lines, by, self._within)
        if change.places:
            area.rewrite_rows(change.top, change.bottom, change.lines)
            area.move_cursor((change.top, 0))
        return change.places
