"""Doubles one by one or as vectors: the same instructions over `double` or `<W x double>`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.text import literal

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.ir.text import IrText


class Lanes:
    """Writes elementwise instructions `width` elements wide into a text.

    Every operation is one IEEE 754 operation on each element: no fast-math flag, no contraction, so neither
    the width nor the optimiser's level changes a bit.
    """

    __slots__ = ("flags", "integers", "kind", "suffix", "text", "width")

    def __init__(self, text: IrText, width: int = 1) -> None:
        self.text = text
        self.width = width
        self.kind = "double" if width == 1 else f"<{width} x double>"
        self.integers = "i64" if width == 1 else f"<{width} x i64>"
        self.flags = "i1" if width == 1 else f"<{width} x i1>"
        self.suffix = "f64" if width == 1 else f"v{width}f64"

    def const(self, value: float) -> str:
        """Return a number in every lane."""
        return literal(value) if self.width == 1 else f"splat (double {literal(value)})"

    def integer(self, value: int) -> str:
        """Return a 64-bit integer in every lane."""
        return str(value) if self.width == 1 else f"splat (i64 {value})"

    def load_some(self, address: str, flags: str) -> str:
        """Return the numbers from an address on whose flags are set, by one instruction; others are 0.

        It takes longer than an ordinary one where what it reads was stored just now.
        """
        function = f"@llvm.masked.load.{self.suffix}.p0"
        self.text.declarations.add(f"declare {self.kind} {function}(ptr, i32, {self.flags}, {self.kind})")
        listed = f"ptr {address}, i32 8, {self.flags} {flags}, {self.kind} zeroinitializer"
        return self.text.op(f"call {self.kind} {function}({listed})")

    def store_some(self, value: str, address: str, flags: str) -> None:
        """Write the lanes whose flags are set from an address on, by one instruction."""
        function = f"@llvm.masked.store.{self.suffix}.p0"
        self.text.declarations.add(f"declare void {function}({self.kind}, ptr, i32, {self.flags})")
        self.text.do(f"call void {function}({self.kind} {value}, ptr {address}, i32 8, {self.flags} {flags})")

    def first_lanes(self, active: int | str) -> str:
        """Return flags that are set for the first lanes, `active` of them: a number, or a value."""
        if isinstance(active, int):
            return f"<{', '.join(f'i1 {lane < active:d}' for lane in range(self.width))}>"
        numbers = f"<{', '.join(f'i64 {lane}' for lane in range(self.width))}>"
        one = self.text.op(f"insertelement {self.integers} poison, i64 {active}, i64 0")
        zeros = f"<{self.width} x i32> zeroinitializer"
        every = self.text.op(f"shufflevector {self.integers} {one}, {self.integers} poison, {zeros}")
        return self.text.op(f"icmp ult {self.integers} {numbers}, {every}")

    def add(self, a: str, b: str) -> str:
        """Return a + b."""
        return self.text.op(f"fadd {self.kind} {a}, {b}")

    def sub(self, a: str, b: str) -> str:
        """Return a - b."""
        return self.text.op(f"fsub {self.kind} {a}, {b}")

    def mul(self, a: str, b: str) -> str:
        """Return a · b."""
        return self.text.op(f"fmul {self.kind} {a}, {b}")

    def div(self, a: str, b: str) -> str:
        """Return a / b."""
        return self.text.op(f"fdiv {self.kind} {a}, {b}")

    def neg(self, a: str) -> str:
        """Return -a."""
        return self.text.op(f"fneg {self.kind} {a}")

    def compare(self, relation: str, a: str, b: str) -> str:
        """Return the flags of `a relation b`; `ogt`, `olt` … are false where an operand is not a number."""
        return self.text.op(f"fcmp {relation} {self.kind} {a}, {b}")

    def choose(self, flags: str, yes: str, no: str) -> str:
        """Return yes where the flag is set, else no."""
        return self.text.op(f"select {self.flags} {flags}, {self.kind} {yes}, {self.kind} {no}")

    def any(self, flags: str) -> str:
        """Return an i1: some flag is set."""
        bits = self.text.op(f"bitcast {self.flags} {flags} to i{self.width}")
        return self.text.op(f"icmp ne i{self.width} {bits}, 0")

    def larger(self, a: str, b: str) -> str:
        """Return the larger one; b if a is not a number."""
        return self.choose(self.compare("ogt", a, b), a, b)

    def intrinsic(self, name: str, a: str) -> str:
        """Call an exactly defined function of LLVM's own: sqrt, fabs, round, trunc."""
        function = f"llvm.{name}.{self.suffix}"
        self.text.declarations.add(f"declare {self.kind} @{function}({self.kind})")
        return self.text.op(f"call {self.kind} @{function}({self.kind} {a})")

    def call_library(self, name: str, *args: str) -> str:
        """Call a function of the mathematical library, under a name that LLVM does not know.

        LLVM would rewrite `pow(x, 0.5)` and the like at some optimisation levels and not at others.
        """
        function = f"desire.{name}.{self.width}"
        kinds = ", ".join([self.kind] * len(args))
        self.text.declarations.add(f"declare {self.kind} @{function}({kinds}) #1")
        listed = ", ".join(f"{self.kind} {a}" for a in args)
        return self.text.op(f"call {self.kind} @{function}({listed})")

    def around(self, scalars: Sequence[str]) -> str:
        """Return scalar values that come round in the lanes; their number divides the width."""
        value = "poison"
        for lane, scalar in enumerate(scalars):
            value = self.text.op(f"insertelement {self.kind} {value}, double {scalar}, i64 {lane}")
        if len(scalars) == self.width:
            return value
        lanes = ", ".join(f"i32 {lane % len(scalars)}" for lane in range(self.width))
        return self.text.op(
            f"shufflevector {self.kind} {value}, {self.kind} poison, <{self.width} x i32> <{lanes}>"
        )

    def splat(self, scalar: str) -> str:
        """Return a scalar value in every lane."""
        if self.width == 1:
            return scalar
        one = self.text.op(f"insertelement {self.kind} poison, double {scalar}, i64 0")
        zeros = f"<{self.width} x i32> zeroinitializer"
        return self.text.op(f"shufflevector {self.kind} {one}, {self.kind} poison, {zeros}")
