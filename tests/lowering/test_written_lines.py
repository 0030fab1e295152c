"""Lines that differ in names and numbers only: what their words lower to is what their nodes lower to."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from desire_tui.engine.codegen.scalar import rerolling, templates
from desire_tui.engine.lowered.effects import memory, reads
from desire_tui.engine.lowered.expressions import Op
from desire_tui.engine.lowered.statements import Deriv
from desire_tui.engine.lowered.walk import walk_values
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.segment import Derivative
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.syntax.parsed_lines import forget_lines
from desire_tui.engine.values import Values
from tests.lowering.test_lowering_cache import outcome
from tests.lowering.test_plain_lines import ordinary

SHAPES = (
    "d/dt x{k} = a*(x{j} - x{k})", "d/dt x{k} = -x{j}*{j} + .{k}", "d/dt x{k} = - -{k}*x{j} - +b/-{j}",
    "u{k} = x{j}/{j} - a", "v{k} = -(a + u{j})*-0 + x{k}", "x{k}' = b - -+-{k}.5e1", "u{k} = u{k} + 1",
)  # fmt: skip


def _program(shapes, odd=""):
    lines = [shapes[k % len(shapes)].format(k=k, j=(7 * k + 3) % 40) for k in range(40)]
    return "\n".join([*(f"x{k} = 0" for k in range(40)), "a = 1 | b = 2", "drun", "DYNAMIC", *lines, odd, ""])


def _parts_made(statement):
    """Which of its parts a statement holds."""
    kind = type(statement)
    made = []
    for part in (kind.target, kind.value):
        try:
            part.__get__(statement)
        except AttributeError:
            continue
        made.append(part.__name__)
    return made


@settings(max_examples=15)
@given(
    st.lists(st.sampled_from(SHAPES), min_size=1, max_size=4),
    st.sampled_from(("", "d/dt q = zz*a", "u3 = v39")),
)
def test_words_come_to_what_nodes_come_to(shapes, odd):
    text = _program(shapes, odd)
    parse(Source(text))  # the forms are known from here on
    expected = ordinary(text, ["a", "b"], set())
    assert outcome(text, ["a", "b"], set()) == expected
    assert outcome(text, ["a", "b"], set()) == expected


def test_no_node_is_made_until_somebody_asks():
    text = _program(["d/dt x{k} = a*(x{j} - x{k})", "x{k}' = -x{j}*{j} + .{k}", "d/dt x{k} = x{j}*-0 - -{k}"])
    forget_lines()  # and the parts that others asked for
    program = parse(Source(text))
    values = Values()
    for name in ("a", "b"):
        values.assign(values.scalar(name).slot, 1.0)
    segment = lower(program, None, values)
    last = program.segments[0].body[36].node
    assert isinstance(last, Derivative)
    assert last.form is not None
    assert not _parts_made(last)
    lazy = [action.value for action in segment.body if isinstance(action.value, Op) and action.value.outline]
    assert len(lazy) > 20
    for value in lazy:
        read = [*reads(Deriv(0, value, None))]
        assert read == [piece for node in walk_values(value) for piece in memory(node)]
        key, leaves = [], []
        by_columns = value.outline.key, [*value.leaves]
        templates.shape(value, key, leaves)
        assert (tuple(key), repr(leaves)) == (by_columns[0], repr(by_columns[1]))
        assert rerolling.plain_shape(segment.body[0]) is not None
    assert last.target.name == "x36"
    assert _parts_made(last) == ["target"]
    assert last.value.left.name == "a"
    assert _parts_made(last) == ["target", "value"]


@pytest.mark.parametrize("kind", [Assign, Derivative])
def test_statements_without_a_form_lack_nothing(kind):
    statement = kind(None, None, 1, 2)
    assert statement.form is None
    assert statement == kind(None, None)
    with pytest.raises(AttributeError, match="words"):
        _ = statement.words
    with pytest.raises(AttributeError, match="nonsense"):
        _ = statement.nonsense
