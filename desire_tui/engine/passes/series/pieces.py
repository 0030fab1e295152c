"""Kinks and tables as choices between smooth pieces: what switches is then located like any jump.

Under other rules error control sees to kinks by states; a Taylor series must know on which side it is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set, SetMat, SetVec
from desire_tui.engine.lowered.walk import simple_actions, walk_values, with_bodies
from desire_tui.engine.passes.slices import derivative_slice

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action, SimpleAction

BREAKPOINTS_MOST = 64
"""A larger table has too many pieces: each is looked at in every step."""
_ONE, _ZERO, _TWO = Const(1.0), Const(0.0), Const(2.0)


def _op(name: str, *args: Value) -> Value:
    return Op(name, args)


def _comp(control: Value, minus: Value, plus: Value) -> Value:
    return Op("comp", (control, minus, plus))


def _sat(x: Value) -> Value:
    low = _comp(_op("sub", Const(-1.0), x), x, Const(-1.0))
    return _comp(_op("sub", x, _ONE), low, _ONE)


def _unit(x: Value) -> Value:
    return _comp(_op("sub", x, _ONE), _comp(x, _ZERO, x), _ONE)


def _abs(x: Value) -> Value:
    return _comp(x, _op("neg", x), x)


def _rational(x: Value) -> Value:
    square = _op("mul", x, x)
    return _comp(x, _ZERO, _op("div", square, _op("add", _ONE, square)))


_PIECES: dict[str, Callable[..., Value]] = {
    "abs": _abs,
    "lim": lambda x: _comp(x, _ZERO, x),
    "sat": _sat,
    "SAT": _unit,
    "deadz": lambda x: _op("sub", x, _sat(x)),
    "tri": lambda x: _op("sub", _ONE, _abs(x)),
    "SIGMOID": _rational,
    "max": lambda x, y: _comp(_op("sub", x, y), y, x),
    "min": lambda x, y: _comp(_op("sub", x, y), x, y),
}


def with_pieces(segment: Segment) -> Segment:
    """Return the segment with the kinks in its derivative pass written as choices."""
    slice_ = list(simple_actions(derivative_slice(segment)))
    if not any(_has_pieces(action) for action in slice_):
        return segment
    wanted = {id(action) for action in slice_ if _has_pieces(action)}
    return replace(segment, body=_rewritten(segment.body, wanted))


def _has_pieces(action: SimpleAction) -> bool:
    if not isinstance(action, Set | SetVec | SetMat | Deriv | DerivVec):
        return False
    return any(_is_piecewise(node) for node in walk_values(action.value))


def _is_piecewise(node: Value) -> bool:
    if isinstance(node, Table1):
        return 2 <= node.count <= BREAKPOINTS_MOST
    return isinstance(node, Op) and node.name in _PIECES


def _rewritten(actions: Iterable[Action], wanted: set[int]) -> tuple[Action, ...]:
    made: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            body, orelse = _rewritten(action.body, wanted), _rewritten(action.orelse, wanted)
            made.append(with_bodies(action, body, orelse))
        else:
            made.append(_statement(action) if id(action) in wanted else action)
    return tuple(made)


def _statement(action: SimpleAction) -> SimpleAction:
    known: dict[int, Value] = {}
    match action:
        case Set():
            return Set(action.slot, _value(action.value, known), action.where, action.persistent)
        case SetVec():
            return SetVec(action.slot, action.count, _value(action.value, known), action.where, action.mode,
                          action.mask_slot, action.persistent)  # fmt: skip
        case SetMat():
            value = _value(action.value, known)
            return SetMat(action.slot, action.rows, action.cols, value, action.where, action.mode,
                          action.lower, action.upper, action.mask_slot, action.persistent)  # fmt: skip
        case Deriv():
            return Deriv(action.state, _value(action.value, known), action.where)
        case DerivVec():
            return DerivVec(action.state, action.count, _value(action.value, known), action.where)
        case _:
            return action


def _value(value: Value, known: dict[int, Value]) -> Value:
    found = known.get(id(value))
    if found is None:
        found = known[id(value)] = _piecewise(value, known)
    return found


def _piecewise(value: Value, known: dict[int, Value]) -> Value:
    if isinstance(value, Table1):
        x = _value(value.x, known)
        table = Table1(x, value.slot, value.count)
        return _lines(table) if _is_piecewise(value) else table
    if not isinstance(value, Op):
        return value
    args = tuple(_value(argument, known) for argument in value.args)
    if value.name in _PIECES:
        return _PIECES[value.name](*args)
    same = all(new is old for new, old in zip(args, value.args, strict=True))
    return value if same else Op(value.name, args)


def _lines(table: Table1) -> Value:
    """Return a table as straight lines between its breakpoints, constant outside."""
    x, last = table.x, table.count - 1
    at = [Load(table.slot + i) for i in range(table.count)]
    y = [Load(table.slot + table.count + i) for i in range(table.count)]
    made: Value = y[last]
    for i in range(last - 1, -1, -1):
        slope = _op("div", _op("sub", y[i + 1], y[i]), _op("sub", at[i + 1], at[i]))
        line = _op("add", y[i], _op("mul", slope, _op("sub", x, at[i])))
        made = _comp(_op("sub", x, at[i + 1]), line, made)
    return _comp(_op("sub", x, at[0]), y[0], made)
