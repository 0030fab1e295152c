"""Tables looked up for each element of a vector.

Of sixteen numbers with AVX-512: two registers, of which one instruction (`vpermi2pd`) picks eight elements.
Else four tables lie side by side in memory, and each element's row is loaded as a vector: gathering takes
twice as long.
"""

from __future__ import annotations

from hashlib import blake2b
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.text import literal
from desire_tui.engine.codegen.jit.compiler import machine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.ir.lanes import Lanes

SIZE = 16
_REGISTER = 8
_ROW = 4
_PICK = "llvm.x86.avx512.vpermi2var.pd.512"


def looked_up(lanes: Lanes, index: str, tables: Sequence[Sequence[float]]) -> list[str]:
    """Return, for each of four tables, table[index mod 16] for each element of the integers `index`."""
    if machine().width == _REGISTER and lanes.width % _REGISTER == 0:
        return [_picked(lanes, index, table) for table in tables]
    place = lanes.text.op(f"and {lanes.integers} {index}, {lanes.integer(SIZE - 1)}")
    return loaded_rows(lanes, place, list(zip(*tables, strict=True)))


def _picked(lanes: Lanes, index: str, table: Sequence[float]) -> str:
    text, part, whole = lanes.text, f"<{_REGISTER} x double>", f"<{_REGISTER} x i64>"
    text.declarations.add(f"declare {part} @{_PICK}({part}, {whole}, {part})")
    low, high = (_constant(table[first : first + _REGISTER]) for first in (0, _REGISTER))
    parts = []
    for first in range(0, lanes.width, _REGISTER):
        own = _shuffled(lanes, lanes.integers, index, "poison", range(first, first + _REGISTER))
        parts.append(text.op(f"call {part} @{_PICK}({part} {low}, {whole} {own}, {part} {high})"))
    return _joined(lanes, parts, _REGISTER)


def loaded_rows(lanes: Lanes, place: str, rows: Sequence[Sequence[float]]) -> list[str]:
    """Return, for each of the four numbers of a row, that of rows[place] for each element of `place`.

    A row is loaded for each element; four rows, or four pairs of rows side by side, are transposed at a time.
    """
    text, kind = lanes.text, f"<{_ROW} x double>"
    listed = ", ".join(f"{kind} {_constant(row)}" for row in rows)
    name = f"@table.{blake2b(listed.encode(), digest_size=6).hexdigest()}"
    text.declarations.add(f"{name} = internal constant [{len(rows)} x {kind}] [{listed}], align 64")
    loaded = []
    for offset in _offsets(lanes, place):
        at = text.op(f"getelementptr i8, ptr {name}, i64 {offset}")
        loaded.append(text.op(f"load {kind}, ptr {at}, align 32"))
    size = min(lanes.width, 2 * _ROW)
    found: list[list[str]] = [[] for _ in range(_ROW)]
    for first in range(0, lanes.width, size):
        own = [_joined(lanes, loaded[first + k : first + size : _ROW], _ROW) for k in range(_ROW)]
        for odd in (0, 1):
            a, b = (_mixed(lanes, own[k], own[k + 1], size, (odd, odd + 2), 1) for k in (0, 2))
            for half in (0, 2):
                found[odd + half].append(_mixed(lanes, a, b, size, (half,), 2))
    return [_joined(lanes, parts, size) for parts in found]


def _offsets(lanes: Lanes, place: str) -> list[str]:
    """Return 32·place as single integers, four of which leave the vector at a time."""
    text, width = lanes.text, lanes.width
    offsets = text.op(f"shl {lanes.integers} {place}, {lanes.integer(5)}")
    small = text.op(f"trunc {lanes.integers} {offsets} to <{width} x i16>")
    together = text.op(f"bitcast <{width} x i16> {small} to <{width // 4} x i64>")
    found = []
    for four in range(width // 4):
        left = text.op(f"extractelement <{width // 4} x i64> {together}, i64 {four}")
        for k in range(4):
            shifted = text.op(f"lshr i64 {left}, {16 * k}")
            found.append(text.op(f"and i64 {shifted}, 65535"))
    return found


def _mixed(lanes: Lanes, a: str, b: str, size: int, firsts: Sequence[int], count: int) -> str:
    """Return, of each four elements of a and b, `count` of a's and b's from each of `firsts` on."""
    places = [
        place + k
        for four in range(0, size, _ROW)
        for first in firsts
        for place in (four + first, size + four + first)
        for k in range(count)
    ]
    return _shuffled(lanes, f"<{size} x double>", a, b, places)


def _joined(lanes: Lanes, parts: list[str], size: int) -> str:
    while len(parts) > 1:
        kind, places = f"<{size} x double>", range(2 * size)
        parts = [_shuffled(lanes, kind, a, b, places) for a, b in zip(parts[::2], parts[1::2], strict=True)]
        size *= 2
    return parts[0]


def _shuffled(lanes: Lanes, kind: str, a: str, b: str, places: Sequence[int]) -> str:
    listed = ", ".join(f"i32 {place}" for place in places)
    return lanes.text.op(f"shufflevector {kind} {a}, {kind} {b}, <{len(places)} x i32> <{listed}>")


def _constant(values: Sequence[float]) -> str:
    return "<" + ", ".join(f"double {literal(value)}" for value in values) + ">"
