"""Line numbers, as the original's editor saved them: `edit`, `keep+` and `list+` write them."""

from __future__ import annotations

from desire_tui.engine.syntax.parse import is_header, logical_lines


def with_numbers(text: str) -> str:
    """Return a program with its lines numbered by tens; parsed again, it is the same program.

    Lines that go on from the one above bear no number: it would be part of their expression. Neither do
    header lines, and a program that has numbers keeps them, for its `go to` and `restore`.
    """
    rows = text.removesuffix("\n").split("\n")
    bare = {at for at, row in enumerate(rows) if is_header(row)}
    for _, _, number, lines in logical_lines(text):
        if number is not None:
            return text if text.endswith("\n") else text + "\n"
        bare.update(lines[1:])
    width = len(str(10 * len(rows)))
    numbered = (
        f"{'' if at in bare else 10 * (at + 1):>{width}} {row}".rstrip() if not is_header(row) else row
        for at, row in enumerate(rows)
    )
    return "\n".join(numbered) + "\n"
