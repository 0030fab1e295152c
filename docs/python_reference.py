"""docs/python_reference.md: everything public of `import desire_tui`, from signatures and docstrings."""

from __future__ import annotations

import ast
import inspect
import re
from itertools import pairwise
from textwrap import dedent
from typing import TYPE_CHECKING, Any

import desire_tui
from desire_tui.api.block import Block
from desire_tui.api.equations import JacobianMatrix, RightHandSide
from desire_tui.api.whole_program import RunSettings

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

INTRODUCTION = """\
What `import desire_tui` offers, one entry each; [From Python](python.md) shows how it is used. Numbers are NumPy's `float64`, names
are as in the program, elements of arrays are `"a[2]"`, from 1."""  # noqa: E501 - a paragraph of the page
FUNCTIONS = (desire_tui.load, desire_tui.run, desire_tui.study, desire_tui.analyse)
CLASSES = (
    desire_tui.Model, desire_tui.Run, desire_tui.Result, desire_tui.Simulation, desire_tui.Snapshot,
    RightHandSide, JacobianMatrix, Block, desire_tui.DesireError, desire_tui.Session,
)  # fmt: skip
_WIDTH = 100


def python_reference(note: str) -> str:
    """Return the page."""
    parts = ["# Python reference", note, INTRODUCTION]
    parts += ["## Functions", *(_function(f"desire_tui.{f.__name__}", f, "###") for f in FUNCTIONS)]
    settings = ", ".join(f"`{name}: {_plain(kind)}`" for name, kind in RunSettings.__annotations__.items())
    parts.append(f"`RunSettings` are {settings}.")
    parts += [part for kind in CLASSES for part in _class(kind)]
    return "\n\n".join(parts) + "\n"


def _plain(annotation: Any) -> str:
    return re.sub(r"ForwardRef\('(.*?)'.*\)", r"\1", str(annotation))


def _class(kind: type) -> Iterator[str]:
    yield f"## {kind.__name__}"
    yield _text(kind)
    attributes = list(dict(_attributes(kind)).items())
    if attributes:
        rows = [f"| `{name}` | {_line(text)} |" for name, text in attributes]
        yield "\n".join(("| attribute | what it is |", "| --- | --- |", *rows))
    for name, member in _members(kind):
        if inspect.isfunction(member):
            yield _function(name, member, "###")


def _members(kind: type) -> Iterator[tuple[str, Any]]:
    """Yield public members with a docstring, those of private bases too, in the order of the text."""
    bases = [base for base in kind.__mro__ if base is kind or base.__name__.startswith("_")]
    for base in bases:
        for name, member in vars(base).items():
            if (not name.startswith("_") or name in {"__call__", "__getitem__"}) and inspect.getdoc(member):
                yield name, member


def _attributes(kind: type) -> Iterator[tuple[str, str]]:
    """Yield properties, and what is assigned in the class or its `__init__` with a text below it."""
    for name, member in _members(kind):
        if isinstance(member, property):
            yield name, inspect.getdoc(member) or ""
    tree = ast.parse(dedent(inspect.getsource(kind))).body[0]
    assert isinstance(tree, ast.ClassDef)
    bodies = [
        tree.body,
        *(n.body for n in tree.body if isinstance(n, ast.FunctionDef) and n.name == "__init__"),
    ]
    for body in bodies:
        for statement in ast.walk(ast.Module(body, [])):
            below = getattr(statement, "body", None)
            if isinstance(below, list):
                yield from _documented(below)


def _documented(body: list[ast.stmt]) -> Iterator[tuple[str, str]]:
    for here, below in pairwise(body):
        if not isinstance(here, ast.Assign | ast.AnnAssign) or not isinstance(below, ast.Expr):
            continue
        if isinstance(below.value, ast.Constant) and isinstance(below.value.value, str):
            target = here.targets[0] if isinstance(here, ast.Assign) else here.target
            name = target.attr if isinstance(target, ast.Attribute) else getattr(target, "id", "_")
            if not name.startswith("_"):
                yield name, below.value.value


class _Raw:
    """An annotation as it is written."""

    def __init__(self, text: Any) -> None:
        self._text = text if isinstance(text, str) else inspect.formatannotation(text)

    def __repr__(self) -> str:
        return self._text


def _function(name: str, function: Callable[..., Any], level: str) -> str:
    signature = inspect.signature(function)
    own = [parameter for name, parameter in signature.parameters.items() if name != "self"]
    kept = [parameter.replace(annotation=_Raw(parameter.annotation)) for parameter in own]
    shown = str(signature.replace(parameters=kept, return_annotation=_Raw(signature.return_annotation)))
    titles = {"__getitem__": "[name]", "__call__": "f(t, x)"}
    if name == "__getitem__":
        head = f"[name]{shown.partition(')')[2]}"
    else:
        head = f"{'f' if name == '__call__' else name.rpartition('.')[2]}{shown}"
    return f"{level} {titles.get(name, name)}\n\n```text\n{_folded(head)}\n```\n\n{_text(function)}"


def _folded(head: str) -> str:
    """Break a signature that is too long: an argument a line."""
    if len(head) <= _WIDTH:
        return head
    name, _, rest = head.partition("(")
    arguments, _, result = rest.rpartition(")")
    parts = re.split(r", (?![^\[(]*[\])])", arguments)
    return f"{name}(\n" + "".join(f"    {part},\n" for part in parts) + f"){result}"


def _text(thing: Any) -> str:
    """Return a docstring as Markdown."""
    return inspect.getdoc(thing) or ""


def _line(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
