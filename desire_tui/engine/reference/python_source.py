"""Scalar statements as the text of one Python function a pass: several times faster than closures.

The text computes with plain floats. Where Python raises (division by zero, overflow, an argument out of
domain), the statement's closure is called in its place, which knows what IEEE 754 says.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from desire_tui.engine.library import LIBRARY, func1
from desire_tui.engine.lowered.expressions import Const, Load, Op, Table1
from desire_tui.engine.lowered.statements import Deriv, Guard, Set, Terminate
from desire_tui.engine.lowered.walk import operands
from desire_tui.engine.random_sequence import DRAWS
from desire_tui.engine.reference.numbers import integer_power, power

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from types import CodeType

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.reference.evaluation_context import EvaluationContext

_BINARY = {"add": ("+", 1), "sub": ("-", 1), "mul": ("*", 2), "div": ("/", 2)}
_ATOM, _SIGNED = 4, 3
_NESTING_MAX = 60
"""Python refuses more than 200 open parentheses; deeper expressions go the way of closures."""


class CannotWriteError(Exception):
    """The expression needs a closure: random draws, arrays, too many levels."""


class PassText:
    """Writes the function of one pass; `closure` makes the closure of a statement that is not written out."""

    def __init__(self, context: EvaluationContext, closure: Callable[[Action], Callable[[], None]]) -> None:
        self.context = context
        self._closure = closure
        self.lines: list[str] = []
        self.names: dict[str, Any] = {
            "c": context.cells, "s": context, "wrong": (ArithmeticError, ValueError),
            "integer_power": integer_power, "power": power, "func1": func1,
        }  # fmt: skip
        self._made_for_each: list[tuple[str, Callable[[], object]]] = []
        self._code: CodeType | None = None
        self.fresh = 0

    def write(self, actions: Iterable[Action]) -> None:
        """Write the pass."""
        self._write(actions, 1)
        text = "\n".join(["def run():", *(self.lines or [" pass"])])
        self._code = compile(text, "<pass>", "exec")  # text made from numbers and slots only

    def function(self) -> Callable[[], None]:
        """Return the pass as a function that writes derivatives where the context wants them now."""
        assert self._code is not None
        names = self.names | {"d": self.context.derivatives.data}
        names |= {name: make() for name, make in self._made_for_each}
        exec(self._code, names)  # noqa: S102 - as above
        built: Callable[[], None] = names["run"]
        return built

    def _line(self, depth: int, text: str) -> None:
        self.lines.append(" " * depth + text)

    def _name(self, prefix: str, thing: object) -> str:
        self.fresh += 1
        name = f"{prefix}{self.fresh}"
        self.names[name] = thing
        return name

    def _named_anew(self, prefix: str, make: Callable[[], object]) -> str:
        """Name something that each function of the pass has for itself."""
        name = self._name(prefix, None)
        self._made_for_each.append((name, make))
        return name

    def _closure_at_need(self, action: Action) -> Callable[[], None]:
        """Return what makes the closure of a statement when it is called first: most never are."""
        context, derivatives = self.context, self.context.derivatives
        made: list[Callable[[], None]] = []

        def run() -> None:
            if not made:
                elsewhere, context.derivatives = context.derivatives, derivatives
                try:
                    made.append(self._closure(action))
                finally:
                    context.derivatives = elsewhere
            made[0]()

        return run

    def _write(self, actions: Iterable[Action], depth: int) -> None:
        for action in actions:
            if isinstance(action, Set | Deriv | Terminate):
                self._scalar(action, depth)
            elif isinstance(action, Guard) and action.kind == "if" and action.condition is not None:
                self._choice(action, action.condition, depth)
            else:
                self._line(depth, f"{self._named_anew('f', partial(self._closure, action))}()")

    def _scalar(self, action: Set | Deriv | Terminate, depth: int) -> None:
        try:
            text = _Expression(self).write(action.value)
        except CannotWriteError:
            self._line(depth, f"{self._named_anew('f', partial(self._closure, action))}()")
            return
        closure = self._named_anew("f", partial(self._closure_at_need, action))
        if isinstance(action, Terminate):
            level = "0.0" if action.level is None else f"c[{action.level}]"
            self._line(depth, "try:")
            self._line(depth + 1, f"now = {text}")
            self._line(depth + 1, f"if now > {level} and s.fired is None: s.fired = {action.number}")
            if action.level is not None:
                self._line(depth + 1, f"{level} = now if now > 0.0 <= {level} else 0.0")
        else:
            target = f"c[{action.slot}]" if isinstance(action, Set) else f"d[{action.state}]"
            self._line(depth, f"try: {target} = {text}")
        self._line(depth, f"except wrong: {closure}()")

    def _choice(self, guard: Guard, condition: Value, depth: int) -> None:
        test = self._named_anew("f", partial(self.context.value, condition))
        self._line(depth, f"if {test}() > 0.0:")
        self._write(guard.body, depth + 1)
        if not guard.body:
            self._line(depth + 1, "pass")
        if guard.orelse:
            self._line(depth, "else:")
            self._write(guard.orelse, depth + 1)


class _Expression:
    """The text of one expression."""

    def __init__(self, text: PassText) -> None:
        self.text = text
        self.uses: dict[int, int] = {}
        self.shared: dict[int, str] = {}

    def write(self, value: Value) -> str:
        self._count_uses(value)
        return self._text_of(value, 0)[0]

    def _count_uses(self, value: Value) -> None:
        uses = self.uses
        uses[id(value)] = uses.get(id(value), 0) + 1
        if uses[id(value)] == 1:
            for operand in operands(value):
                self._count_uses(operand)

    def _text_of(self, value: Value, depth: int) -> tuple[str, int]:
        if depth > _NESTING_MAX:
            raise CannotWriteError
        if isinstance(value, Const):
            if value.value - value.value != 0.0:
                raise CannotWriteError  # inf and nan have no literal
            return (repr(value.value), _ATOM) if value.value >= 0.0 else (f"({value.value!r})", _ATOM)
        if isinstance(value, Load):
            return f"c[{value.slot}]", _ATOM
        known = self.shared.get(id(value))
        if known is not None:
            return known, _ATOM
        built = self._build(value, depth)
        if self.uses.get(id(value), 1) > 1:
            name = self.shared[id(value)] = self.text._name("t", 0.0)  # noqa: SLF001 - one job in two classes
            return f"({name} := {built[0]})", _ATOM
        return built

    def _build(self, value: Value, depth: int) -> tuple[str, int]:
        if isinstance(value, Table1):
            table = self.text.context.cells[value.slot : value.slot + 2 * value.count]
            x = self._text_of(value.x, depth + 1)[0]
            return f"func1({x}, {self.text._name('a', table)})", _ATOM  # noqa: SLF001 - as above
        if not isinstance(value, Op) or value.name in DRAWS or value.name == "delayed":
            raise CannotWriteError
        name = value.name
        if name in _BINARY:
            sign, rank = _BINARY[name]
            left = self._text_of(value.args[0], depth + 1)
            right = self._text_of(value.args[1], depth + 1)
            a = left[0] if left[1] >= rank else f"({left[0]})"
            b = right[0] if right[1] > rank else f"({right[0]})"
            return f"{a} {sign} {b}", rank
        args = [self._text_of(argument, depth + 1)[0] for argument in value.args]
        if name == "neg":
            return f"-({args[0]})", _SIGNED
        if name == "ipow":
            exponent = value.args[1]
            assert isinstance(exponent, Const)
            if exponent.value == 2.0 and isinstance(value.args[0], Load):
                return f"{args[0]} * {args[0]}", 2
            return f"integer_power({args[0]}, {int(exponent.value)})", _ATOM
        if name == "pow":
            return f"power({args[0]}, {args[1]})", _ATOM
        plain = LIBRARY[name].value
        self.text.names[f"F_{name}"] = plain
        return f"F_{name}({', '.join(args)})", _ATOM
