"""What a name of a program is, in Markdown: kind, size, the line that defines it, its value."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowering.scope import UNKNOWN
from desire_tui.engine.nodes.control import Procedure
from desire_tui.engine.nodes.declarations import Submodel
from desire_tui.help.page_catalogue import find

if TYPE_CHECKING:
    from collections.abc import Mapping

    from desire_tui.language.names import Occurrence, ProgramNames, Symbol

SHOWN_MAX = 300
"""Characters of a line that are shown."""
LINES_MAX = 8
"""Lines of a definition that are shown."""


def described(names: ProgramNames, at: Occurrence, values: Mapping[str, float]) -> str:
    """Return what stands at a place, as Markdown. `values`: of quantities after the last run, by their names.

    Words of the language have their help page.
    """
    symbol = at.symbol
    if not symbol.is_own:
        page = find(symbol.name)
        text = page.markdown if page is not None else f"`{symbol.name}`: {kind_of(names, symbol)}"
    else:
        text = _own(names, symbol)
    value = _value(names, symbol, values)
    return f"{text}\n\n{value}" if value else text


def kind_of(names: ProgramNames, symbol: Symbol) -> str:
    """Return what a symbol is, in a few words: `state`, `array [2, 3]`, `parameter`."""
    if symbol.scope is not None:
        return f"argument of {_definition_name(names, symbol.scope)}"
    if symbol.kind == "label":
        inside = any(segment.label == symbol.name for segment in names.program.segments)
        return "label of a segment" if inside else "label"
    if symbol.kind == "system":
        return "system variable" if symbol.name != "j" else "imaginary unit"
    if symbol.kind == "library":
        return "library function"
    if symbol.kind != "variable":
        return symbol.kind.upper()
    uses = {place.use for place in names.of(symbol)}
    quantity = names.declared.quantities.get(symbol.name)
    if quantity is not None:
        what = "state" if quantity.is_state or "derivative" in uses else quantity.kind.name.lower()
        sizes = ", ".join("?" if size == UNKNOWN else str(size) for size in quantity.shape)
        return f"{what} array [{sizes}]" if sizes else what
    if "derivative" in uses:
        return "state"
    given = [place for place in names.of(symbol) if place.use == "assigned"]
    if any(place.start > names.dynamic for place in given):
        return "variable of the segment"
    if not given:
        return "name that nothing gives a value"
    read = any(place.start > names.dynamic for place in names.of(symbol))
    return "parameter" if read else "variable of the script"


def _own(names: ProgramNames, symbol: Symbol) -> str:
    parts = [f"`{symbol.name}` · *{kind_of(names, symbol)}*"]
    defined = names.definition(symbol)
    first = names.first_value(symbol)
    for place in dict.fromkeys(place for place in (defined, first) if place is not None):
        row = names.source.position(place.start).row
        code, remark = _definition_text(names, place)
        parts.append(f"```desire\n{code}\n```")
        if remark:
            parts.append(remark)
        parts[0] += f" · line {row}" if place is defined else ""
    return "\n\n".join(parts)


def _definition_text(names: ProgramNames, place: Occurrence) -> tuple[str, str]:
    """Return the statement that a place belongs to, a definition with its body; and the comment behind it."""
    source, read = names.source, names.statement(place.statement)
    if read is None:
        return source.line(source.position(place.start).row).strip()[:SHOWN_MAX], ""
    end = read.at + (read.tokens.ends[-1] if read.tokens.ends else 0)
    line_end = source.text.find("\n", end)
    rest = source.text[end : line_end if line_end >= 0 else len(source.text)]
    _, marked, remark = rest.partition("--")
    if isinstance(read.node, Procedure | Submodel) and place.symbol.scope is None:
        first = source.position(read.at).row
        rows = [source.line(row) for row in range(first, first + LINES_MAX)]
        closing = next((i for i, row in enumerate(rows) if row.split("--")[0].strip() == "end"), None)
        rows = [*rows[:closing], "end"] if closing is not None else [*rows, "…"]
        return "\n".join(row[:SHOWN_MAX] for row in rows), remark.strip() if marked else ""
    return source.text[read.at : end][:SHOWN_MAX], remark.strip() if marked else ""


def _definition_name(names: ProgramNames, scope: int) -> str:
    read = names.statement(scope)
    return " ".join(read.tokens.texts[:2]) if read is not None else "a definition"


def _value(names: ProgramNames, symbol: Symbol, values: Mapping[str, float]) -> str:
    if symbol.kind not in {"variable", "system"} or symbol.scope is not None:
        return ""
    told = []
    constant = names.declared.constants.get(symbol.name)
    in_segment = any(p.use != "read" and p.start > names.dynamic for p in names.of(symbol))
    if constant is not None:
        told.append(f"{'starts at' if in_segment else 'value'} {constant:.10g}")
    if symbol.name in values:
        told.append(f"after the last run {values[symbol.name]:.10g}")
    return ", ".join(told)
