"""Renaming what a program names itself: which characters change, and what speaks against the new name."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.library import LIBRARY
from desire_tui.engine.source import Source, Span
from desire_tui.engine.syntax.statement_tokens import NAME
from desire_tui.engine.syntax.tokens import scan
from desire_tui.engine.syntax.words import KEYWORDS, SOFT_WORDS
from desire_tui.engine.values import SYSTEM_VARIABLES
from desire_tui.language.names import ProgramNames

if TYPE_CHECKING:
    from desire_tui.language.names import Symbol, SymbolKind

_SPECIAL = frozenset().union(*SOFT_WORDS.values()) | {"input", "output", "d", "dt"}
"""Words that mean something in the middle of a statement; `d/dt` is one of them."""
KIND_WORDS: dict[SymbolKind, str] = {
    "variable": "variable", "function": "FUNCTION", "procedure": "PROCEDURE", "submodel": "SUBMODEL",
    "label": "label", "system": "system variable", "library": "library function",
}  # fmt: skip


class RenameRefusedError(ValueError):
    """Why a name cannot be changed, in a sentence."""


def renamed(names: ProgramNames, symbol: Symbol, new: str) -> tuple[Span, ...]:
    """Return the places that take the new name, all of one meaning. RenameRefusedError: it cannot be.

    Comments and strings stay, except the names of `units`.
    """
    if not symbol.is_own:
        raise RenameRefusedError(
            f"'{symbol.name}' is a {KIND_WORDS[symbol.kind]} of the language: it keeps its name"
        )
    if new == symbol.name:
        return ()
    _check_word(new)
    _check_free(names, symbol, new)
    spans = tuple(Span(place.start, place.end) for place in names.of(symbol))
    if not _means_the_same(
        names, ProgramNames(Source(_replaced(names.source.text, spans, new))), symbol, new
    ):
        raise RenameRefusedError(f"with the name '{new}' the program would no longer say the same")
    return spans


def _check_word(new: str) -> None:
    """RenameRefusedError: nothing can have that name."""
    chunks = scan(f"x = {new}").chunks
    kinds = chunks[0].kinds if len(chunks) == 1 and chunks[0].fault is None else []
    if kinds != [NAME, "=", NAME] or chunks[0].texts[2] != new:
        raise RenameRefusedError(
            f"'{new}' is no name: a name is a letter, then letters of the alphabet, digits, _ or $"
        )
    if new in SYSTEM_VARIABLES or new in LIBRARY:
        what = "variable of the system" if new in SYSTEM_VARIABLES else "function of the library"
        raise RenameRefusedError(f"'{new}' is a {what}: choose another name")
    if new in KEYWORDS or new in _SPECIAL:
        raise RenameRefusedError(f"'{new}' is a word of the language: choose another name")


def _check_free(names: ProgramNames, symbol: Symbol, new: str) -> None:
    """RenameRefusedError: the name is taken; labels have names of their own."""
    is_label = symbol.kind == "label"
    taken = next((s for s in names.symbols if s.name == new and (s.kind == "label") == is_label), None)
    if taken is not None:
        row = names.source.position(names.of(taken)[0].start).row
        what = "an argument" if taken.scope is not None else f"a {KIND_WORDS[taken.kind]}"
        raise RenameRefusedError(f"'{new}' is taken: it is {what} in line {row}")


def _replaced(text: str, spans: tuple[Span, ...], new: str) -> str:
    pieces, end = [], 0
    for span in spans:
        pieces += [text[end : span.start], new]
        end = span.end
    return "".join((*pieces, text[end:]))


def _means_the_same(before: ProgramNames, after: ProgramNames, symbol: Symbol, new: str) -> bool:
    """Whether every name stands for what it stood for, and as much of the program can be read."""
    if len(before.program.problems) != len(after.program.problems):
        return False
    wanted = [
        (new if old.symbol == symbol else old.symbol.name, old.symbol.kind, old.use)
        for old in before.occurrences
    ]
    return wanted == [(now.symbol.name, now.symbol.kind, now.use) for now in after.occurrences]
