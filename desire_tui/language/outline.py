"""What a program consists of, as a tree: definitions, parameters, segments with equations; and what folds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.nodes.control import Procedure
from desire_tui.engine.nodes.declarations import Submodel
from desire_tui.engine.nodes.segment import Derivative, VectorDerivative
from desire_tui.engine.source import Span
from desire_tui.language.descriptions import kind_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.nodes.program import SegmentText
    from desire_tui.language.names import Occurrence, ProgramNames

EntryKind = Literal["segment", "state", "variable", "parameter", "array", "function", "definition", "label"]
_KINDS: dict[str, EntryKind] = {
    "function": "function", "procedure": "definition", "submodel": "definition", "label": "label",
}  # fmt: skip


@dataclass
class Entry:
    """A line of the outline: `span` is all that belongs to it, `name_span` its name."""

    name: str
    kind: EntryKind
    detail: str
    span: Span
    name_span: Span
    children: list[Entry] = field(default_factory=list)


def outline(names: ProgramNames) -> list[Entry]:
    """Return a program's outline in the order of the text."""
    segments = [_segment(names, number) for number in range(len(names.program.segments))]
    entries: list[Entry] = []
    for symbol in names.symbols:
        if not symbol.is_own or symbol.scope is not None:
            continue
        place = names.definition(symbol)
        if place is None:
            continue
        holder = next((entry for entry in segments if entry.span.start <= place.start < entry.span.end), None)
        if holder is None and (first := names.first_value(symbol)) is not None:
            place = first
        if holder is not None and symbol.kind == "label":
            continue  # the segment itself
        (entries if holder is None else holder.children).append(_entry(names, place))
    entries += segments
    for entry in segments:
        entry.children.sort(key=lambda child: child.span.start)
    return sorted(entries, key=lambda entry: entry.span.start)


def _segment(names: ProgramNames, number: int) -> Entry:
    segments, text = names.program.segments, names.source.text
    segment = segments[number]
    last = segments[number + 1].at if number + 1 < len(segments) else _last_end(names, segment)
    word = "DYNAMIC" if segment.label is None else segment.label
    at = segment.at if segment.label is None else text.find(segment.label, segment.at + len("label"))
    states = sum(isinstance(placed.node, Derivative | VectorDerivative) for placed in segment.body)
    detail = f"segment, {states} d/dt line{'' if states == 1 else 's'}"
    end = segment.at + len(text[segment.at : last].rstrip())
    return Entry(
        word, "segment", detail, Span(segment.at, max(end, at + len(word))), Span(at, at + len(word))
    )


def _last_end(names: ProgramNames, segment: SegmentText) -> int:
    """Return where the last segment's last line ends."""
    placed = [*segment.body, *segment.jacobian]
    end = placed[-1].span().end if placed else segment.at
    line_end = names.source.text.find("\n", end)
    return line_end if line_end >= 0 else len(names.source.text)


def _entry(names: ProgramNames, place: Occurrence) -> Entry:
    symbol, detail = place.symbol, kind_of(names, place.symbol)
    kind = _KINDS.get(symbol.kind)
    if kind is None:
        first = detail.split()[0]
        kind = "state" if first == "state" else "array" if "[" in detail else "variable"
        kind = "parameter" if first == "parameter" else kind
    read = names.statement(place.statement)
    start, end = place.start, place.end
    if read is not None:
        start, end = read.at, max(place.end, read.at + read.tokens.ends[-1])
        if isinstance(read.node, Procedure | Submodel):
            end = max(end, _closing_end(names, read.at))
    return Entry(symbol.name, kind, detail, Span(start, end), Span(place.start, place.end))


def _closing_end(names: ProgramNames, at: int) -> int:
    script, partner = names.program.script, names.structure.partner
    place = next((k for k, placed in enumerate(script) if placed.at == at), -1)
    return script[partner[place]].span().end if place in partner else at


def folds(names: ProgramNames, lines: Sequence[str]) -> list[tuple[int, int]]:
    """Return first and last rows (from 0) of what can be folded: blocks, segments, runs of comments."""
    found = set()
    script = names.program.script

    def row(offset: int) -> int:
        return names.source.position(offset).row - 1

    for opens, closes in names.structure.partner.items():
        if opens < closes:
            found.add((row(script[opens].at), row(script[closes].at)))
    for segment in names.program.segments:
        partner = names.structure.segment_partner.get(segment.label, {})
        body = segment.body
        pairs = ((body[a].at, body[b].at) for a, b in partner.items() if a < b < len(body))
        found |= {(row(a), row(b)) for a, b in pairs}
    for number, segment in enumerate(names.program.segments):
        entry = _segment(names, number)
        found.add((row(segment.at), row(entry.span.end)))
    return sorted({(a, b) for a, b in (*found, *_comments(lines)) if b > a})


def _comments(lines: Sequence[str]) -> list[tuple[int, int]]:
    """Return rows of comments that follow each other without a break."""
    found, start = [], -1
    for row, line in enumerate((*lines, "")):
        if line.lstrip().startswith("--"):
            start = row if start < 0 else start
        else:
            if start >= 0 and row - start > 1:
                found.append((start, row - 1))
            start = -1
    return found
