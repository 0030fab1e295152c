"""From a program's text to its statements; every bad statement of the text is reported in one go."""

from __future__ import annotations

from desire_tui.engine.cancellation import handing_over
from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.gc_pause import undisturbed_allocation
from desire_tui.engine.nodes.assignments import Bare
from desire_tui.engine.nodes.commands import Simple
from desire_tui.engine.nodes.control import GoTo, Label
from desire_tui.engine.nodes.expressions import Call, Element, Name
from desire_tui.engine.nodes.faulty import Faulty
from desire_tui.engine.nodes.files import Restore
from desire_tui.engine.nodes.program import Placed, Program, SegmentText
from desire_tui.engine.source import Source, Span
from desire_tui.engine.syntax import parsed_lines
from desire_tui.engine.syntax.logical_lines import lines_and_runs, logical_lines, numbered_lines
from desire_tui.engine.syntax.statement_tokens import TokenFault, shown
from desire_tui.engine.syntax.tokens import scan
from desire_tui.engine.syntax.words import keyword_like

_DIVIDERS = frozenset({"DYNAMIC"})
_PARTS = frozenset({"DYNAMIC", "label", "STOP", "JACOBIAN"})
"""Words that divide what stands behind DYNAMIC: if one cannot be read, nobody knows what belongs where."""


@undisturbed_allocation
def parse(source: Source) -> Program:
    """Parse a whole program. Never raises: problems are in the result."""
    parsed_lines.age()
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
        for piece in lines_and_runs(source.text):
            if isinstance(piece, list):
                if body is not None:
                    body += piece
                reached = piece[-1].at
                continue
            entry, at, number, _ = piece
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


def _number_before(text: str, end: int) -> Span:
    """Place of a number that makes up a line: an empty one where others are numbered too, else a mistake."""
    start = end
    while start > 0 and text[start - 1].isdigit():
        start -= 1
    return Span(start, end)


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


def _line_places(source: Source, script: list[Placed]) -> tuple[tuple[int, int], ...]:
    """Return numbers and offsets of lines if the script jumps to any; else nothing, which costs nothing."""
    targets = (placed.node.target for placed in script if isinstance(placed.node, GoTo | Restore))
    if not any(target is not None and target.isdigit() for target in targets):
        return ()
    starts = source.line_starts
    return tuple((line.number, starts[line.rows.start]) for line in numbered_lines(source.text))
