"""The statements of a line, kept by its text: an edit parses one line anew, a second run none."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.segment import Derivative
from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.syntax import line_patterns, shapes
from desire_tui.engine.syntax.automaton import Unexpected
from desire_tui.engine.syntax.build import Misuse
from desire_tui.engine.syntax.shapes import statement
from desire_tui.engine.syntax.statement_tokens import CLASSES, NAME, TokenFault, comment_mark
from desire_tui.engine.syntax.tokens import mark_logical_words, scan

if TYPE_CHECKING:
    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.syntax.statement_tokens import StatementTokens

    Item = tuple[Statement | TokenFault, int]
    Entry = tuple[tuple[Item, ...], str]
    """Statements with their offsets in the line, and what makes the line go on in the next, if anything."""

ROOM = 1_000_000
"""Characters of lines of earlier programs that are cached; their nodes take ten times as many bytes."""
LINE_COST = 100
"""What a line adds to that beside its characters."""

_lines: RecentlyUsed[str, Entry] = RecentlyUsed(ROOM, cost=lambda line: len(line) + LINE_COST)
_plain: RecentlyUsed[str, Item | tuple[()]] = RecentlyUsed(ROOM, cost=lambda line: len(line) + LINE_COST)
"""Of those that are one assignment or equation, and complete, the statement; () where there is none."""
_PLAIN = frozenset({Assign, Derivative})
_BEHIND_NAMES = frozenset({"=", "[", "("})

known_line = _lines.__getitem__
"""The entry of a line that was parsed before, or None."""
known_plain_line = _plain.__getitem__
"""The statement of a line that was found to be plain before, () if it has none, or None."""


def parsed_line(line: str) -> Entry:
    """Return the statements of a logical line."""
    plain = _plain[line]
    if plain is not None:
        return ((plain,) if plain else (), "")
    return _lines[line] or _parse_line(line)


def plain_line(line: str) -> Item | tuple[()] | None:
    """Return the statement of a line if it is one assignment or equation, and complete; () if it has none."""
    if _lines[line] is not None:
        return None
    _parse_line(line)
    return _plain[line]


def knows(text: str) -> bool:
    """Whether lines in the middle of a text were parsed before: so were most others, too."""
    middle = len(text) // 2
    rows = text[middle : middle + 1000].split("\n")[1:4]
    return any(row.strip() and (_plain[row] or _lines[row]) for row in rows)


def has_fault(entry: Entry) -> bool:
    """Whether a statement of a line cannot be read."""
    return any(isinstance(item, TokenFault) for item, _ in entry[0])


def age() -> None:
    """Between two programs: forget lines, and what they look like, that no program of late had."""
    _lines.age()
    _plain.age()
    shapes.age()
    line_patterns.age()


def forget_lines() -> None:
    """Empty the store of parsed lines, and of what they look like."""
    _lines.forget()
    _plain.forget()
    line_patterns.forget()


def _parse_line(line: str) -> Entry:
    """Parse the statements of a logical line, and keep them."""
    read = line_patterns.read(line)
    if read is not None:
        entry: Entry = ((read,), "")
    else:
        scanned = scan(line)
        entry = tuple((_item(chunk), chunk.base) for chunk in scanned.chunks), scanned.continues
        if len(entry[0]) == 1 and not (scanned.continues or scanned.comments or has_fault(entry)):
            line_patterns.learn(line, scanned.chunks[0])
    items, more = entry
    is_plain = not items or (len(items) == 1 and type(items[0][0]) in _PLAIN)
    if is_plain and not more and "\n" not in line:
        _plain.keep(line, items[0] if items else ())
    else:
        _lines.keep(line, entry)
    return entry


def _item(chunk: StatementTokens) -> Statement | TokenFault:
    item = _parsed(chunk)
    if isinstance(item, TokenFault):
        item.meant = _meant(chunk, item)
    return item


def _meant(chunk: StatementTokens, fault: TokenFault) -> str:
    """Return the word by which a faulty statement is known: its keyword, or NAME of one that assigns."""
    if not chunk.kinds or fault.key == "not-a-statement":
        return ""
    head = chunk.kinds[0]
    if head == NAME:
        return NAME if chunk.kinds[1:2] and chunk.kinds[1] in _BEHIND_NAMES else ""
    return "" if head in CLASSES or not head[0].isalpha() else head


def _parsed(chunk: StatementTokens) -> Statement | TokenFault:
    if chunk.fault is not None:
        return comment_mark(chunk) or chunk.fault
    try:
        return statement(chunk)
    except Unexpected as problem:
        if mark_logical_words(chunk):
            return _parsed(chunk)
        from desire_tui.engine.syntax.error_explanation import explain

        return explain(chunk, problem.at, problem.expected)
    except Misuse as problem:
        return TokenFault(problem.key, chunk.starts[problem.first], chunk.ends[problem.last], problem.facts)
