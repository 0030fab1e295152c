"""Text pasted from a book or a word processor [X]: typographic characters count as their ASCII forms."""

from __future__ import annotations

_ASCII = {
    "\u2018": "'", "\u2019": "'", "\u201a": "'", "\u201b": "'", "\u201c": '"', "\u201d": '"', "\u201e": '"',
    "\u2010": "-", "\u2011": "-", "\u2012": "-", "\u2013": "-", "\u2212": "-", "\u00a0": " ", "\u2007": " ",
    "\u202f": " ", "\u2009": " ", "\u2002": " ", "\u2003": " ", "\ufeff": " ", "\u2028": " ", "\u00d7": "*",
    "\u2032": "'",
}  # fmt: skip


def normalised(text: str) -> str:
    """Return the text with ASCII forms, one for one so that offsets stay; strings' insides are left alone."""
    out: list[str] = []
    closing = ""
    comment = False
    for char in text:
        plain = _ASCII.get(char, char)
        if comment:
            comment = char != "\n"
            out.append(char)
        elif closing:
            ends = char in closing or (char == "\n" and not _is_joined(out))
            out.append(plain if ends else char)
            if ends:
                closing = ""
        else:
            if plain in "'\"":
                # An ASCII quote is closed by itself; a typographic one by any of its kind.
                closing = (
                    char if char == plain else "".join(c for c, p in _ASCII.items() if p == plain) + plain
                )
            elif plain == "-" and out and out[-1] == "-":
                comment = True
            out.append(plain)
    return "".join(out)


def _is_joined(before: list[str]) -> bool:
    """Whether a row goes on in the next one: it ends in `_`."""
    last = next((char for char in reversed(before) if char not in " \t\r"), "")
    return last == "_"
