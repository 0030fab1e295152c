"""A strip of neighbouring elements, one vector wide, of the loop over an array statement."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.counted_loops import loop
from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.ir.lanes import Lanes


@dataclass(frozen=True, slots=True)
class Strip:
    """Elements `index` … `index + active - 1` (an LLVM value), of a row where there are rows.

    `active` < the width: only so many lanes are real. `edge`: a shifted operand may reach outside.
    `masked`: a strip that is not full is moved by one instruction, which is short but not always quick.
    `row`, `column`: of the first element, where the statement has rows; the strip stays in its row.
    """

    lanes: Lanes
    index: str
    active: int
    edge: bool = False
    masked: bool = False
    row: str = ""
    column: str = ""

    def fetch(self, base: str, index: str | None = None) -> str:
        """Read the strip's elements of the array at `base`; lanes that are not active hold 0."""
        lanes, text = self.lanes, self.lanes.text
        at = text.op(f"getelementptr double, ptr {base}, i64 {self.index if index is None else index}")
        if self.active == lanes.width:
            return text.op(f"load {lanes.kind}, ptr {at}, align 8")
        if self.masked:
            return lanes.load_some(at, lanes.first_lanes(self.active))
        result = "zeroinitializer"
        for lane in range(self.active):
            one = at if lane == 0 else text.op(f"getelementptr double, ptr {at}, i64 {lane}")
            value = text.op(f"load double, ptr {one}")
            result = text.op(f"insertelement {lanes.kind} {result}, double {value}, i64 {lane}")
        return result

    def fetch_shifted(self, base: str, by: int, count: int) -> str:
        """Read x[i + by], 0 outside 0 … count - 1."""
        lanes, text = self.lanes, self.lanes.text
        index = text.op(f"add i64 {self.index}, {by}")
        if not self.edge:
            return self.fetch(base, index)
        assert self.active == 1
        inside = text.op(f"icmp ult i64 {index}, {count}")
        safe = text.op(f"select i1 {inside}, i64 {index}, i64 0")
        at = text.op(f"getelementptr double, ptr {base}, i64 {safe}")
        value = text.op(f"select i1 {inside}, double {text.op(f'load double, ptr {at}')}, double 0.0")
        return text.op(f"insertelement {lanes.kind} zeroinitializer, double {value}, i64 0")

    def put(self, base: str, value: str) -> None:
        """Write the strip's elements of the array at `base`."""
        lanes, text = self.lanes, self.lanes.text
        at = text.op(f"getelementptr double, ptr {base}, i64 {self.index}")
        if self.active == lanes.width:
            text.do(f"store {lanes.kind} {value}, ptr {at}, align 8")
            return
        if self.masked:
            lanes.store_some(value, at, lanes.first_lanes(self.active))
            return
        for lane in range(self.active):
            one = at if lane == 0 else text.op(f"getelementptr double, ptr {at}, i64 {lane}")
            part = text.op(f"extractelement {lanes.kind} {value}, i64 {lane}")
            text.do(f"store double {part}, ptr {one}")


def sweep_block(wide: Lanes, count: int, below: int, above: int, body: Callable[[Strip], None]) -> None:
    """Write a loop over the elements %first … %end - 1 of `count`; %first is a multiple of the width.

    The first `below` and last `above` of all reach outside operands. Numbers do not depend on where a block
    begins: functions of vectors give each element its own.
    """
    text, width = wide.text, wide.width

    def either(relation: str, a: str, b: str) -> str:
        return text.op(f"select i1 {text.op(f'icmp {relation} i64 {a}, {b}')}, i64 {a}, i64 {b}")

    if not (below or above):  # all strips begin at multiples of the width: operands may come round with it
        whole = count // width * width
        loop(text, "%first", either("slt", "%end", str(whole)), width, lambda i: body(Strip(wide, i, width)))
        if count > whole:
            last = either("sgt", "%first", str(whole))
            loop(text, last, "%end", width, lambda i: body(Strip(wide, i, count - whole)))
        return
    low = min(below, count)
    high = max(count - above, low)
    loop(text, "%first", either("slt", "%end", str(low)), 1, lambda i: body(Strip(wide, i, 1, edge=True)))
    first, end = either("sgt", "%first", str(low)), either("slt", "%end", str(high))
    length = text.op(f"sub i64 {end}, {first}")
    full = text.op(f"sub i64 {end}, {text.op(f'srem i64 {length}, {width}')}")
    loop(text, first, full, width, lambda i: body(Strip(wide, i, width)))
    loop(text, full, end, 1, lambda i: body(Strip(wide, i, 1)))
    last = either("sgt", "%first", str(high))
    loop(text, last, "%end", 1, lambda i: body(Strip(wide, i, 1, edge=True)))
