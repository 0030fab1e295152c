"""Parsed statements are kept by their text; statements of one shape share one derivation."""

from __future__ import annotations

import pytest

from desire_tui.engine.source import Source
from desire_tui.engine.syntax import shapes
from desire_tui.engine.syntax.automaton import derive
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.syntax.parsed_lines import forget_lines


@pytest.fixture
def derived(monkeypatch):
    """Texts of the statements for which the grammar was asked."""
    asked: list[str] = []

    def counting(kinds, texts):
        asked.append(" ".join(texts))
        return derive(kinds, texts)

    monkeypatch.setattr(shapes, "derive", counting)
    forget_lines()
    shapes.forget()
    return asked


def ladder(n: int) -> str:
    lines = ["DYNAMIC"]
    for k in range(1, n + 1):
        lines += [f"d/dt v{k} = a*(i{k} - i{k + 1})", f"d/dt i{k} = {k}.5*(v{k - 1} - v{k})"]
    return "\n".join(lines)


def test_a_ladder_has_two_shapes(derived) -> None:
    program = parse(Source(ladder(100)))
    assert len(program.segments[0].body) == 200
    assert derived == ["DYNAMIC", "d/dt v1 = a * ( i1 - i2 )", "d/dt i1 = 1.5 * ( v0 - v1 )"]


def test_an_edit_leaves_all_other_nodes_alone() -> None:
    text = ladder(50)
    before = parse(Source(text)).segments[0].body
    after = (
        parse(Source("-- a new first line\n" + text.replace("i10 = 10.5", "i10 = 2*10.5"))).segments[0].body
    )
    changed = [i for i, (old, new) in enumerate(zip(before, after, strict=True)) if old.node is not new.node]
    assert changed == [19]
    assert all(new.at - old.at == 20 for old, new in zip(before[:19], after[:19], strict=True))


def test_a_reused_statement_is_placed_anew() -> None:
    text = "x = y3\nx = y3\n  x = y3"
    program = parse(Source(text))
    assert [p.at for p in program.script] == [0, 7, 16]
    assert [text[slice(*p.span(p.node.value))] for p in program.script] == ["y3"] * 3
