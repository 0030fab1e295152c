"""Statements of a pass in C."""

from __future__ import annotations

from textwrap import indent
from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.lowered.statements import (
    DelayLine,
    Deriv,
    DerivVec,
    GetHistory,
    Guard,
    LearningStep,
    Set,
    SetDot,
    SetMat,
    SetVec,
    StoreHistory,
    Terminate,
    UpdateTrackHold,
)
from desire_tui.export.c.expressions import Expressions, bare, number

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.export.c.layout import Layout

_STEP = "    "


class Statements:
    """Writes passes. `used`: what of the library they call. Learning statements have to be refused before."""

    def __init__(self, layout: Layout, lags: Mapping[int, int]) -> None:
        self.layout, self._lags = layout, lags
        self.used: set[str] = set()

    def function(self, name: str, actions: Iterable[Action], *, derivatives: bool = True) -> str:
        """Return a pass as a function."""
        body = "".join(self._statement(action) for action in actions)
        parameter = "double *dx" if derivatives else "void"
        unused = f"{_STEP}(void)dx;\n" if derivatives and "dx[" not in body else ""
        return f"static void {name}({parameter})\n{{\n{unused}{indent(body, _STEP)}}}\n"

    def _statement(self, action: Action) -> str:
        place = self.layout.place
        match action:
            case Set():
                return self._lines(action.value, lambda value: f"{place(action.slot)} = {value};\n")
            case Deriv():
                return self._lines(action.value, lambda value: f"dx[{action.state}] = {value};\n")
            case DerivVec():
                return self._loop(
                    action.count, [action.value], lambda v: f"dx[{action.state} + i] = {v[0]};\n"
                )
            case SetVec():
                return self._vector(action)
            case SetMat():
                return self._matrix(action)
            case SetDot():
                return self._dot(action)
            case StoreHistory() | GetHistory() | DelayLine() | UpdateTrackHold():
                return self._history(action)
            case Terminate():
                return self._terminate(action)
            case Guard():
                return self._guard(action)
            case LearningStep():
                raise TypeError(action.kind)
            case _:
                assert_never(action)

    def _values(self, *values: Value) -> tuple[list[str], list[str]]:
        """Return definitions of variables, and the texts of the values."""
        expressions = Expressions(self.layout, self.used, values)
        texts = [bare(expressions.value(value)) for value in values]
        return expressions.lines, texts

    def _lines(self, value: Value, statement: Callable[[str], str]) -> str:
        lines, (text,) = self._values(value)
        written = statement(text)
        return written if not lines else _block([*lines, written.rstrip("\n")])

    def _loop(
        self, count: int, values: list[Value], statement: Callable[[list[str]], str], *, before: str = ""
    ) -> str:
        """Return a loop over elements, from the last to the first as the language has it."""
        lines, texts = self._values(*values)
        written = statement(texts)
        body = "".join(f"{line}\n" for line in lines) + written
        return f"{before}for (int i = {count - 1}; i >= 0; i--) {{\n{indent(body, _STEP)}}}\n"

    def _vector(self, action: SetVec) -> str:
        target = self.layout.pointer(action.slot, action.count)
        mask = "" if action.mask_slot is None else self.layout.pointer(action.mask_slot, action.count)

        def element(values: list[str]) -> str:
            new = f"({mask}[i] != 0.0 ? 0.0 : {values[0]})" if mask else values[0]
            return f"{target}[i] {'+=' if action.mode == 'add' else '='} {new};\n"

        text = self._loop(action.count, [action.value], element)
        if action.mode != "largest":
            return text
        best = (f"int best = {action.count - 1};\n"
                f"for (int i = {action.count - 2}; i >= 0; i--)\n"
                f"    if ({target}[i] > {target}[best])\n        best = i;\n"
                f"for (int i = 0; i < {action.count}; i++)\n"
                f"    if (i != best)\n        {target}[i] = 0.0;")  # fmt: skip
        return text + _block([best])

    def _matrix(self, action: SetMat) -> str:
        count = action.rows * action.cols
        target = self.layout.pointer(action.slot, count)
        values = [v for v in (action.value, action.lower, action.upper) if v is not None]
        mask = "" if action.mask_slot is None else self.layout.pointer(action.mask_slot, count)

        def element(texts: list[str]) -> str:
            lines = [f"double new = {f'{target}[i] + ({texts[0]})' if action.mode == 'add' else texts[0]};"]
            rest = texts[1:]
            if action.lower is not None:
                lines.append(f"const double least = {rest[0]};\nnew = new < least ? least : new;")
                rest = rest[1:]
            if action.upper is not None:
                lines.append(f"const double most = {rest[0]};\nnew = new > most ? most : new;")
            keep = f"if ({mask}[i] != 0.0)\n    " if mask else ""
            lines.append(f"{keep}{target}[i] = new;")
            return "\n".join(lines) + "\n"

        return self._loop(count, values, element)

    def _dot(self, action: SetDot) -> str:
        lines = ["double sum = 0.0;"]
        for term in action.terms:
            parts = [term.left] if term.right is None else [term.left, term.right]
            _, texts = self._values(*parts)
            lines.append("{\n    double part = 0.0;")
            lines.append(
                f"    for (int i = 0; i < {term.left.count}; i++)\n        part += {' * '.join(texts)};"
            )
            lines.append(f"    sum += {number(term.sign)} * part;\n}}")
        length = f" / {number(float(action.terms[0].left.count))}" if action.average and action.terms else ""
        lines.append(f"{self.layout.place(action.slot)} = sum{length};")
        return _block(lines)

    def _history(self, action: StoreHistory | GetHistory | DelayLine | UpdateTrackHold) -> str:
        place, pointer = self.layout.place, self.layout.pointer
        match action:
            case UpdateTrackHold():
                lines, (control, value) = self._values(action.control, action.value)
                held, tracked = place(action.held_slot), place(action.tracked_slot)
                moves = f"    {held} = {tracked};\n    {tracked} = new;\n"
                body = f"const double new = {value};\nif (({control}) > 0.0) {{\n{moves}}}"
                return _block([*lines, body])
            case DelayLine():
                self.used.add("counters")
                lines, (source,) = self._values(action.source)
                buffer, n, at = (
                    pointer(action.buffer_slot, action.count),
                    action.count,
                    f"counters[{action.counter}]",
                )
                lag = self._lags[action.counter]
                old = "new" if lag == 0 else f"{buffer}[({at} + {n - lag}) % {n}]"
                body = (f"const double new = {source};\n{place(action.slot)} = {old};\n"
                        f"{buffer}[{at} % {n}] = new;\n{at}++;")  # fmt: skip
                return _block([*lines, body])
            case _:
                self.used.add("counters")
                at = f"counters[{action.counter}]"
                element = f"{pointer(action.array_slot, action.count)}[{at}]"
                left, right = place(action.slot), element
                if isinstance(action, StoreHistory):
                    left, right = right, left
                return f"if ({at} < {action.count}) {{\n    {left} = {right};\n    {at}++;\n}}\n"

    def _terminate(self, action: Terminate) -> str:
        lines, (value,) = self._values(action.value)
        level = "0.0" if action.level is None else self.layout.place(action.level)
        body = f"const double now = {value};\nif (now > {level} && fired < 0)\n    fired = {action.number};"
        if action.level is not None:
            body += f"\n{level} = now > 0.0 && {level} >= 0.0 ? now : 0.0;"
        return _block([*lines, body])

    def _guard(self, guard: Guard) -> str:
        body = "".join(self._statement(action) for action in guard.body)
        if guard.kind == "sample":
            return f"if ((point + 1) % {guard.every} == 0) {{\n{indent(body, _STEP)}}}\n"
        assert guard.condition is not None
        lines, (condition,) = self._values(guard.condition)
        orelse = "".join(self._statement(action) for action in guard.orelse)
        text = f"if (({condition}) > 0.0) {{\n{indent(body, _STEP)}}}"
        text += f" else {{\n{indent(orelse, _STEP)}}}\n" if orelse else "\n"
        return text if not lines else _block([*lines, text.rstrip("\n")])


def _block(lines: list[str]) -> str:
    return "{\n" + indent("\n".join(lines), _STEP) + "\n}\n"
