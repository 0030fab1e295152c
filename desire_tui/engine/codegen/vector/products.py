"""Sums over products as functions that pieces carry with them: dot, matrix times vector, largest element.

Sums run in eight lanes whatever the machine has, so that they are the same everywhere; rows are taken four at
a time.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.ir.counted_loops import fetch, loop, put
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.text import IrText

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.lowered.expressions import MatVec

_LANES = 8
_ROWS = 4
ROWS = 8
"""Elements of a product that are computed side by side, at most: a cache line."""


def _function(kind: str, name: str, parameters: str, text: IrText, memory: str) -> str:
    head = f"define internal {kind} @{name}({parameters}) nounwind willreturn memory({memory})"
    return f"{head} {{\n{text.body()}\n}}"


def _accumulators(text: IrText, lanes: Lanes, count: int) -> list[str]:
    cells = [text.alloca(lanes.kind) for _ in range(count)]
    for cell in cells:
        text.do(f"store {lanes.kind} zeroinitializer, ptr {cell}")
    return cells


def _accumulate(lanes: Lanes, cell: str, value: str) -> None:
    text = lanes.text
    text.do(f"store {lanes.kind} {lanes.add(text.op(f'load {lanes.kind}, ptr {cell}'), value)}, ptr {cell}")


def _sum_of_lanes(wide: Lanes, cell: str) -> str:
    """Sum of the lanes, in pairs."""
    text, single = wide.text, Lanes(wide.text)
    total = text.op(f"load {wide.kind}, ptr {cell}")
    parts = [text.op(f"extractelement {wide.kind} {total}, i64 {lane}") for lane in range(wide.width)]
    while len(parts) > 1:
        parts = [single.add(parts[i], parts[i + 1]) for i in range(0, len(parts), 2)]
    return parts[0]


def _write_rows(text: IrText, first: str, rows: int) -> None:
    """Write y[first …] for so many rows side by side."""
    wide, single = Lanes(text, _LANES), Lanes(text)
    bases = []
    for q in range(rows):
        row = text.op(f"add i64 {first}, {q}")
        bases.append(text.op(f"getelementptr double, ptr %a, i64 {text.op(f'mul i64 {row}, %cols')}"))
    cells = [text.alloca(wide.kind) for _ in bases]
    sums = [text.alloca("double") for _ in bases]
    for cell in cells:
        text.do(f"store {wide.kind} zeroinitializer, ptr {cell}")

    def wide_step(k: str) -> None:
        x = fetch(wide, "%x", k)
        for base, cell in zip(bases, cells, strict=True):
            _accumulate(wide, cell, wide.mul(fetch(wide, base, k), x))

    def single_step(k: str) -> None:
        x = fetch(single, "%x", k)
        for base, cell in zip(bases, sums, strict=True):
            _accumulate(single, cell, single.mul(fetch(single, base, k), x))

    loop(text, "0", "%main", _LANES, wide_step)
    for cell, total in zip(cells, sums, strict=True):
        text.do(f"store double {_sum_of_lanes(wide, cell)}, ptr {total}")
    loop(text, "%main", "%cols", 1, single_step)
    for q, total in enumerate(sums):
        put(single, "%y", text.op(f"add i64 {first}, {q}"), text.op(f"load double, ptr {total}"))


@functools.cache
def matrix_times_vector() -> str:
    """Return `void @matvec(a, x, y, rows, cols)`: y = A·x."""
    text = IrText()
    text.do(f"%rest = urem i64 %cols, {_LANES}")
    text.do("%main = sub i64 %cols, %rest")
    text.do(f"%some = urem i64 %rows, {_ROWS}")
    text.do("%fours = sub i64 %rows, %some")
    loop(text, "0", "%fours", _ROWS, lambda r: _write_rows(text, r, _ROWS))
    loop(text, "%fours", "%rows", 1, lambda r: _write_rows(text, r, 1))
    text.do("ret void")
    parameters = "ptr noalias readonly %a, ptr noalias readonly %x, ptr noalias %y, i64 %rows, i64 %cols"
    return _function("void", "matvec", parameters, text, "argmem: readwrite")


@functools.cache
def transposed_times_vector() -> str:
    """Return `void @tmatvec(a, x, y, rows, cols, first, end)`: these elements of y = Aᵀ·x."""
    text = IrText()
    wide, single = Lanes(text, _LANES), Lanes(text)
    text.do("%all = sub i64 %end, %first")
    text.do(f"%rest = urem i64 %all, {_LANES}")
    text.do("%main = sub i64 %end, %rest")

    def columns(lanes: Lanes, k: str) -> None:
        total = text.alloca(lanes.kind)
        text.do(f"store {lanes.kind} zeroinitializer, ptr {total}")

        def one(i: str) -> None:
            at = text.op(f"add i64 {text.op(f'mul i64 {i}, %cols')}, {k}")
            x = lanes.splat(fetch(single, "%x", i))
            _accumulate(lanes, total, lanes.mul(fetch(lanes, "%a", at), x))

        loop(text, "0", "%rows", 1, one)
        put(lanes, "%y", k, text.op(f"load {lanes.kind}, ptr {total}"))

    loop(text, "%first", "%main", _LANES, lambda k: columns(wide, k))
    loop(text, "%main", "%end", 1, lambda k: columns(single, k))
    text.do("ret void")
    arrays = "ptr noalias readonly %a, ptr noalias readonly %x, ptr noalias %y"
    parameters = f"{arrays}, i64 %rows, i64 %cols, i64 %first, i64 %end"
    return _function("void", "tmatvec", parameters, text, "argmem: readwrite")


def write_product(text: IrText, node: MatVec, a: str, x: str, result: str, first: str, end: str) -> None:
    """Write the elements from `first` to before `end` of A·x or Aᵀ·x."""
    if node.transposed:
        text.declarations.add(transposed_times_vector())
        sizes = f"i64 {node.rows}, i64 {node.cols}, i64 {first}, i64 {end}"
        text.do(f"call void @tmatvec(ptr {a}, ptr {x}, ptr {result}, {sizes})")
        return
    text.declarations.add(matrix_times_vector())
    at = text.op(f"getelementptr double, ptr {a}, i64 {text.op(f'mul i64 {first}, {node.cols}')}")
    to = text.op(f"getelementptr double, ptr {result}, i64 {first}")
    sizes = f"i64 {text.op(f'sub i64 {end}, {first}')}, i64 {node.cols}"
    text.do(f"call void @matvec(ptr {at}, ptr {x}, ptr {to}, {sizes})")


def _reduction(name: str, arrays: Sequence[str]) -> str:
    """Return `double @name(arrays…, n)`: the sum of the products of the arrays' elements."""
    text = IrText()
    wide, single = Lanes(text, _LANES), Lanes(text)
    text.do(f"%rest = urem i64 %n, {2 * _LANES}")
    text.do("%main = sub i64 %n, %rest")
    first, second = _accumulators(text, wide, 2)
    (total,) = _accumulators(text, single, 1)

    def product(lanes: Lanes, i: str) -> str:
        parts = [fetch(lanes, f"%{array}", i) for array in arrays]
        return lanes.mul(*parts) if len(parts) == 2 else parts[0]

    def both(i: str) -> None:
        _accumulate(wide, first, product(wide, i))
        _accumulate(wide, second, product(wide, text.op(f"add i64 {i}, {_LANES}")))

    loop(text, "0", "%main", 2 * _LANES, both)
    _accumulate(wide, first, text.op(f"load {wide.kind}, ptr {second}"))
    text.do(f"store double {_sum_of_lanes(wide, first)}, ptr {total}")
    loop(text, "%main", "%n", 1, lambda i: _accumulate(single, total, product(single, i)))
    text.do(f"ret double {text.op(f'load double, ptr {total}')}")
    parameters = ", ".join((*(f"ptr readonly %{array}" for array in arrays), "i64 %n"))
    return _function("double", name, parameters, text, "argmem: read")


