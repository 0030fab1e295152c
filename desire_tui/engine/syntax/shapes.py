"""Statements that differ only in names and numbers share one parse.

1401 circuit equations have four shapes: the sequence of their tokens' kinds. The grammar derives each new
shape once; from the second statement on, a function generated for the shape makes the nodes straight from
the tokens, 20 times faster than parsing.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from desire_tui.engine.left_chains import OPERATORS, chain
from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.expressions import Binary, Name, Number, Unary
from desire_tui.engine.nodes.record import Node
from desire_tui.engine.nodes.segment import Derivative
from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.syntax.automaton import derive
from desire_tui.engine.syntax.build import NumberToken, Token
from desire_tui.engine.syntax.literals import octal_value
from desire_tui.engine.syntax.statement_tokens import NUMBER, STRING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from desire_tui.engine.nodes.lazy_parts import MakerOfPart
    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.syntax.statement_tokens import StatementTokens

    Maker = Callable[[StatementTokens], Statement]
    MakerOfWords = Callable[[Sequence[str], Sequence[int]], Statement]

SHAPES_ROOM = 500
"""Shapes of earlier programs: with its function, one takes some 10 KB."""
SHARED_TOKENS_MAX = 300
"""Longer statements (mostly data lists) share no shape: they seldom look alike, and lines are cached."""
_LETTERED = frozenset({"display", "FFT"})
"""Statements whose letter decides how many arguments they take: it is part of their shape."""
_OPERATIONS, _SIGNS = frozenset("+-*/"), frozenset("+-")
_patterns: RecentlyUsed[tuple[str, ...], Statement] = RecentlyUsed(SHAPES_ROOM)
_makers: RecentlyUsed[tuple[str, ...], tuple[Maker, Statement]] = RecentlyUsed(SHAPES_ROOM)
"""With the pattern it was made of, which may be forgotten meanwhile where it is kept by itself."""


def statement(chunk: StatementTokens) -> Statement:
    """Return the statement of these tokens. Raises automaton.Unexpected or build.Misuse."""
    shape = tuple(chunk.kinds)
    if shape[0] in _LETTERED:
        shape = (*shape, *chunk.texts[1:2])
    if len(shape) > SHARED_TOKENS_MAX:
        alone: Statement = _filled(derive(chunk.kinds, chunk.texts), chunk)
        return alone
    known = _makers[shape]
    if known is not None:
        return known[0](chunk)
    pattern = _patterns[shape]
    if pattern is None:
        pattern = derive(chunk.kinds, chunk.texts)
        _patterns.keep(shape, pattern)
        node: Statement = _filled(pattern, chunk)
        return node
    maker = _generate(pattern)
    _makers.keep(shape, (maker, pattern))
    return maker(chunk)


def function_of_words(chunk: StatementTokens, places: WordPlaces) -> MakerOfWords | None:
    """Return a function of a line's words `v` and their lengths added up, `c`, for statements of this shape.

    None for a shape that was not seen before, and for a statement nested too deep.
    """
    shape = tuple(chunk.kinds)
    known = _makers[shape]
    pattern = _patterns[shape] if known is None else known[1]
    if pattern is None:
        return None
    names: dict[str, Any] = {"octal_value": octal_value}
    code = _Code(names, places)
    try:
        made: MakerOfWords = eval(f"lambda v, c: {code.of(pattern)}", names)  # noqa: S307 - see _Code
    except (SyntaxError, MemoryError, RecursionError):
        return None
    return made


def makers_of_parts(
    chunk: StatementTokens, places: WordPlaces
) -> tuple[type[Derivative | Assign], dict[str, MakerOfPart]] | None:
    """Return the class of `x = e` or `d/dt x = e`, and functions of words that make one part each.

    None for other statements, and where e is no operation of two or holds more than names, numbers, + - * /.
    """
    shape = tuple(chunk.kinds)
    known = _makers[shape]
    pattern = _patterns[shape] if known is None else known[1]
    if (
        not isinstance(pattern, Derivative | Assign)
        or type(pattern.target) is not Name
        or not isinstance(pattern.value, Binary)
        or not _is_plain(pattern.value)
    ):
        return None
    names: dict[str, Any] = {"octal_value": octal_value}
    code = _Code(names, places)
    parts = {name: code.of(getattr(pattern, name)) for name in ("target", "value")}
    parts |= {"start": places.starts[pattern.start], "end": places.ends[pattern.end]}
    makers = {name: eval(f"lambda v, c: {text}", names) for name, text in parts.items()}  # noqa: S307 - see _Code
    return type(pattern), makers


def _is_plain(part: Any) -> bool:
    """Whether a pattern's expression holds names, numbers, signs and the four operations."""
    if type(part) is Binary:
        return part.op in _OPERATIONS and _is_plain(part.left) and _is_plain(part.right)
    if type(part) is Unary:
        return part.op in _SIGNS and _is_plain(part.operand)
    return type(part) in {Name, Number}


