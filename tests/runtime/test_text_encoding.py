"""What is read as text is written as the same bytes again."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import desire_tui
from desire_tui.engine.text_encoding import NotText, decode, encode

KNOWN = [
    (b"", "", "UTF-8"),
    ("grün ∞".encode(), "grün ∞", "UTF-8"),
    (b"\xef\xbb\xbfx", "x", "UTF-8 BOM"),
    (b"\xff\xfe" + "x∞".encode("utf-16-le"), "x∞", "UTF-16 LE"),
    (b"\xfe\xff" + "x\U0001f600".encode("utf-16-be"), "x\U0001f600", "UTF-16 BE"),
    (b"gr\xfcn", "grün", "Latin-1"),
    (b"\x93gr\xfcn\x94 \x80", "“grün” €", "Windows-1252"),
    (b"\x93\x81", "\x93\x81", "Latin-1"),
    (b"\xff\xfex", "ÿþx", "Latin-1"),  # half a character: no UTF-16
    (b"\xef\xbb\xbfgr\xfcn", "ï»¿grün", "Latin-1"),
]


@pytest.mark.parametrize(("data", "text", "name"), KNOWN)
def test_encodings_are_recognised(data, text, name):
    found, encoding = decode(data)
    assert (found, encoding.name) == (text, name)
    assert encode(found, encoding) == data


@pytest.mark.parametrize("data", [b"a\0b", b"\xff\xfe\0\0a\0\0\0", b"\xff\xfea\0\0", b"\x7fELF\0"])
def test_null_characters_are_in_no_text(data):
    with pytest.raises(NotText):
        decode(data)


@given(st.binary() | st.text().map(lambda text: text.encode("utf-16", "surrogatepass")))
def test_whatever_is_read_is_written_as_the_same_bytes(data):
    try:
        text, encoding = decode(data)
    except NotText:
        assert b"\0" in data
        return
    assert encode(text, encoding) == data


@pytest.mark.parametrize("codec", ["utf-8", "utf-8-sig", "utf-16", "cp1252", "latin-1"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_programs_are_read_in_every_encoding_and_with_all_line_ends(tmp_path, codec, end):
    path = tmp_path / "a.src"
    path.write_bytes(end.join(("-- grün", "x = 1", "y = nix", "")).encode(codec))
    (problem,) = desire_tui.run(path).problems
    assert (problem.line, problem.column) == (3, 5)
