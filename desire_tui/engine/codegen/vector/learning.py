"""CLEARN, PLEARN and INTP as functions that pieces carry with them (docs/neural.md)."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.codegen.ir.counted_loops import fetch, loop, put
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.vector import products

if TYPE_CHECKING:
    from desire_tui.engine.codegen.vector.operands import ArrayOperands
    from desire_tui.engine.lowered.statements import LearningStep

_INFINITY = float("inf")


def write_learning(statements: ArrayOperands, action: LearningStep) -> None:
    """Write one learning step as a call."""
    text = statements.text
    rows, cols = action.out_count, action.in_count
    rate = statements.scalars.value(action.rate)
    out, weights, x = (statements.at(s) for s in (action.out_slot, action.weights_slot, action.in_slot))
    sizes = f"i64 {rows}, i64 {cols}, double {rate}"
    match action.kind:
        case "CLEARN":
            criterion = "0.0" if action.criterion is None else statements.scalars.value(action.criterion)
            wins = "null" if action.count_slot is None else statements.at(action.count_slot)
            text.declarations.add(_compete())
            arrays = f"ptr {out}, ptr {weights}, ptr {x}"
            found = text.op(f"call double @compete({arrays}, {sizes}, double {criterion}, ptr {wins})")
            if action.full_slot is not None:
                text.do(f"store double {found}, ptr {statements.at(action.full_slot)}")
        case "INTP":
            _write_product(statements, action, out, weights, x)
            text.declarations.add(_threshold())
            text.do(f"call void @threshold(ptr {out}, i64 {rows}, double {rate})")
        case "PLEARN":
            _write_product(statements, action, out, weights, x)
            text.declarations.add(_sanger())
            rest = statements.temp(cols)
            text.do(f"call void @sanger(ptr {out}, ptr {weights}, ptr {x}, {sizes}, ptr {rest})")
        case _:
            assert_never(action.kind)


def _write_product(statements: ArrayOperands, action: LearningStep, out: str, weights: str, x: str) -> None:
    """Write v = W·x."""
    text = statements.text
    text.declarations.add(products.matrix_times_vector())
    sizes = f"i64 {action.out_count}, i64 {action.in_count}"
    text.do(f"call void @matvec(ptr {weights}, ptr {x}, ptr {out}, {sizes})")


def _row(text: IrText, row: str) -> str:
    return text.op(f"getelementptr double, ptr %w, i64 {text.op(f'mul i64 {row}, %cols')}")


@functools.cache
def _threshold() -> str:
    text = IrText()
    e = Lanes(text)

    def one(i: str) -> None:
        above = e.compare("ogt", fetch(e, "%out", i), "%rate")
        put(e, "%out", i, e.choose(above, e.const(1.0), e.const(0.0)))

    loop(text, "0", "%rows", 1, one)
    text.do("ret void")
    return f"define internal void @threshold(ptr %out, i64 %rows, double %rate) #0 {{\n{text.body()}\n}}"


@functools.cache
def _sanger() -> str:
    """W[i] += rate·v[i]·(x - Σ over k ≤ i of v[k]·W[k])."""
    text = IrText()
    e = Lanes(text)
    loop(text, "0", "%cols", 1, lambda k: put(e, "%rest", k, fetch(e, "%x", k)))

    def one_row(i: str) -> None:
        v, base = fetch(e, "%out", i), _row(text, i)
        gain = e.mul("%rate", v)

        def one(k: str) -> None:
            w = fetch(e, base, k)
            rest = e.sub(fetch(e, "%rest", k), e.mul(v, w))
            put(e, "%rest", k, rest)
            put(e, base, k, e.add(w, e.mul(gain, rest)))

        loop(text, "0", "%cols", 1, one)

    loop(text, "0", "%rows", 1, one_row)
    text.do("ret void")
    parameters = "ptr %out, ptr %w, ptr %x, i64 %rows, i64 %cols, double %rate, ptr %rest"
    return f"define internal void @sanger({parameters}) #0 {{\n{text.body()}\n}}"


@functools.cache
def _compete() -> str:
    """Return the winner-takes-all step; a row of zeros is free, and `wins` may be null.

    The function returns 1 where no row is near enough and none is free, else 0.
    """
    text = IrText()
    e = Lanes(text)
    best, best_raw = text.alloca("double"), text.alloca("double")
    winner, free_row = text.alloca("i64"), text.alloca("i64")
    distance, used = text.alloca("double"), text.alloca("i1")
    text.do(f"store i64 -1, ptr {winner}")
    text.do(f"store i64 -1, ptr {free_row}")
    text.do(f"%strict = fcmp ogt double %criterion, {e.const(0.0)}")
    text.do("%counts = icmp ne ptr %wins, null")
    text.do("%limit = fmul double %criterion, %criterion")

    def one_row(i: str) -> None:
        base = _row(text, i)
        put(e, "%out", i, e.const(0.0))
        text.do(f"store double 0.0, ptr {distance}")
        text.do(f"store i1 0, ptr {used}")

        def one(k: str) -> None:
            w = fetch(e, base, k)
            gap = e.sub(fetch(e, "%x", k), w)
            grown = e.add(text.op(f"load double, ptr {distance}"), e.mul(gap, gap))
            text.do(f"store double {grown}, ptr {distance}")
            some = text.op(f"or i1 {text.op(f'load i1, ptr {used}')}, {e.compare('une', w, e.const(0.0))}")
            text.do(f"store i1 {some}, ptr {used}")

        loop(text, "0", "%cols", 1, one)
        is_free = text.op(f"xor i1 {text.op(f'load i1, ptr {used}')}, 1")
        known = text.op(f"load i64, ptr {free_row}")
        first = text.op(f"and i1 {is_free}, {text.op(f'icmp slt i64 {known}, 0')}")
        text.do(f"store i64 {text.op(f'select i1 {first}, i64 {i}, i64 {known}')}, ptr {free_row}")
        apart = text.op(f"and i1 {is_free}, %strict")
        raw = e.choose(apart, e.const(_INFINITY), text.op(f"load double, ptr {distance}"))
        safe = text.op(f"select i1 %counts, ptr %wins, ptr {distance}")
        at = text.op(f"select i1 %counts, i64 {i}, i64 0")
        weighted = e.mul(raw, e.add(e.const(1.0), fetch(e, safe, at)))
        value = e.choose("%counts", weighted, raw)
        none = text.op(f"icmp slt i64 {text.op(f'load i64, ptr {winner}')}, 0")
        less = e.compare("olt", value, text.op(f"load double, ptr {best}"))
        wins_now = text.op(f"select i1 {none}, i1 1, i1 {less}")
        for cell, kind, new in ((best, "double", value), (best_raw, "double", raw), (winner, "i64", i)):
            old = text.op(f"load {kind}, ptr {cell}")
            kept = text.op(f"select i1 {wins_now}, {kind} {new}, {kind} {old}")
            text.do(f"store {kind} {kept}, ptr {cell}")

    text.do(f"store double 0.0, ptr {best}")
    text.do(f"store double 0.0, ptr {best_raw}")
    loop(text, "0", "%rows", 1, one_row)
    near = e.compare("ole", text.op(f"load double, ptr {best_raw}"), "%limit")
    far = text.op(f"and i1 %strict, {text.op(f'xor i1 {near}, 1')}")
    text.branch(far, "far", "move")
    text.begin("far")
    free = text.op(f"load i64, ptr {free_row}")
    text.branch(text.op(f"icmp slt i64 {free}, 0"), "full", "take")
    text.begin("full")
    text.do(f"ret double {e.const(1.0)}")
    text.begin("take")
    text.do(f"store i64 {free}, ptr {winner}")
    taken = _row(text, free)
    loop(text, "0", "%cols", 1, lambda k: put(e, taken, k, fetch(e, "%x", k)))
    text.jump("mark")
    text.begin("move")
    moved = _row(text, text.op(f"load i64, ptr {winner}"))

    def approach(k: str) -> None:
        w = fetch(e, moved, k)
        put(e, moved, k, e.add(w, e.mul("%rate", e.sub(fetch(e, "%x", k), w))))

    loop(text, "0", "%cols", 1, approach)
    text.jump("mark")
    text.begin("mark")
    won = text.op(f"load i64, ptr {winner}")
    put(e, "%out", won, e.const(1.0))
    text.branch("%counts", "count", "over")
    text.begin("count")
    put(e, "%wins", won, e.add(fetch(e, "%wins", won), e.const(1.0)))
    text.jump("over")
    text.begin("over")
    text.do(f"ret double {e.const(0.0)}")
    parameters = "ptr %out, ptr %w, ptr %x, i64 %rows, i64 %cols, double %rate, double %criterion, ptr %wins"
    return f"define internal double @compete({parameters}) #0 {{\n{text.body()}\n}}"