def age() -> None:
    """Between two programs: forget shapes that no program of late had."""
    _patterns.age()
    _makers.age()


def forget() -> None:
    """Forget all shapes: the next statement of each is derived from the grammar again."""
    _patterns.forget()
    _makers.forget()


def _filled(part: Any, chunk: StatementTokens) -> Any:
    """Copy a pattern with this statement's texts and offsets: worth it for a shape that is seen only once."""
    if isinstance(part, Binary) and part.op in OPERATORS:
        first, steps = chain(part)
        made = _filled(first, chunk)
        for step in steps:
            right = _filled(step.right, chunk)
            made = Binary(step.op, made, right, chunk.starts[step.start], chunk.ends[step.end])
        return made
    if isinstance(part, Node):
        record: Any = part
        values = [
            chunk.starts[part.start] if name == "start" else chunk.ends[part.end] if name == "end"
            else _filled(getattr(record, name), chunk)
            for name in record.__slots__
        ]  # fmt: skip
        return type(part)(*values)
    if isinstance(part, tuple):
        return tuple(_filled(item, chunk) for item in part)
    if isinstance(part, Token):
        text = chunk.texts[part.number]
        return text[1:-1] if part.kind == STRING else text
    if isinstance(part, NumberToken):
        text = chunk.texts[part.number]
        return float(text) if part.kind == NUMBER else octal_value(text)
    return part


def _generate(pattern: Statement) -> Maker:
    """Compile a function of a chunk that makes the pattern's nodes."""
    names: dict[str, Any] = {"octal_value": octal_value}
    body = f"lambda v, s, e: {_Code(names).of(pattern)}"
    try:
        make = eval(body, names)  # noqa: S307 - see _Code
    except (
        SyntaxError,
        MemoryError,
        RecursionError,
    ):  # Python nests 200 parentheses at most, this language more
        return partial(_filled, pattern)
    return lambda chunk: make(chunk.texts, chunk.starts, chunk.ends)


class WordPlaces(NamedTuple):
    """For each token of a statement: its number among the line's words, code for its start and its end."""

    numbers: list[int]
    starts: list[str]
    ends: list[str]


class _Code:
    """Writes constructor calls. Only class names, numbers and this project's literals get into them.

    The classes that it names go into `names`. Tokens are numbered, and their offsets found, as `WordPlaces`
    says; without it, `v`, `s` and `e` are the tokens' texts, starts and ends.
    """

    def __init__(self, names: dict[str, Any], places: WordPlaces | None = None) -> None:
        self._names, self._places = names, places

    def of(self, part: Any) -> str:
        """Return the code that makes a part of a pattern."""
        if isinstance(part, Node):
            record: Any = part
            values = [
                self._start(part.start) if name == "start" else self._end(part.end) if name == "end"
                else self.of(getattr(record, name))
                for name in record.__slots__
            ]  # fmt: skip
            self._names[type(part).__name__] = type(part)
            return f"{type(part).__name__}({', '.join(values)})"
        if isinstance(part, tuple):
            return f"({''.join(self.of(item) + ', ' for item in part)})"
        if isinstance(part, Token):
            return f"v[{self._text(part.number):d}]" + ("[1:-1]" if part.kind == STRING else "")
        if isinstance(part, NumberToken):
            convert = "float" if part.kind == NUMBER else "octal_value"
            return f"{convert}(v[{self._text(part.number):d}])"
        assert part is None or isinstance(part, (bool, str))
        return repr(part)

    def _text(self, token: int) -> int:
        return token if self._places is None else self._places.numbers[token]

    def _start(self, token: int) -> str:
        return f"s[{token:d}]" if self._places is None else self._places.starts[token]

    def _end(self, token: int) -> str:
        return f"e[{token:d}]" if self._places is None else self._places.ends[token]
