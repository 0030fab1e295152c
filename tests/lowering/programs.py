"""Small helpers: a script's values without an interpreter, and a segment lowered with them."""

from __future__ import annotations

from desire_tui.engine.check.state_order import state_order
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import Values


def source(text: str) -> Source:
    return Source("\n".join(line.strip() for line in text.strip().splitlines()), "t.src")


def segment(body: str, *, functions: str = "", label: str | None = None, **names: object):
    """Lower `body`. Names are numbers, or shapes (tuples) of arrays."""
    program = parse(source(f"{functions}\nDYNAMIC\n{body}"))
    assert not program.problems, [d.message for d in program.problems]
    values = Values()
    for name in state_order(program):
        values.scalar(name, is_state=True)
    for name, value in names.items():
        if isinstance(value, tuple):
            values.array(name, value)
        else:
            values.assign(values.scalar(name).slot, float(value))
    return lower(program, label, values), values
