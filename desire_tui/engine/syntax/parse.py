"""From a program's text to its statements; every bad statement of the text is reported in one go.

Lines are cached by their text: an edit parses one line anew, a second run none.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.cancellation import cancellation_point, handing_over
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.gc_pause import undisturbed_allocation
from desire_tui.engine.nodes.assignments import Bare
from desire_tui.engine.nodes.commands import Simple
from desire_tui.engine.nodes.control import GoTo, Label
from desire_tui.engine.nodes.expressions import Call, Element, Name
from desire_tui.engine.nodes.faulty import Faulty
from desire_tui.engine.nodes.files import Restore
from desire_tui.engine.nodes.program import Placed, Program, SegmentText
from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.source import Source, Span
from desire_tui.engine.syntax import line_patterns, shapes
from desire_tui.engine.syntax.automaton import Unexpected
from desire_tui.engine.syntax.build import Misuse
from desire_tui.engine.syntax.shapes import statement
from desire_tui.engine.syntax.statement_tokens import CLASSES, NAME, TokenFault, comment_mark, shown
from desire_tui.engine.syntax.tokens import CONTINUES, mark_logical_words, scan
from desire_tui.engine.syntax.words import keyword_like

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.syntax.statement_tokens import StatementTokens

    Item = tuple[Statement | TokenFault, int]
    Entry = tuple[tuple[Item, ...], str]

ROOM = 1_000_000
"""Characters of lines of earlier programs that are cached; their nodes take ten times as many bytes."""
FIRST_NUMBER, NUMBER_STEP = 210, 10
"""How the lines of a program without numbers count."""
ROWS_LOOKED_AT = 50
"""Of more joined rows, the last one is looked at alone: else long statements would take time squared."""
LINE_COST = 100
"""What a line adds to that beside its characters."""

_lines: RecentlyUsed[str, Entry] = RecentlyUsed(ROOM, cost=lambda line: len(line) + LINE_COST)
_NUMBERED = re.compile(r"[ \t]*([0-9]+)(?=[ \t]*(?:\r?\Z|--|—)|[ \t]+[A-Za-z|])")
_HEADER = re.compile(r"[ \t]*(?:/[ \t]*(?:NEW)?[ \t\r]*\Z|PIC[ \t]*['\"‘’“”])")
_STARTS_ODD = frozenset("0123456789/P \t")
_DIVIDERS = frozenset({"DYNAMIC"})
_PARTS = frozenset({"DYNAMIC", "label", "STOP", "JACOBIAN"})
"""Words that divide what stands behind DYNAMIC: if one cannot be read, nobody knows what belongs where."""
_BEHIND_NAMES = frozenset({"=", "[", "("})


@undisturbed_allocation
def parse(source: Source) -> Program:
    """Parse a whole program. Never raises: problems are in the result."""
    _lines.age()
    shapes.age()
    line_patterns.age()
    script: list[Placed] = []
    segments: list[SegmentText] = []
    problems: list[Diagnostic] = []
    faults: dict[int, Diagnostic] = {}
    body: list[Placed] | None = script
    jacobian: list[Placed] = []
    opened: tuple[str | None, int] = (None, 0)

    def close() -> None:
        if body is not None and body is not script:
            first = body if main is None else main
            segments.append(SegmentText(opened[0], tuple(first), tuple(jacobian), opened[1]))

    main: list[Placed] | None = None
    alone: list[Span] = []
    is_numbered = False
    reached = 0
    with handing_over(problems, lambda: reached):
        for entry, at, number, _ in logical_lines(source.text):
            reached = at
            if number is not None:
                is_numbered = is_numbered or bool(entry[0])
                if not entry[0] and body is not None:
                    alone.append(_number_before(source.text, at))
            for item, offset in entry[0]:
                if isinstance(item, TokenFault):
                    if body is not None:
                        problem = _diagnostic(item, at + offset, source)
                        problems.append(problem)
                        if item.meant and item.meant not in (_DIVIDERS if body is script else _PARTS):
                            body.append(Placed(Faulty(item.meant, 0, item.end), at + offset, number))
                            faults[at + offset] = problem
                    continue
                if isinstance(item, Bare) and not isinstance(item.value, Call | Element) and body is not None:
                    problems.append(_diagnostic(_no_statement(item), at + offset, source))
                    continue
                placed = Placed(item, at + offset, number)
                if body is script:
                    if isinstance(item, Simple) and item.word == "DYNAMIC":
                        body, opened = [], (None, placed.at)
                    else:
                        script.append(placed)
                    continue
                if isinstance(item, Label):
                    close()
                    body, main, jacobian, opened = [], None, [], (item.name, placed.at)
                elif body is None:
                    continue  # commentary behind a STOP
                elif isinstance(item, Simple) and item.word == "STOP":
                    close()
                    body = None
                elif isinstance(item, Simple) and item.word == "JACOBIAN" and main is None:
                    main, body = body, jacobian
                else:
                    body.append(placed)
    joint = _joining_nothing(source.text) if body is not None else None
    if joint is not None and not any(problem.span and problem.span.start >= reached for problem in problems):
        span = Span(joint, joint + 1)
        problems.append(Diagnostic("continuation-missing", span, {}, source, severity="warning"))
    close()
    if alone and not is_numbered:
        problems += [Diagnostic("expression-alone", span, {}, source) for span in alone]
        problems.sort(key=lambda problem: problem.span or (0, 0))
    lines = _line_places(source, script)
    return Program(source, tuple(script), tuple(segments), tuple(problems), lines, faults)


def parse_command(source: Source) -> tuple[tuple[Placed, ...], tuple[Diagnostic, ...]]:
    """Parse a command line: statements, and problems. A bare expression is a `Bare` node. Never raises."""
    placed: list[Placed] = []
    problems: list[Diagnostic] = []
    for entry, at, _, _ in logical_lines(source.text, command=True):
        for item, offset in entry[0]:
            if isinstance(item, TokenFault):
                problems.append(_diagnostic(item, at + offset, source))
            else:
                placed.append(Placed(item, at + offset))
    return tuple(placed), tuple(problems)


def forget_lines() -> None:
    """Empty the store of parsed lines, and of what they look like."""
    _lines.forget()
    line_patterns.forget()


def _number_before(text: str, end: int) -> Span:
    """Place of a number that makes up a line: an empty one where others are numbered too, else a mistake."""
    start = end
    while start > 0 and text[start - 1].isdigit():
        start -= 1
    return Span(start, end)


def would_spoil(rows: list[str]) -> bool:
    """Whether the first of some rows only seems to go on in the others: `x =` before a good statement."""
    return _swallowed(rows[0], _parse_line("\n".join(rows)), rows)


def _swallowed(line: str, whole: Entry, parts: list[str]) -> bool:
    """Whether a line that only seems to go on (`x =`) would spoil a good statement in the next one."""
    if line.rstrip().endswith("_") or not _has_fault(whole):
        return False
    rest = "\n".join(parts[1:])
    following = _lines[rest] or _parse_line(rest)
    return bool(following[0]) and not _has_fault(following) and not isinstance(following[0][0][0], Bare)


def _has_fault(entry: Entry) -> bool:
    return any(isinstance(item, TokenFault) for item, _ in entry[0])


def numbered(line: str) -> int:
    """Return how many characters of a line are its line number, or the whole length of a header line."""
    if _HEADER.match(line):
        return len(line)
    found = _NUMBERED.match(line)
    return found.end() if found else 0


def _joining_nothing(text: str) -> int | None:
    """Return the offset of a `_` that ends the text's last row, if no other row follows for it to join."""
    last = text.rstrip()
    if not last.endswith("_") or scan(last[last.rfind("\n") + 1 :]).continues != "_":
        return None
    return len(last) - 1


