"""Whatever stands in an editor, every question about it has an answer, and no answer leads out of the text."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
from lsprotocol import types

from desire_tui.engine.session.static_check import StaticChecker
from desire_tui.engine.source import Source
from desire_tui.lsp import layout, navigation, running, semantic_tokens, words
from desire_tui.lsp.documents import Snapshot
from desire_tui.lsp.problems import diagnostics_of, fixes_of
from tests.strategies import broken_texts

URI = "untitled:a"


@settings(deadline=None, max_examples=150)
@given(broken_texts, st.integers(0, 30), st.integers(0, 30))
def test_every_question_has_an_answer(text, row, column):
    snapshot = Snapshot(Source(text), "utf-16", {"x": 1.0})
    place = types.Position(row, column)
    words.completions(snapshot, place)
    words.hover(snapshot, place)
    navigation.definition(snapshot, URI, place)
    navigation.declaration(snapshot, URI, place)
    navigation.highlights(snapshot, place)
    for found in navigation.references(snapshot, URI, place, with_declaration=False):
        assert snapshot.places.offset(found.range.end) <= len(text)
    for symbol in layout.symbols(snapshot):
        inner, outer = symbol.selection_range, symbol.range
        assert outer.start <= inner.start <= inner.end <= outer.end  # else VS Code refuses them all
    for fold in layout.folding(snapshot):
        assert fold.start_line < fold.end_line < len(snapshot.lines)
    running.lenses(snapshot, URI)
    problems = StaticChecker().check(snapshot.source, quick=True, seconds=None)
    fixes_of(diagnostics_of(problems, URI, snapshot), URI)


@settings(deadline=None, max_examples=150)
@given(broken_texts)
def test_colours_follow_each_other_within_their_rows(text):
    snapshot = Snapshot(Source(text), "utf-16", {})
    data = semantic_tokens.semantic_tokens(snapshot)
    row = column = end = 0
    for i in range(0, len(data), 5):
        rows, columns, length, kind, _ = data[i : i + 5]
        row, column, end = row + rows, (0 if rows else column) + columns, 0 if rows else end
        assert column >= end
        end = column + length
        assert 0 < end <= len(snapshot.lines[row].encode("utf-16-le", "surrogatepass")) // 2
        assert kind < len(semantic_tokens.LEGEND.token_types)