@functools.cache
def dot() -> str:
    """Return `double @dot(u, w, n)`."""
    return _reduction("dot", ("u", "w"))


@functools.cache
def total() -> str:
    """Return `double @total(u, n)`: the sum of the elements."""
    return _reduction("total", ("u",))


@functools.cache
def largest() -> str:
    """Return `void @largest(x, y, n)`: y is x at its largest element (ties: the last; nan wins), else 0."""
    text = IrText()
    single = Lanes(text)
    most, where = text.alloca("double"), text.alloca("i64")
    text.do(f"store double {fetch(single, '%x', '0')}, ptr {most}")
    text.do(f"store i64 0, ptr {where}")

    def look(i: str) -> None:
        value = fetch(single, "%x", i)
        before = text.op(f"load double, ptr {most}")
        wins = text.op(f"or i1 {single.compare('oge', value, before)}, {single.compare('uno', value, value)}")
        text.do(f"store double {single.choose(wins, value, before)}, ptr {most}")
        place = text.op(f"load i64, ptr {where}")
        text.do(f"store i64 {text.op(f'select i1 {wins}, i64 {i}, i64 {place}')}, ptr {where}")

    loop(text, "1", "%n", 1, look)
    loop(text, "0", "%n", 1, lambda i: put(single, "%y", i, single.const(0.0)))
    put(single, "%y", text.op(f"load i64, ptr {where}"), text.op(f"load double, ptr {most}"))
    text.do("ret void")
    parameters = "ptr noalias readonly %x, ptr noalias %y, i64 %n"
    return _function("void", "largest", parameters, text, "argmem: readwrite")
