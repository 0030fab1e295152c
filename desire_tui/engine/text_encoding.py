"""How a text file's bytes stand for its characters. What is decoded here is encoded to the same bytes again.

Only what is certain is recognised: UTF-8, UTF-16 with a byte order mark, else one byte a character.
"""

from __future__ import annotations

from typing import NamedTuple


class NotText(ValueError):  # noqa: N818 - a statement about a file
    """These bytes are no text."""


class TextEncoding(NamedTuple):
    """An encoding, by the name that users see."""

    name: str
    codec: str
    mark: bytes = b""
    """The byte order mark in front of the text."""


UTF_8 = TextEncoding("UTF-8", "utf-8")
UTF_8_MARKED = TextEncoding("UTF-8 BOM", "utf-8", b"\xef\xbb\xbf")
UTF_16 = (
    TextEncoding("UTF-16 LE", "utf-16-le", b"\xff\xfe"),
    TextEncoding("UTF-16 BE", "utf-16-be", b"\xfe\xff"),
)
WINDOWS = TextEncoding("Windows-1252", "cp1252")
LATIN_1 = TextEncoding("Latin-1", "latin-1")
ENCODINGS = {each.name: each for each in (UTF_8, UTF_8_MARKED, *UTF_16, WINDOWS, LATIN_1)}

_WINDOWS_ONLY = bytes(range(0x80, 0xA0))
"""Control characters in Latin-1, quotation marks and the like in Windows-1252, but for five."""


def decode(data: bytes) -> tuple[str, TextEncoding]:
    """Return a file's text, and how it is encoded. NotText: it has null characters."""
    for encoding in (UTF_8_MARKED, *UTF_16, UTF_8):
        if data.startswith(encoding.mark):
            try:
                text = data[len(encoding.mark) :].decode(encoding.codec)
            except UnicodeDecodeError:
                continue
            if "\0" in text:
                continue
            return text, encoding
    if b"\0" in data:
        raise NotText
    if len(data.translate(None, _WINDOWS_ONLY)) < len(data):
        try:
            return data.decode(WINDOWS.codec), WINDOWS
        except UnicodeDecodeError:
            pass
    return data.decode(LATIN_1.codec), LATIN_1


def encode(text: str, encoding: TextEncoding) -> bytes:
    """Return a text's bytes. UnicodeEncodeError: the encoding has no such character."""
    return encoding.mark + text.encode(encoding.codec)


def is_kept(text: str, data: bytes) -> bool:
    """Whether `data` is read as `text`: bytes of one encoding may happen to be right in one tried before."""
    try:
        return decode(data)[0] == text
    except NotText:
        return False
