"""Statements whose parts are made when somebody asks for them: of a large model's lines most never are.

Lines of one form differ in names and numbers only. Such a line is its form and its words; what it lowers to
is found from these (`lowering.written_lines`), its nodes only for messages, the editor and other passes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeVar

from desire_tui.engine.nodes.record import Node

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from desire_tui.engine.nodes.expressions import Expr

    MakerOfPart = Callable[[Sequence[str], Sequence[int]], Any]

Line = TypeVar("Line", bound="LazyParts")
_new: Callable[..., Any] = object.__new__


class LineForm(Generic[Line]):
    """What lines `x = e` or `d/dt x = e` have in common whose words stand at the same places.

    `target` is the number of the word that is assigned. `value` is their expression, an operation, over word
    numbers: the name `#k` or the number k stands for word k; forms that differ in lengths only share it.
    `makers` give the parts `target` and `value` from a line's words and their lengths added up.
    """

    __slots__ = ("end", "kind", "lengths", "makers", "start", "target", "value")

    def __init__(
        self,
        kind: type[Line],
        target: int,
        value: Expr,
        makers: Mapping[str, MakerOfPart],
        lengths: Sequence[int],
    ) -> None:
        self.kind, self.target, self.value = kind, target, value
        self.makers, self.lengths = makers, lengths
        self.start: int = makers["start"]((), lengths)
        self.end: int = makers["end"]((), lengths)

    def line(self, words: Sequence[str]) -> Line:
        """Return a statement without its parts."""
        made: Line = _new(self.kind)
        made.form, made.words = self, words
        made.start, made.end = self.start, self.end
        return made


def written_target(statement: Node) -> str | None:
    """Return the name of the scalar that a statement with a form assigns; None for all others."""
    if not isinstance(statement, LazyParts) or statement.form is None:
        return None
    return statement.words[statement.form.target]


class LazyParts(Node):
    """A statement that may have come from a `LineForm`: then its parts are made at their first use.

    `form` is None for all others.
    """

    __slots__ = ("form", "words")
    form: LineForm[Any] | None
    words: Sequence[str]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            """Make a part that is not there."""
            if name == "form":
                self.form = None
                return None
            if name in {"target", "value"} and self.form is not None:
                made = self.form.makers[name](self.words, self.form.lengths)
                setattr(self, name, made)
                return made
            raise AttributeError(name)
