"""What the program's registers are over an interval of t, rounded outward, or exactly at one t.

`over` tells whether no switch can be inside the interval; `at` notes where each switch stands.
"""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

from desire_tui.engine.integration.switching.mathematics import atan, cos, exp, floor, log, sin, tanh
from desire_tui.engine.integration.switching.operations import Operation

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Reals
    from desire_tui.engine.integration.switching.memory import Watch

_OUTWARD = 4.440892098500626e-16
"""Two roundings; the mathematical library's functions are within one."""
_TINY = 1e-300
_HUGE = 1e308
_TURN = 6.283185307179586
_QUARTER = 1.5707963267948966


def over(w: Watch, t0: float, t1: float) -> int:
    """Compute bounds over t0 … t1; whether no switch can be there."""
    w.low[0] = t0
    w.high[0] = t1
    return over_registers(w, w.instruction_count, Operation.MIN)


def over_registers(w: Watch, count: int, last: int) -> int:
    """Compute bounds of `count` instructions; whether none that switches, up to the operation `last`, can."""
    clear = 1
    for k in range(count):
        to = w.instructions[4 * k + 1]
        a = w.instructions[4 * k + 2]
        b = w.instructions[4 * k + 3]
        operation = w.instructions[4 * k]
        if operation < Operation.THRESHOLD:
            smooth(w, operation, to, a, b)
        elif w.low[a] == w.high[a] and (operation < Operation.MAX or w.low[b] == w.high[b]):
            decide(w, operation, to, a, b)  # it does not move
        elif switch(w, operation, to, a, b) == 0 and operation <= last:
            clear = 0
    return clear


def at(w: Watch, t: float, sides: Reals) -> None:
    """Compute values at t as compiled code does, and each switch's side."""
    w.low[0] = t
    for k in range(w.instruction_count):
        to = w.instructions[4 * k + 1]
        a = w.instructions[4 * k + 2]
        b = w.instructions[4 * k + 3]
        operation = w.instructions[4 * k]
        if operation < Operation.THRESHOLD:
            w.low[to] = exact(w, operation, a, b)
            sides[k] = 0.0
        else:
            sides[k] = decide(w, operation, to, a, b)


def exact(w: Watch, operation: int, a: int, b: int) -> float:
    """Return an operation's value at a point."""
    x: float = w.low[a]
    y: float = w.low[b]
    if operation == Operation.ADD:
        return x + y
    if operation == Operation.SUB:
        return x - y
    if operation == Operation.MUL:
        return x * y
    if operation == Operation.DIV:
        return divided(x, y)
    if operation == Operation.NEG:
        return -x
    return function(operation, x)


def divided(x: float, y: float) -> float:
    """Return x/y, without Python's refusal of 0."""
    if y != 0.0:
        return x / y
    return x * _HUGE * 10.0


def function(operation: int, x: float) -> float:
    """Return a function of one argument."""
    if operation == Operation.SIN:
        return sin(x)
    if operation == Operation.COS:
        return cos(x)
    if operation == Operation.EXP:
        return exp(x)
    if operation == Operation.LN:
        return log(x)
    if operation == Operation.SQRT:
        return sqrt(max(x, 0.0))
    if operation == Operation.ATAN:
        return atan(x)
    return tanh(x)


def smooth(w: Watch, operation: int, to: int, a: int, b: int) -> None:
    """Bound an operation without switches."""
    al: float = w.low[a]
    ah: float = w.high[a]
    bl: float = w.low[b]
    bh: float = w.high[b]
    low = 0.0
    high = 0.0
    if operation == Operation.ADD:
        low = al + bl
        high = ah + bh
    elif operation == Operation.SUB:
        low = al - bh
        high = ah - bl
    elif operation == Operation.NEG:
        w.low[to] = -ah
        w.high[to] = -al
        return
    elif operation < Operation.NEG:  # a product, a quotient
        if operation == Operation.DIV:
            if bl <= 0.0 and bh >= 0.0:
                w.low[to] = -_HUGE * 10.0
                w.high[to] = _HUGE * 10.0
                return
            swap = 1.0 / bh
            bh = 1.0 / bl
            bl = swap
        if a == b and operation == Operation.MUL:  # a square
            high = max(al * al, ah * ah)
            if al > 0.0 or ah < 0.0:
                low = min(al * al, ah * ah)
        else:
            low = min(al * bl, al * bh, ah * bl, ah * bh)
            high = max(al * bl, al * bh, ah * bl, ah * bh)
    elif operation == Operation.SIN:
        wave(w, to, al - _QUARTER, ah - _QUARTER, sin(al), sin(ah))
        return
    elif operation == Operation.COS:
        wave(w, to, al, ah, cos(al), cos(ah))
        return
    else:
        low = function(operation, al)
        high = function(operation, ah)
    if al == ah and bl == bh and low == high:
        w.low[to] = low
        w.high[to] = high
        return
    if not (low >= -_HUGE and high <= _HUGE):
        low = -_HUGE * 10.0
        high = _HUGE * 10.0
    w.low[to] = low - abs(low) * _OUTWARD - _TINY
    w.high[to] = high + abs(high) * _OUTWARD + _TINY


