"""Colours of programs on the site, from the engine's own tokens: there is one truth about what a word is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pygments.lexer import Lexer
from pygments.token import Comment, Keyword, Name, Number, Operator, String, Text

from desire_tui.engine.syntax.highlighting import highlight

if TYPE_CHECKING:
    from collections.abc import Iterator

_KINDS = {
    "keyword": Keyword, "number": Number, "string": String, "comment": Comment, "function": Name.Function,
    "system": Name.Builtin, "operator": Operator,
}  # fmt: skip


__all__ = ["DesireLexer"]


class DesireLexer(Lexer):
    """Programs of this language."""

    name = "Desire"
    aliases = ("desire",)

    def get_tokens_unprocessed(self, text: str) -> Iterator[tuple[int, object, str]]:
        """Yield place, kind and text of each token."""
        row_start = 0
        for row in text.splitlines(keepends=True):
            done = 0
            for start, end, name in highlight(row.rstrip("\n")):
                if start > done:
                    yield row_start + done, Text, row[done:start]
                yield row_start + start, _KINDS.get(name, Name), row[start:end]
                done = end
            yield row_start + done, Text, row[done:]
            row_start += len(row)
