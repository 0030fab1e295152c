"""Statements whose parts are made when somebody asks for them: of a large model's lines most never are.

Lines of one form differ in names and numbers only. Such a line is its form and its words; what it lowers to
is found from these (`lowering.written_lines`), its nodes only for messages, the editor and other passes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.engine.nodes.record import Node

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from desire_tui.engine.nodes.assignments import Assign
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.segment import Derivative

    MakerOfPart = Callable[[Sequence[str], Sequence[int]], Any]

_new: Callable[..., Any] = object.__new__


class LineForm:
    """What lines `x = e` or `d/dt x = e` have in common whose words stand at the same places.

    `target` is the number of the word that is assigned. `value` is their expression, an operation, over word
    numbers: the name `#k` or the number k stands for word k; forms that differ in lengths only share it.
    `makers` give the parts `target` and `value` from a line's words and their lengths added up.
    """

    __slots__ = ("end", "kind", "lengths", "makers", "start", "target", "value")

    def __init__(
        self,
        kind: type[Derivative | Assign],
        target: int,
        value: Expr,
        makers: Mapping[str, MakerOfPart],
        lengths: Sequence[int],
    ) -> None:
        self.kind, self.target, self.value = kind, target, value
        self.makers, self.lengths = makers, lengths
        self.start: int = makers["start"]((), lengths)
        self.end: int = makers["end"]((), lengths)

    def line(self, words: Sequence[str]) -> Derivative | Assign:
        """Return a statement without its parts."""
        made: Derivative | Assign = _new(self.kind)
        made.form, made.words = self, words
        made.start, made.end = self.start, self.end  # type: ignore[misc]  # frozen for the type checker only
        return made


class LazyParts(Node):
    """A statement that may have come from a `LineForm`: then its parts are made at their first use.

    `form` is None for all others.
    """

    __slots__ = ("form", "words")
    form: LineForm | None
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
