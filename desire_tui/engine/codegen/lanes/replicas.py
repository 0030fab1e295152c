"""Vectors with an element for each run; library functions are called so that the width changes no bit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.exact_functions.compiled import exact_function, widest
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.symbols import TWO_ARGUMENTS, lane_by_lane

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.text import IrText


class Replicas(Lanes):
    """As `Lanes`; `piece` 1: functions are those of a single run, called run by run.

    Else they are the vector library's for so many elements, whose last two bits may differ.
    """

    __slots__ = ("piece", "together")

    def __init__(self, text: IrText, width: int, piece: int, *, together: bool = False) -> None:
        """`together`: of many arguments both sine and cosine are wanted, which one call gives for less."""
        super().__init__(text, width)
        self.piece = piece
        self.together = together and piece == 1

    def call_library(self, name: str, *args: str) -> str:
        """Call a function of the mathematical library for each run."""
        exact = self._exact(name, args) if self.piece == 1 else None
        if exact is not None:
            return exact
        if self.together and name in ("sin", "cos"):
            return self._sine_or_cosine(name, args[0])
        count = 2 if name in TWO_ARGUMENTS else 1
        kind = "double" if self.piece == 1 else f"<{self.piece} x double>"
        kinds = ", ".join([kind] * count)
        needs = self.text.declarations
        needs.add(f"declare {kind} @desire.{name}.{self.piece}({kinds}) #1")
        function = f"runs.{name}.{self.width}.{self.piece}"
        if self.piece == 1:
            needs.add(
                lane_by_lane(name, self.width).replace(f"@desire.{name}.{self.width}(", f"@{function}(")
            )
        else:
            needs.add(_in_pieces(name, count, self.width, self.piece, function))
        listed = ", ".join(f"{self.kind} {a}" for a in args)
        return self.text.op(f"call {self.kind} @{function}({listed})")

    def _exact(self, name: str, args: tuple[str, ...]) -> str | None:
        """Call a function of vectors with the library's bits, as often as it takes; None: there is none."""
        both = self.together and name in ("sin", "cos")
        size = min(self.width, widest(name))
        function = exact_function("sincos" if both else name, size)
        if function is None:
            return None
        part = f"<{size} x double>"
        kind = f"{{ {part}, {part} }}" if both else part
        self.text.declarations.add(f"declare {kind} @{function.symbol}({part}) #1")
        found = []
        for first in range(0, self.width, size):
            x = self._places(self.kind, args[0], "poison", range(first, first + size))
            value = self.text.op(f"call {kind} @{function.symbol}({part} {x})")
            if both:
                value = self.text.op(f"extractvalue {kind} {value}, {int(name == 'cos')}")
            found.append(value)
        while len(found) > 1:
            part, places = f"<{size} x double>", range(2 * size)
            found = [self._places(part, a, b, places) for a, b in zip(found[::2], found[1::2], strict=True)]
            size *= 2
        return found[0]

    def _places(self, kind: str, a: str, b: str, places: range) -> str:
        """Return a vector of elements of two."""
        listed = ", ".join(f"i32 {place}" for place in places)
        return self.text.op(f"shufflevector {kind} {a}, {kind} {b}, <{len(places)} x i32> <{listed}>")

    def _sine_or_cosine(self, name: str, x: str) -> str:
        """Ask for both: LLVM leaves one of two calls with the same argument away."""
        self.text.declarations.update((_SINCOS, _both_for_each(self.width)))
        pair = f"{{ {self.kind}, {self.kind} }}"
        both = self.text.op(f"call {pair} @runs.sincos.{self.width}({self.kind} {x})")
        return self.text.op(f"extractvalue {pair} {both}, {0 if name == 'sin' else 1}")

    def both(self, a: str, b: str) -> str:
        """Return the flags that both have."""
        return self.text.op(f"and {self.flags} {a}, {b}")

    def either(self, a: str, b: str) -> str:
        """Return the flags that one of them has."""
        return self.text.op(f"or {self.flags} {a}, {b}")

    def but(self, a: str, b: str) -> str:
        """Return the flags of `a` that `b` does not have."""
        ones = "splat (i1 true)"
        return self.both(a, self.text.op(f"xor {self.flags} {b}, {ones}"))

    def splat_flag(self, flag: str) -> str:
        """Return an i1 for every run."""
        one = self.text.op(f"insertelement {self.flags} poison, i1 {flag}, i64 0")
        zeros = f"<{self.width} x i32> zeroinitializer"
        return self.text.op(f"shufflevector {self.flags} {one}, {self.flags} poison, {zeros}")


_SINCOS = "declare void @desire.sincos.1(double, ptr, ptr) nounwind"


def _both_for_each(width: int) -> str:
    """Return the text of a function that calls the library's `sincos` for each element."""
    kind = f"<{width} x double>"
    lines = [f"%s = alloca {kind}", f"%c = alloca {kind}"]
    for lane in range(width):
        lines.append(f"%x{lane} = extractelement {kind} %x, i64 {lane}")
        lines += [f"%{at}{lane} = getelementptr double, ptr %{at}, i64 {lane}" for at in "sc"]
        lines.append(f"call void @desire.sincos.1(double %x{lane}, ptr %s{lane}, ptr %c{lane})")
    lines += [f"%{at}.all = load {kind}, ptr %{at}" for at in "sc"]
    pair = f"{{ {kind}, {kind} }}"
    lines += [
        f"%first = insertvalue {pair} poison, {kind} %s.all, 0",
        f"%both = insertvalue {pair} %first, {kind} %c.all, 1",
        f"ret {pair} %both",
    ]
    head = f"define internal {pair} @runs.sincos.{width}({kind} %x) noinline #1"
    return f"{head} {{\n" + "\n".join(lines) + "\n}"


def _in_pieces(name: str, count: int, width: int, piece: int, function: str) -> str:
    """Return the text of a function that calls the vector library's for parts of its arguments."""
    whole, part = f"<{width} x double>", f"<{piece} x double>"
    lines: list[str] = []
    parts: list[str] = []
    for first in range(0, width, piece):
        places = ", ".join(f"i32 {first + k}" for k in range(piece))
        listed = []
        for k in range(count):
            lines.append(
                f"%a{first}.{k} = shufflevector {whole} %x{k}, {whole} poison, <{piece} x i32> <{places}>"
            )
            listed.append(f"{part} %a{first}.{k}")
        lines.append(f"%r{first} = call {part} @desire.{name}.{piece}({', '.join(listed)})")
        parts.append(f"%r{first}")
    size = piece
    while len(parts) > 1:
        kind = f"<{size} x double>"
        places = ", ".join(f"i32 {k}" for k in range(2 * size))
        joined: list[str] = []
        for a, b in zip(parts[::2], parts[1::2], strict=True):
            made = f"%j{size}.{len(joined)}"
            lines.append(f"{made} = shufflevector {kind} {a}, {kind} {b}, <{2 * size} x i32> <{places}>")
            joined.append(made)
        parts, size = joined, 2 * size
    arguments = ", ".join(f"{whole} %x{k}" for k in range(count))
    body = "\n".join(lines)
    return f"define internal {whole} @{function}({arguments}) #1 {{\n{body}\nret {whole} {parts[0]}\n}}"