def wave(w: Watch, to: int, low: float, high: float, first: float, last: float) -> None:
    """Bound a cosine between two angles; `first` and `last` are its values there."""
    least = min(first, last)
    most = max(first, last)
    least -= abs(least) * _OUTWARD + _TINY
    most += abs(most) * _OUTWARD + _TINY
    slack = (abs(low) + abs(high)) * _OUTWARD
    turns = floor((high + slack) / _TURN)
    if turns * _TURN >= low - slack or not abs(high) < _HUGE:
        most = 1.0
    turns = floor((high + slack) / _TURN - 0.5) + 0.5
    if turns * _TURN >= low - slack or not abs(high) < _HUGE:
        least = -1.0
    w.low[to] = max(least, -1.0)
    w.high[to] = min(most, 1.0)


def decide(w: Watch, operation: int, to: int, a: int, b: int) -> float:
    """Compute a switch at a point (into both bounds); return the side on which it stands."""
    x: float = w.low[a]
    y: float = w.low[b]
    side = 0.0 + (x > 0.0)
    value = x
    if operation == Operation.SWTCH:
        value = side
    elif operation == Operation.SGN:
        side = 0.0 + (x > 0.0) - (x < 0.0)
        value = side
    elif operation == Operation.LIM:
        value = max(x, 0.0)
    elif operation == Operation.ABS:
        value = abs(x)
    elif operation == Operation.ROUND:
        value = floor(abs(x) + 0.5)
        if x < 0.0:
            value = -value
        side = value
    elif operation == Operation.TRNC:
        value = floor(abs(x))
        if x < 0.0:
            value = -value
        side = value
    elif operation == Operation.FLOOR:
        value = floor(x)
        side = value
    elif operation >= Operation.MAX:
        side = 0.0 + (x > y)
        value = max(x, y) if operation == Operation.MAX else min(x, y)
    elif operation == Operation.TABLE:
        side = place_in_table(w, b, x)
        value = table_value(w, b, x)
    else:  # thresholds at -1 or 0, and at 1
        lower = 0.0 if operation == Operation.SAT_ABOVE else -1.0
        side = 0.0 + (x > 1.0) + (x > lower)
        clipped = min(max(x, lower), 1.0)
        value = clipped
        if operation == Operation.DEADZ:
            value = x - clipped
        elif operation == Operation.DEADC:
            value = 0.0 + (x > 1.0) - (x < -1.0)
            side = value
        elif operation == Operation.RECT:
            value = 0.0 + (abs(x) < 1.0)
            side = value
    w.low[to] = value
    w.high[to] = value
    return side


def switch(w: Watch, operation: int, to: int, a: int, b: int) -> int:
    """Bound a switch; whether its argument keeps off its thresholds."""
    low: float = w.low[a]
    high: float = w.high[a]
    if operation >= Operation.MAX:
        other_low: float = w.low[b]
        other_high: float = w.high[b]
        if operation == Operation.MAX:
            w.low[to] = max(low, other_low)
            w.high[to] = max(high, other_high)
        else:
            w.low[to] = min(low, other_low)
            w.high[to] = min(high, other_high)
        return low > other_high or high < other_low
    if operation == Operation.TABLE:
        return table_over(w, b, to, low, high)
    if operation == Operation.ABS:
        if low <= 0.0 and high >= 0.0:
            w.low[to] = 0.0
            w.high[to] = max(-low, high)
            return 0
        w.low[to] = min(abs(low), abs(high))
        w.high[to] = max(abs(low), abs(high))
        return 1
    if operation == Operation.RECT:
        inside = low > -1.0 and high < 1.0
        outside = low > 1.0 or high < -1.0
        w.low[to] = 1.0 if inside else 0.0
        w.high[to] = 0.0 if outside else 1.0
        return inside or outside
    # all others grow with their arguments
    w.low[a] = low
    first = decide(w, operation, to, a, b)
    least: float = w.low[to]
    w.low[a] = high
    last = decide(w, operation, to, a, b)
    w.low[a] = low
    w.low[to] = least
    return first == last


def place_in_table(w: Watch, table: int, x: float) -> float:
    """Count the breakpoints below x and up to it."""
    first = w.tables[2 * table]
    below = 0
    for i in range(w.tables[2 * table + 1]):
        here: float = w.values[first + i]
        below += here < x
        below += here <= x
    return 0.0 + below


def table_value(w: Watch, table: int, x: float) -> float:
    """Return `func1` of x."""
    first = w.tables[2 * table]
    count = w.tables[2 * table + 1]
    values: Reals = w.values
    if x <= values[first]:
        start: float = values[first + count]
        return start
    for i in range(1, count):
        if x < values[first + i]:
            left: float = values[first + i - 1]
            share = (x - left) / (values[first + i] - left)
            below: float = values[first + count + i - 1]
            above: float = values[first + count + i]
            between: float = below + share * (above - below)
            return between
    end: float = values[first + 2 * count - 1]
    return end


def table_over(w: Watch, table: int, to: int, low: float, high: float) -> int:
    """Bound a table; whether no breakpoint is inside."""
    first = w.tables[2 * table]
    count = w.tables[2 * table + 1]
    values: Reals = w.values
    least = table_value(w, table, low)
    most = table_value(w, table, high)
    clear = 1
    swap = min(least, most)
    most = max(least, most)
    least = swap
    for i in range(count):
        here: float = values[first + i]
        if here >= low and here <= high:
            clear = 0
            least = min(least, values[first + count + i])
            most = max(most, values[first + count + i])
    w.low[to] = least - abs(least) * _OUTWARD
    w.high[to] = most + abs(most) * _OUTWARD
    return clear
