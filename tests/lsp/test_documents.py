"""Edits as clients send them, and places in units of their encodings, against plain slicing."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lsprotocol import types

from desire_tui.engine.source import Source, Span
from desire_tui.lsp.documents import Document
from desire_tui.lsp.positions import Places

ENCODINGS = {"utf-8": "utf-8", "utf-16": "utf-16-le", "utf-32": "utf-32-le"}
SIZES = {"utf-8": 1, "utf-16": 2, "utf-32": 4}
pieces = st.text(st.sampled_from("ab =|\n\r\f\u2028é𝜔\ud800"), max_size=12)


def _starts(text):
    """Offsets of rows by the protocol's definition of a row's end."""
    return [0, *(end.end() for end in re.finditer(r"\r\n|\r|\n", text))]


def _place(text, offset, encoding):
    starts = [start for start in _starts(text) if start <= offset]
    before = text[starts[-1] : offset].encode(ENCODINGS[encoding], "surrogatepass")
    return types.Position(len(starts) - 1, len(before) // SIZES[encoding])


def _splits_a_row_end(text, offset):
    return 0 < offset < len(text) and text[offset - 1 : offset + 1] == "\r\n"


@settings(deadline=None, max_examples=300)
@given(pieces, st.lists(st.tuples(st.integers(0, 12), st.integers(0, 12), pieces), max_size=4),
       st.sampled_from(sorted(ENCODINGS)))  # fmt: skip
def test_edits_do_to_a_document_what_slices_do_to_its_text(text, edits, encoding):
    document = Document("untitled:a", text, encoding)
    for a, b, new in edits:
        start, end = sorted((min(a, len(text)), min(b, len(text))))
        if _splits_a_row_end(text, start) or _splits_a_row_end(text, end):
            continue
        where = types.Range(_place(text, start, encoding), _place(text, end, encoding))
        document.change([types.TextDocumentContentChangePartial(range=where, text=new)])
        text = text[:start] + new + text[end:]
        assert document.snapshot.source.text == Source(text).text


@settings(deadline=None, max_examples=200)
@given(pieces, st.sampled_from(sorted(ENCODINGS)))
def test_offsets_and_places_are_the_same_thing(text, encoding):
    places = Places(Source(text), encoding)
    for offset in range(len(text) + 1):
        if _splits_a_row_end(text, offset):
            continue
        place = places.position(offset)
        assert place == _place(text, offset, encoding)
        assert places.offset(place) == offset


@pytest.mark.parametrize(
    ("line", "character", "offset"), [(0, 99, 4), (1, 99, 7), (9, 9, 7), (0, 1, 0), (0, 2, 1)]
)
def test_places_that_do_not_exist_are_the_nearest_that_do(line, character, offset):
    places = Places(Source("𝜔bcd\nef"), "utf-16")  # the first character is two units: 1 is its middle
    assert places.offset(types.Position(line, character)) == offset


def test_a_whole_text_may_take_the_place_of_another():
    document = Document("file:///tmp/a.src", "x = 1\n", "utf-16")
    document.change([types.TextDocumentContentChangeWholeDocument("y = 2\n")], 7)
    assert (document.snapshot.source.text, document.version, document.name) == ("y = 2\n", 7, "/tmp/a.src")


def test_ten_thousand_edits_at_once_cost_no_more_than_one_each():
    """What a rename of a name in every line sends: work that grows with the text for each would take minutes."""
    count = 10_000
    document = Document("untitled:a", "".join(f"d/dt x{i} = -k*x{i}\n" for i in range(count)), "utf-16")
    edits = []
    for row in range(count):
        at = len(f"d/dt x{row} = -")
        where = types.Range(types.Position(row, at), types.Position(row, at + 1))
        edits.append(types.TextDocumentContentChangePartial(range=where, text="rate"))
    document.change(edits)
    assert document.snapshot.source.text == "".join(f"d/dt x{i} = -rate*x{i}\n" for i in range(count))
    assert document.snapshot.places.range(Span(0, 4)).end == types.Position(0, 4)


def test_problems_of_a_text_that_was_edited_since_are_not_told(monkeypatch):
    from desire_tui.lsp.server import DesireServer

    server, told = DesireServer(), []
    monkeypatch.setattr(server, "text_document_publish_diagnostics", told.append)
    document = server.documents["untitled:a"] = Document("untitled:a", "x = 1\n", "utf-16", 1)
    document.change([types.TextDocumentContentChangeWholeDocument("y = 2\n")], 2)
    server._publish(document.number, 0, ())
    server._publish(document.number + 1, 1, ())
    assert told == []
    server._publish(document.number, 1, ())
    assert [one.version for one in told] == [2]
