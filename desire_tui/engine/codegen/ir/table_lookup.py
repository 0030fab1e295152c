"""Table look-up (func1, func2) as functions that compiled pieces carry with them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.lanes import Lanes
    from desire_tui.engine.lowered.expressions import Table1, Table2

_PLACE = """
define internal i64 @table.place(ptr readonly %x, i64 %n, double %at) #2 {
entry:
  %last = sub i64 %n, 1
  br label %test
test:
  %low = phi i64 [ 0, %entry ], [ %low2, %half ]
  %high = phi i64 [ %last, %entry ], [ %high2, %half ]
  %gap = sub i64 %high, %low
  %more = icmp sgt i64 %gap, 1
  br i1 %more, label %half, label %done
half:
  %sum = add i64 %low, %high
  %middle = lshr i64 %sum, 1
  %p = getelementptr double, ptr %x, i64 %middle
  %xm = load double, ptr %p
  %left = fcmp olt double %at, %xm
  %low2 = select i1 %left, i64 %low, i64 %middle
  %high2 = select i1 %left, i64 %middle, i64 %high
  br label %test
done:
  ret i64 %low
}
"""

_TABLE1 = """
define internal double @table1(ptr readonly %x, i64 %n, double %at) #2 {
entry:
  %y = getelementptr double, ptr %x, i64 %n
  %x0 = load double, ptr %x
  %below = fcmp ole double %at, %x0
  br i1 %below, label %first, label %check
first:
  %y0 = load double, ptr %y
  ret double %y0
check:
  %n1 = sub i64 %n, 1
  %pxn = getelementptr double, ptr %x, i64 %n1
  %xn = load double, ptr %pxn
  %above = fcmp oge double %at, %xn
  br i1 %above, label %last, label %inside
last:
  %pyn = getelementptr double, ptr %y, i64 %n1
  %yn = load double, ptr %pyn
  ret double %yn
inside:
  %finite = fcmp ord double %at, %at
  br i1 %finite, label %find, label %nan
nan:
  ret double %at
find:
  %i = call i64 @table.place(ptr %x, i64 %n, double %at)
  %k = add i64 %i, 1
  %pxi = getelementptr double, ptr %x, i64 %i
  %pxk = getelementptr double, ptr %x, i64 %k
  %pyi = getelementptr double, ptr %y, i64 %i
  %pyk = getelementptr double, ptr %y, i64 %k
  %xi = load double, ptr %pxi
  %xk = load double, ptr %pxk
  %yi = load double, ptr %pyi
  %yk = load double, ptr %pyk
  %dy = fsub double %yk, %yi
  %dx = fsub double %at, %xi
  %width = fsub double %xk, %xi
  %part = fdiv double %dx, %width
  %rise = fmul double %dy, %part
  %result = fadd double %yi, %rise
  ret double %result
}
"""

_BRACKET = """
define internal { i64, double } @table.bracket(ptr readonly %x, i64 %n, double %at) #2 {
entry:
  %last = sub i64 %n, 1
  %x0 = load double, ptr %x
  %pn = getelementptr double, ptr %x, i64 %last
  %xn = load double, ptr %pn
  %low = fcmp ole double %at, %x0
  br i1 %low, label %first, label %check
first:
  ret { i64, double } { i64 0, double 0.0 }
check:
  %high = fcmp oge double %at, %xn
  br i1 %high, label %top, label %inside
top:
  %t = insertvalue { i64, double } { i64 0, double 0.0 }, i64 %last, 0
  ret { i64, double } %t
inside:
  %alone = icmp eq i64 %last, 0
  br i1 %alone, label %first, label %find
