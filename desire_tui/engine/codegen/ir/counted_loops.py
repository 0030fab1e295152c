"""Counted loops over elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.lanes import Lanes

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.ir.text import IrText


def loop(text: IrText, first: str, end: str, step: int, body: Callable[[str], None]) -> None:
    """Write `for i = first; i < end; i += step`; `body(i)` may contain blocks."""
    stem = text.fresh()
    before = f"{stem}.pre"
    text.jump(before)
    text.begin(before)
    text.jump(f"{stem}.head")
    text.begin(f"{stem}.head")
    text.do(f"%{stem}.i = phi i64 [ {first}, %{before} ], [ %{stem}.next, %{stem}.latch ]")
    text.branch(text.op(f"icmp slt i64 %{stem}.i, {end}"), f"{stem}.body", f"{stem}.done")
    text.begin(f"{stem}.body")
    body(f"%{stem}.i")
    text.jump(f"{stem}.latch")
    text.begin(f"{stem}.latch")
    text.do(f"%{stem}.next = add i64 %{stem}.i, {step}")
    text.jump(f"{stem}.head")
    text.begin(f"{stem}.done")


def elementwise(
    text: IrText, end: str, width: int, body: Callable[[Lanes, str], None], first: str = "0"
) -> None:
    """Write a loop over elements before `end`, `width` at a time, and one by one for what is left."""
    count = end if first == "0" else text.op(f"sub i64 {end}, {first}")
    rest = text.op(f"urem i64 {count}, {width}")
    main = text.op(f"sub i64 {end}, {rest}")
    wide, single = Lanes(text, width), Lanes(text)
    loop(text, first, main, width, lambda i: body(wide, i))
    loop(text, main, end, 1, lambda i: body(single, i))


def fetch(lanes: Lanes, base: str, index: str) -> str:
    """Read elements from `base[index]` on."""
    at = lanes.text.op(f"getelementptr double, ptr {base}, i64 {index}")
    return lanes.text.op(f"load {lanes.kind}, ptr {at}, align 8")


def put(lanes: Lanes, base: str, index: str, value: str) -> None:
    """Write elements from `base[index]` on."""
    at = lanes.text.op(f"getelementptr double, ptr {base}, i64 {index}")
    lanes.text.do(f"store {lanes.kind} {value}, ptr {at}, align 8")