def _no_statement(item: Bare) -> TokenFault:
    """Return the fault of an expression that stands alone in a program (a command line prints it)."""
    if isinstance(item.value, Name):
        name = item.value.name
        return TokenFault("not-a-statement", 0, item.end, {"first": shown(name), "close": keyword_like(name)})
    return TokenFault("expression-alone", 0, item.end)


def _diagnostic(fault: TokenFault, at: int, source: Source) -> Diagnostic:
    return Diagnostic(fault.key, Span(at + fault.start, at + fault.end), fault.facts, source)


def is_header(line: str) -> bool:
    """Whether a line is one of those that the original's editor put around a program."""
    return _HEADER.match(line) is not None


def logical_lines(text: str, *, command: bool = False) -> Iterator[tuple[Entry, int, int | None, range]]:
    """Yield each line (with its continuations), the offset of its text, its line number if any, its rows.

    Lines without statements are left out, unless they are numbered. Rows are counted from 0.
    """
    known = _lines.__getitem__
    rows = text.split("\n")
    count = len(rows)
    at = i = 0
    while i < count:
        line = rows[i]
        first = i
        i += 1
        number = None
        next_at = at + len(line) + 1
        if line[:1] in _STARTS_ODD and line and not command:
            if _HEADER.match(line):
                at = next_at
                continue
            found = _NUMBERED.match(line)
            if found:
                number = int(found[1][:9])
                at += found.end()
                line = line[found.end() :]
        entry = known(line) or _parse_line(line)
        if entry[1] and i < count:
            parts = [line]
            more = entry[1]
            while more and i < count:
                parts.append(rows[i])
                next_at += len(rows[i]) + 1
                more = goes_on(rows[i], more, parts)
                i += 1
            whole = known("\n".join(parts)) or _parse_line("\n".join(parts))
            if _swallowed(line, whole, parts):
                i -= (
                    len(parts) - 1
                )  # the next line is a statement of its own: report the unfinished one alone
                next_at = at + len(line) + 1
            else:
                entry = whole
        cancellation_point()
        if entry[0] or number is not None:
            yield entry, at, number, range(first, i)
        at = next_at


