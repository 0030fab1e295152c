"""From texts in plain Python to LLVM IR."""

from __future__ import annotations

import ast
import threading
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

from desire_tui.engine.codegen.ir.text import IrText
from desire_tui.engine.codegen.plain_python.expressions import Variable
from desire_tui.engine.codegen.plain_python.kinds import Signature, Value
from desire_tui.engine.codegen.plain_python.refusal import PlainPythonError
from desire_tui.engine.codegen.plain_python.statements import Statements
from desire_tui.engine.codegen.plain_python.surroundings import BUILTINS, Outside, Surroundings

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_HARMLESS = (ast.Import, ast.ImportFrom, ast.Assign, ast.AnnAssign, ast.Expr, ast.If)
"""At a module's top: they make the names that functions find in the module."""
_one_parse_at_a_time = threading.Lock()
"""Python 3.11 counts the depth of trees once for all threads: two at a time may end in a SystemError."""


class Module(NamedTuple):
    """A text and the names of its module: constants, types."""

    text: str | bytes
    names: Mapping[str, Any]


def write_program(
    modules: Iterable[Module],
    outside: Outside,
    prefix: str,
    public: frozenset[str] | None = None,
    rare: frozenset[str] = frozenset(),
) -> str:
    """Return the IR of all functions of modules that see each other; their names get a prefix.

    `public`: only these can be called from outside; LLVM puts others in line where they are called once.
    `rare`: these are called seldom, and never put in line: what calls them stays small enough to be.
    """
    found = [(node, module) for module in modules for node in _functions(module)]
    signatures: dict[str, Signature] = {}
    for node, module in found:
        if node.name in signatures or node.name in BUILTINS:
            _refuse(node, module, f"'{node.name}' once more")
        signatures[node.name] = _signature(node, module, outside, prefix)
    needs: dict[str, None] = {}
    texts = []
    for node, module in found:
        text = IrText()
        _write(node, signatures[node.name], Surroundings(outside, module.names, signatures), text)
        needs |= dict.fromkeys(sorted(text.declarations))
        texts.append(text)
    heads = (
        _head(signatures[node.name], public=public is None or node.name in public, rare=node.name in rare)
        for node, _ in found
    )
    return "\n".join((*needs, *(f"{h} {{\n{text.body()}\n}}" for h, text in zip(heads, texts, strict=True))))


def _functions(module: Module) -> Iterable[ast.FunctionDef]:
    with _one_parse_at_a_time:
        tree = ast.parse(module.text)
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            yield node
        elif not isinstance(node, _HARMLESS):
            _refuse(node, module, f"{type(node).__name__} outside functions")


def _signature(node: ast.FunctionDef, module: Module, outside: Outside, prefix: str) -> Signature:
    given = node.args
    others = (given.posonlyargs, given.kwonlyargs, given.vararg, given.kwarg, given.defaults)
    if any(others) or node.decorator_list or getattr(node, "type_params", None):
        _refuse(node, module, f"the head of '{node.name}'")
    kinds = []
    for argument in given.args:
        kind = outside.kind(argument.annotation)
        if kind is None or kind.ir == "i1":
            _refuse(argument, module, f"the type of '{argument.arg}' in '{node.name}'")
        kinds.append(kind)
    nothing = isinstance(node.returns, ast.Constant) and node.returns.value is None
    result = None if nothing else outside.kind(node.returns)
    if result is None and not nothing:
        _refuse(node, module, f"the type of the result of '{node.name}'")
    if result is not None and result.ir == "i1":
        _refuse(node, module, f"a truth value as the result of '{node.name}'")
    return Signature(prefix + node.name, result, tuple(kinds))


def _refuse(node: ast.AST, module: Module, what: str) -> NoReturn:
    raise PlainPythonError(f"{module.names.get('__name__', '')} line {getattr(node, 'lineno', '?')}: {what}")


def _head(signature: Signature, *, public: bool, rare: bool) -> str:
    arguments = ", ".join(f"{kind.ir} %a{k}" for k, kind in enumerate(signature.arguments))
    linkage, attributes = "" if public else "internal ", " cold noinline" if rare else ""
    return f"define {linkage}{signature.returns} @{signature.symbol}({arguments}){attributes}"


def _write(node: ast.FunctionDef, signature: Signature, around: Surroundings, text: IrText) -> None:
    body = Statements(around, node.name, text)
    body.result = signature.result
    names = (part for part in ast.walk(node) if isinstance(part, ast.Name))
    changed = {name.id for name in names if isinstance(name.ctx, ast.Store)}
    arguments = [argument.arg for argument in node.args.args]
    body.local = changed | set(arguments)
    body.assigned = set(arguments)
    for k, (name, declared) in enumerate(zip(arguments, signature.arguments, strict=True)):
        value = body.widened(Value(f"%a{k}", declared))
        if name in changed:
            cell = text.alloca(value.kind.ir)
            text.do(f"store {value.kind.ir} {value.text}, ptr {cell}")
            body.variables[name] = Variable(cell, "", value.kind)
        else:
            body.variables[name] = Variable("", value.text, value.kind)
    body.write_body(node)
