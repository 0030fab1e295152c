"""The editor's colours, line by line, from the engine's own tokens.

TextArea asks `_highlights[row]` for byte ranges of a row it is about to draw. This mapping makes them when
asked,
so an edit costs nothing for the lines nobody sees. Ranges are kept by the line's text: scrolling and undo
reuse them.
"""

from __future__ import annotations

import sys
from functools import lru_cache
from typing import TYPE_CHECKING

from desire_tui.editor.program_lines import ProgramLines
from desire_tui.engine.visible_text import visible

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from textual.document._document import DocumentBase

    from desire_tui.language.problem_marks import Mark

Range = tuple[int, int | None, str]
_ENGINE = "desire_tui.engine.session.session"
"""Colours come once the engine is imported: the text is seen before."""
LINE_MAX = 2000
"""Longer lines are not coloured (characters)."""


class LineHighlights(dict[int, "list[Range]"]):
    """Row → ranges of bytes with the name of their style; later ones are drawn over earlier ones."""

    def __init__(self) -> None:
        super().__init__()
        self.document: DocumentBase | None = None
        self.marks: Mapping[int, Sequence[Mark]] = {}
        self.found: Mapping[int, Sequence[tuple[int, int]]] = {}
        self.is_program = True

    def __bool__(self) -> bool:
        return self.document is not None

    @staticmethod
    def are_on() -> bool:
        """Whether there are colours: not before the engine is imported."""
        return _ENGINE in sys.modules

    def before(self, row: int) -> str:
        """Return the rows of a statement that goes on in this one; an empty text if none does."""
        if not self.are_on() or not self.is_program or not isinstance(self.document, ProgramLines):
            return ""
        try:
            from desire_tui.engine.syntax.statement_rows import before

            return before(self.document.lines, row)
        except Exception:  # noqa: BLE001 - colours are an ornament, as below
            return ""

    def __missing__(self, row: int) -> list[Range]:
        assert self.document is not None
        text = self.document.get_line(row)
        line = visible(text)  # the bytes of what is drawn
        coloured = self.is_program and len(line) <= LINE_MAX and self.are_on()
        ranges = list(_colours(self.before(row), text)) if coloured else []
        ranges += [(_bytes(line, a), _bytes(line, b), "found") for a, b in self.found.get(row, ()) if a < b]
        for mark in self.marks.get(row, ()):
            start = min(mark.start, max(len(line) - 1, 0))
            end = max(mark.end, start + 1)
            ranges.append((_bytes(line, start), _bytes(line, end), mark.style))
        return ranges


@lru_cache(maxsize=4096)
def _colours(before: str, line: str) -> tuple[Range, ...]:
    try:
        from desire_tui.engine.syntax.highlighting import highlight

        skipped, shown = len(before), visible(line)
        return tuple(
            (_bytes(shown, start - skipped), _bytes(shown, end - skipped), name)
            for start, end, name in highlight(before + line)
            if start >= skipped
        )
    except Exception:  # noqa: BLE001 - colours are an ornament: a fault in them must not take the text away
        return ()


def _bytes(line: str, column: int) -> int:
    return column if line.isascii() else len(line[:column].encode("utf-8", "surrogatepass"))