def goes_on(row: str, before: str = "", rows: Sequence[str] = ()) -> str:
    """Return what makes a row go on in the next one, if anything (`LogicalLine.continues`).

    `before` is what made the row above go on in this one; `rows` are those above and the row itself: where
    `_` joins them, `run *` may be the end of `drun *`.
    """
    if before and before not in CONTINUES:
        return scan(before + row).continues  # the row begins inside a string
    if before and row.lstrip().startswith("--"):
        return before  # a comment may stand between
    more = (_lines[row] or _parse_line(row))[1]
    if before == "_" and more not in ("", "_") and len(rows) <= ROWS_LOOKED_AT:
        return scan("\n".join(rows)).continues
    return more


class NumberedLine(NamedTuple):
    """A line's number and its rows, counted from 0."""

    number: int
    rows: range


def numbered_lines(text: str) -> list[NumberedLine]:
    """Return the lines of a program by their numbers, in the order of the text."""
    rows = text.split("\n")
    own: list[NumberedLine] = []
    joined = {}
    for _, _, number, lines in logical_lines(text):
        joined[lines.start] = lines
        if number is not None:
            own.append(NumberedLine(number, lines))
    if own:
        return own
    counted: list[NumberedLine] = []
    at = 0
    while at < len(rows):
        lines = joined.get(at, range(at, at + 1))
        if rows[at].strip() and not is_header(rows[at]):
            counted.append(NumberedLine(FIRST_NUMBER + NUMBER_STEP * len(counted), lines))
        at = lines.stop
    return counted


def _line_places(source: Source, script: list[Placed]) -> tuple[tuple[int, int], ...]:
    """Return numbers and offsets of lines if the script jumps to any; else nothing, which costs nothing."""
    targets = (placed.node.target for placed in script if isinstance(placed.node, GoTo | Restore))
    if not any(target is not None and target.isdigit() for target in targets):
        return ()
    starts = source.line_starts
    return tuple((line.number, starts[line.rows.start]) for line in numbered_lines(source.text))


def _parse_line(line: str) -> Entry:
    """Parse the statements of a logical line, and keep them."""
    read = line_patterns.read(line)
    if read is not None:
        entry: Entry = ((read,), "")
    else:
        scanned = scan(line)
        entry = tuple((_item(chunk), chunk.base) for chunk in scanned.chunks), scanned.continues
        if len(entry[0]) == 1 and not (scanned.continues or scanned.comments or _has_fault(entry)):
            line_patterns.learn(line, scanned.chunks[0])
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
