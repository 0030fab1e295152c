"""Calls in plain Python: of the program's own functions, C functions, function pointers, built-in ones."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.plain_python.expressions import FLOATING, WHOLE, Expressions
from desire_tui.engine.codegen.plain_python.kinds import ADDRESS, REAL, Signature, Value

if TYPE_CHECKING:
    from collections.abc import Callable


class Calls(Expressions):
    """Writes calls."""

    def _get_call(self, node: ast.Call) -> Value:
        found = self.write_call(node)
        return found or self.refuse(node, f"the value of '{ast.unparse(node)}', which has none")

    def write_call(self, node: ast.Call) -> Value | None:
        """Write a call; None: it has no value."""
        if node.keywords:
            self.refuse(node, f"an argument by name in '{ast.unparse(node)}'")
        if isinstance(node.func, ast.Attribute):
            return self._call_of_attribute(node, node.func)
        if not isinstance(node.func, ast.Name) or node.func.id in self.local:
            self.refuse(node, f"the call '{ast.unparse(node)}'")
        name = node.func.id
        if name in self.around.functions:
            return self.call(node, self.around.functions[name])
        if not self.around.builtin(name):
            self.refuse(node, f"a call of '{name}', which is unknown")
        builtin: Callable[[ast.Call], Value | None] | None = getattr(self, f"_call_{name}", None)
        return builtin(node) if builtin is not None else self.refuse(node, f"a call of '{name}' here")

    def _call_of_attribute(self, node: ast.Call, target: ast.Attribute) -> Value | None:
        outside, name = self.around.outside, target.attr
        if isinstance(target.value, ast.Name) and target.value.id not in self.local:
            known = outside.modules.get(target.value.id, {}).get(name)
            if known is None:
                self.refuse(node, f"a call of '{ast.unparse(target)}', which is unknown")
            self.text.declarations.add(known.declaration())
            return self.call(node, known)
        place, _, _ = self.field(target)
        signature = outside.pointers.get(name)
        if signature is None:
            self.refuse(node, f"a call of the field '{ast.unparse(target)}'")
        if name in outside.direct:
            signature = signature._replace(symbol=self.around.functions[outside.direct[name]].symbol)
            return self.call(node, signature)
        return self.call(node, signature, self.load(place, ADDRESS).text)

    def call(self, node: ast.Call, signature: Signature, pointer: str = "") -> Value | None:
        """Write a call of a function, by its name or through a pointer; None: it has no result."""
        if len(node.args) != len(signature.arguments):
            self.refuse(node, f"'{ast.unparse(node)}' with {len(node.args)} arguments")
        arguments = [
            f"{kind.ir} {self.convert(self.value(argument), kind, argument)}"
            for argument, kind in zip(node.args, signature.arguments, strict=True)
        ]
        code = f"call {signature.returns} {pointer or '@' + signature.symbol}({', '.join(arguments)})"
        if signature.result is None:
            self.text.do(code)
            return None
        return self.widened(Value(self.text.op(code), signature.result))

    def _call_sqrt(self, node: ast.Call) -> Value:
        return self._intrinsic(node, "sqrt", self.as_real(self._single(node)))

    def _call_floor(self, node: ast.Call) -> Value:
        return self._intrinsic(node, "floor", self.as_real(self._single(node)))

    def _call_of_mathematics(self, node: ast.Call) -> Value:
        """Call the C library's function, under the name that compiled models use."""
        assert isinstance(node.func, ast.Name)
        function = f"desire.{node.func.id}.1"
        self.text.declarations.add(f"declare double @{function}(double)")
        argument = self.as_real(self._single(node))
        return Value(self.text.op(f"call double @{function}(double {argument})"), REAL)

    _call_sin = _call_cos = _call_exp = _call_log = _call_atan = _call_tanh = _call_of_mathematics

    def _call_fused(self, node: ast.Call) -> Value:
        if len(node.args) != 3:
            self.refuse(node, f"'{ast.unparse(node)}' with {len(node.args)} arguments")
        a, b, c = (self.as_real(self.number(argument)) for argument in node.args)
        product = self.text.op(f"fmul contract double {a}, {b}")
        return Value(self.text.op(f"fadd contract double {product}, {c}"), REAL)

    def _call_abs(self, node: ast.Call) -> Value:
        value = self._single(node)
        if value.kind != REAL:
            self.refuse(node, "the magnitude of a whole number")
        return self._intrinsic(node, "fabs", value.text)

    def _single(self, node: ast.Call) -> Value:
        if len(node.args) != 1:
            self.refuse(node, f"'{ast.unparse(node)}' with {len(node.args)} arguments")
        return self.number(node.args[0])

    def _intrinsic(self, _node: ast.Call, name: str, argument: str) -> Value:
        self.text.declarations.add(f"declare double @llvm.{name}.f64(double)")
        return Value(self.text.op(f"call double @llvm.{name}.f64(double {argument})"), REAL)

    def _call_min(self, node: ast.Call) -> Value:
        return self._best(node, ast.Lt)

    def _call_max(self, node: ast.Call) -> Value:
        return self._best(node, ast.Gt)

    def _best(self, node: ast.Call, better: type[ast.cmpop]) -> Value:
        """Take another one only if it is truly better, as Python does."""
        if len(node.args) < 2:
            self.refuse(node, f"'{ast.unparse(node)}' with {len(node.args)} arguments")
        best, *others = [self.number(argument) for argument in node.args]
        for other in others:
            first, second, kind = self.alike(best, other)
            compare = f"fcmp {FLOATING[better]}" if kind == REAL else f"icmp {WHOLE[better]}"
            wins = self.text.op(f"{compare} {kind.ir} {second}, {first}")
            chosen = self.text.op(f"select i1 {wins}, {kind.ir} {second}, {kind.ir} {first}")
            best = Value(chosen, kind)
        return best

    def _call_copy(self, node: ast.Call) -> Value | None:
        if len(node.args) != 5:
            self.refuse(node, f"'{ast.unparse(node)}' with {len(node.args)} arguments")
        to, source = self.value(node.args[0]), self.value(node.args[2])
        if not to.kind.of or to.kind != source.kind:
            self.refuse(node, f"a copy from {source.kind} to {to.kind}")
        places = [
            self.text.op(f"getelementptr {array.kind.of}, ptr {array.text}, i64 {self.whole(first).text}")
            for array, first in ((to, node.args[1]), (source, node.args[3]))
        ]
        width = 4 if to.kind.of == "i32" else 8
        size = self.text.op(f"mul i64 {self.whole(node.args[4]).text}, {width}")
        self.text.declarations.add("declare void @llvm.memmove.p0.p0.i64(ptr, ptr, i64, i1)")
        self.text.do(
            f"call void @llvm.memmove.p0.p0.i64(ptr {places[0]}, ptr {places[1]}, i64 {size}, i1 false)"
        )
        return None