find:
  %i = call i64 @table.place(ptr %x, i64 %n, double %at)
  %k = add i64 %i, 1
  %pi = getelementptr double, ptr %x, i64 %i
  %pk = getelementptr double, ptr %x, i64 %k
  %xi = load double, ptr %pi
  %xk = load double, ptr %pk
  %d = fsub double %at, %xi
  %w = fsub double %xk, %xi
  %q = fdiv double %d, %w
  %r0 = insertvalue { i64, double } poison, i64 %i, 0
  %r1 = insertvalue { i64, double } %r0, double %q, 1
  ret { i64, double } %r1
}
"""

_TABLE2 = """
define internal double @table2(ptr readonly %f, ptr readonly %xs, i64 %n, ptr readonly %ys, i64 %m,
                               double %x, double %y) #2 {
entry:
  %bx = call { i64, double } @table.bracket(ptr %xs, i64 %n, double %x)
  %by = call { i64, double } @table.bracket(ptr %ys, i64 %m, double %y)
  %i = extractvalue { i64, double } %bx, 0
  %p = extractvalue { i64, double } %bx, 1
  %k = extractvalue { i64, double } %by, 0
  %q = extractvalue { i64, double } %by, 1
  %n1 = sub i64 %n, 1
  %m1 = sub i64 %m, 1
  %inext = add i64 %i, 1
  %knext = add i64 %k, 1
  %i2 = call i64 @llvm.smin.i64(i64 %inext, i64 %n1)
  %k2 = call i64 @llvm.smin.i64(i64 %knext, i64 %m1)
  %row = mul i64 %i, %m
  %row2 = mul i64 %i2, %m
  %a = add i64 %row, %k
  %a2 = add i64 %row, %k2
  %b = add i64 %row2, %k
  %b2 = add i64 %row2, %k2
  %pa = getelementptr double, ptr %f, i64 %a
  %pa2 = getelementptr double, ptr %f, i64 %a2
  %pb = getelementptr double, ptr %f, i64 %b
  %pb2 = getelementptr double, ptr %f, i64 %b2
  %fa = load double, ptr %pa
  %fa2 = load double, ptr %pa2
  %fb = load double, ptr %pb
  %fb2 = load double, ptr %pb2
  %da = fsub double %fa2, %fa
  %ra = fmul double %da, %q
  %lower = fadd double %fa, %ra
  %db = fsub double %fb2, %fb
  %rb = fmul double %db, %q
  %upper = fadd double %fb, %rb
  %gap = fsub double %upper, %lower
  %rise = fmul double %gap, %p
  %result = fadd double %lower, %rise
  ret double %result
}
"""

_SMIN = "declare i64 @llvm.smin.i64(i64, i64)"


def table1(lanes: Lanes, node: Table1, x: str) -> str:
    """Write func1: linear between breakpoints, constant outside, nan for nan."""
    lanes.text.declarations.update((_PLACE, _TABLE1))
    base = lanes.text.op(f"getelementptr double, ptr %v, i64 {node.slot}")
    return _each(lanes, f"@table1(ptr {base}, i64 {node.count}, ", x)


def table2(lanes: Lanes, node: Table2, x: str, y: str) -> str:
    """Write func2: bilinear over F, constant outside."""
    lanes.text.declarations.update((_PLACE, _BRACKET, _TABLE2, _SMIN))
    f, xs, ys = (
        lanes.text.op(f"getelementptr double, ptr %v, i64 {slot}")
        for slot in (node.f_slot, node.x_slot, node.y_slot)
    )
    return _each(lanes, f"@table2(ptr {f}, ptr {xs}, i64 {node.rows}, ptr {ys}, i64 {node.cols}, ", x, y)


def _each(lanes: Lanes, call: str, *args: str) -> str:
    text = lanes.text
    if lanes.width == 1:
        return text.op(f"call double {call}{', '.join(f'double {a}' for a in args)})")
    result = "poison"
    for lane in range(lanes.width):
        ones = [text.op(f"extractelement {lanes.kind} {a}, i64 {lane}") for a in args]
        one = text.op(f"call double {call}{', '.join(f'double {a}' for a in ones)})")
        result = text.op(f"insertelement {lanes.kind} {result}, double {one}, i64 {lane}")
    return result
