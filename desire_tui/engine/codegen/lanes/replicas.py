"""Vectors with an element for each run: the C library's functions are called so that no bit depends on the width."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.symbols import TWO_ARGUMENTS, lane_by_lane

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.text import IrText


class Replicas(Lanes):
    """As `Lanes`; `piece` 1: functions are those of a single run, called run by run.

    Else they are the vector library's for so many elements, whose last two bits may differ.
    """

    __slots__ = ("piece",)

    def __init__(self, text: IrText, width: int, piece: int) -> None:
        super().__init__(text, width)
        self.piece = piece

    def call_library(self, name: str, *args: str) -> str:
        """Call a function of the mathematical library for each run."""
        count = 2 if name in TWO_ARGUMENTS else 1
        kind = "double" if self.piece == 1 else f"<{self.piece} x double>"
        kinds = ", ".join([kind] * count)
        needs = self.text.declarations
        needs.add(f"declare {kind} @desire.{name}.{self.piece}({kinds}) #1")
        function = f"runs.{name}.{self.width}"
        if self.piece == 1:
            needs.add(lane_by_lane(name, self.width).replace(f"@desire.{name}.{self.width}(", f"@{function}("))
        else:
            needs.add(_in_pieces(name, count, self.width, self.piece, function))
        listed = ", ".join(f"{self.kind} {a}" for a in args)
        return self.text.op(f"call {self.kind} @{function}({listed})")

    def any(self, flags: str) -> str:
        """Return an i1: some flag is set."""
        bits = self.text.op(f"bitcast {self.flags} {flags} to i{self.width}")
        return self.text.op(f"icmp ne i{self.width} {bits}, 0")

    def both(self, a: str, b: str) -> str:
        """Return the flags that both have."""
        return self.text.op(f"and {self.flags} {a}, {b}")

    def either(self, a: str, b: str) -> str:
        """Return the flags that one of them has."""
        return self.text.op(f"or {self.flags} {a}, {b}")

    def but(self, a: str, b: str) -> str:
        """Return the flags of `a` that `b` does not have."""
        ones = f"splat (i1 true)"
        return self.both(a, self.text.op(f"xor {self.flags} {b}, {ones}"))

    def splat_flag(self, flag: str) -> str:
        """Return an i1 for every run."""
        one = self.text.op(f"insertelement {self.flags} poison, i1 {flag}, i64 0")
        zeros = f"<{self.width} x i32> zeroinitializer"
        return self.text.op(f"shufflevector {self.flags} {one}, {self.flags} poison, {zeros}")


def _in_pieces(name: str, count: int, width: int, piece: int, function: str) -> str:
    """Return the text of a function that calls the vector library's for parts of its arguments."""
    whole, part = f"<{width} x double>", f"<{piece} x double>"
    lines: list[str] = []
    parts: list[str] = []
    for first in range(0, width, piece):
        places = ", ".join(f"i32 {first + k}" for k in range(piece))
        listed = []
        for k in range(count):
            lines.append(f"%a{first}.{k} = shufflevector {whole} %x{k}, {whole} poison, <{piece} x i32> <{places}>")
            listed.append(f"{part} %a{first}.{k}")
        lines.append(f"%r{first} = call {part} @desire.{name}.{piece}({', '.join(listed)})")
        parts.append(f"%r{first}")
    size = piece
    while len(parts) > 1:
        kind = f"<{size} x double>"
        places = ", ".join(f"i32 {k}" for k in range(2 * size))
        joined = []
        for a, b in zip(parts[::2], parts[1::2], strict=True):
            made = f"%j{size}.{len(joined)}"
            lines.append(f"{made} = shufflevector {kind} {a}, {kind} {b}, <{2 * size} x i32> <{places}>")
            joined.append(made)
        parts, size = joined, 2 * size
    arguments = ", ".join(f"{whole} %x{k}" for k in range(count))
    body = "\n".join(lines)
    return f"define internal {whole} @{function}({arguments}) #1 {{\n{body}\nret {whole} {parts[0]}\n}}"
