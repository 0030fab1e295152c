"""Values that a front end sets in place of the script's own: `--set`, sliders of live mode.

A setting's name is that of a scalar, `a`, or of an array's element, `a[2]`, `A[1,3]`. The program is changed:
assignments of such a scalar give it the setting's value, and behind each other script statement that could
give it or its array a value (ARRAY, read, input, MATRIX, call …) stands an assignment of the setting.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics import Diagnostic, closest
from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.control import For
from desire_tui.engine.nodes.declarations import Declare
from desire_tui.engine.nodes.expressions import Element, Name, Number
from desire_tui.engine.nodes.files import Input
from desire_tui.engine.nodes.names import assigned, declared, dummies
from desire_tui.engine.nodes.program import Placed
from desire_tui.engine.whole_numbers import WHOLE_MOST

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from desire_tui.engine.nodes.program import Program
    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.structure.structure import Structure

_FORM = re.compile(r"\s*([A-Za-z][\w$]*)\s*(?:\[\s*(\d+(?:\s*,\s*\d+)*)\s*\])?\s*", re.ASCII)
WORD = re.compile(r"[A-Za-z][\w$]*")
"""A name, or a part of a text that may be one."""


def name_and_subscripts(setting: str) -> tuple[str, tuple[int, ...]]:
    """Return name and subscripts of `a` or `A[1,3]`. ValueError: it is neither."""
    found = _FORM.fullmatch(setting)
    if found is None:
        raise ValueError(setting)
    subscripts = found[2]
    return found[1], tuple(map(_subscript, subscripts.split(","))) if subscripts else ()


def _subscript(digits: str) -> int:
    """Return a subscript that no array has instead of one that no number holds."""
    digits = digits.strip().lstrip("0") or "0"
    return int(digits) if len(digits) <= len(str(WHOLE_MOST)) else WHOLE_MOST


def initial_values(program: Program, overrides: Mapping[str, float]) -> dict[str, float]:
    """Return the scalars that have a value before the script begins: all that it does not declare."""
    names = {name for p in program.script if isinstance(p.node, Declare) for name in declared(p.node)}
    return {name: value for name, value in _scalars(overrides).items() if name not in names}


def with_overrides(program: Program, structure: Structure, overrides: Mapping[str, float]) -> Program:
    """Return the program with the settings in place of the script's own values."""
    if not overrides:
        return program
    changer = _Changer(program, overrides)
    changer.leave_bodies(program, structure)
    script = [new for placed in program.script for new in changer.statement(placed)]
    return replace(program, script=tuple(script))


def problems_of(program: Program, structure: Structure, overrides: Mapping[str, float]) -> list[Diagnostic]:
    """Return errors 409, 55, 73: settings of names that the program does not know or that take no value."""
    from desire_tui.engine.check.declared import DeclaredNames
    from desire_tui.engine.syntax.words import KEYWORDS
    from desire_tui.engine.values import SYSTEM_VARIABLES

    survey = DeclaredNames(program, structure)
    words = set(WORD.findall(program.source.text)) - KEYWORDS.keys()
    known = {*survey.everything, *SYSTEM_VARIABLES, *words}
    problems = []
    for setting in overrides:
        name, subscripts = name_and_subscripts(setting)
        facts = {"name": name, "setting": setting, "close": None}
        if name not in known:
            facts["close"] = closest(name, known)
            problems.append(Diagnostic("set-unknown", None, facts, program.source))
        elif name == "PI":
            problems.append(Diagnostic("constant-assigned", None, facts, program.source))
        elif name in structure.functions or name in structure.procedures:
            facts["what"] = "a FUNCTION" if name in structure.functions else "a PROCEDURE"
            problems.append(Diagnostic("name-of-something-else", None, facts, program.source))
        elif (name in survey.array_names) != bool(subscripts):
            key = "set-no-array" if subscripts else "set-array"
            problems.append(Diagnostic(key, None, facts, program.source))
    return problems


def _scalars(overrides: Mapping[str, float]) -> dict[str, float]:
    return {name: value for name, value in overrides.items() if "[" not in name}


class _Changer:
    def __init__(self, program: Program, overrides: Mapping[str, float]) -> None:
        self._scalars = _scalars(overrides)
        self._settings: dict[str, list[tuple[tuple[int, ...], float]]] = {}
        for setting, value in overrides.items():
            name, subscripts = name_and_subscripts(setting)
            self._settings.setdefault(name, []).append((subscripts, value))
        self._same = _overlays(program)
        self._hidden: dict[int, frozenset[str]] = {}

    def leave_bodies(self, program: Program, structure: Structure) -> None:
        """Note where names mean something else: dummies of PROCEDUREs; bodies of SUBMODELs are no script."""
        every = frozenset(self._settings)
        for submodel in structure.submodels.values():
            self._hidden.update((id(placed), every) for placed in submodel.body)
        for procedure in structure.procedures.values():
            inner = frozenset(dummies(procedure.node))
            body = program.script[procedure.opens : procedure.closes + 1]
            self._hidden.update((id(placed), inner) for placed in body)

    def statement(self, placed: Placed) -> Iterator[Placed]:
        """Yield the statements that stand in place of one."""
        hidden = self._hidden.get(id(placed), frozenset())
        node = placed.node
        if isinstance(node, Assign) and isinstance(node.target, Name):
            value = None if node.target.name in hidden else self._scalars.get(node.target.name)
            if value is not None:
                number = Number(value, node.value.start, node.value.end)
                placed = placed._replace(node=Assign(node.target, number, node.start, node.end))
            yield placed
            return
        names = [name for name in self._written(node) if name in self._settings and name not in hidden]
        if not self._only_asks_for(node, names):
            yield placed
        for name in names:
            for subscripts, value in self._settings[name]:
                yield Placed(_assignment(node, name, subscripts, value), placed.at)

    def _written(self, node: Statement) -> list[str]:
        """Return the names that a statement could give a value, with all that share memory with them."""
        found: dict[str, None] = {}
        for name in _written(node):
            found.update(dict.fromkeys(self._same.get(name, (name,))))
        return list(found)

    def _only_asks_for(self, node: Statement, names: list[str]) -> bool:
        """Whether an `input` asks for nothing but what is set anyway."""
        return (
            isinstance(node, Input)
            and node.channel is None
            and all(isinstance(t, Name) and t.name in self._scalars and t.name in names for t in node.targets)
        )


def _assignment(node: Statement, name: str, subscripts: tuple[int, ...], value: float) -> Assign:
    start, end = node.start, node.end
    target: Name | Element = Name(name, start, end)
    if subscripts:
        target = Element(name, tuple(Number(float(s), start, end) for s in subscripts), start, end)
    return Assign(target, Number(value, start, end), start, end)


def _written(node: Statement) -> tuple[str, ...]:
    """Return the names that a statement could give a value; the variable of a loop must be left to it."""
    if isinstance(node, Declare):
        return declared(node)
    if isinstance(node, For):
        return ()
    found = assigned(node)
    return (*(target.name for target in found.targets), *found.arrays)


def _overlays(program: Program) -> dict[str, list[str]]:
    """Return for each name of an overlay all names that share its memory."""
    found: dict[str, list[str]] = {}
    for placed in program.script:
        if isinstance(placed.node, Declare):
            for group in placed.node.groups:
                if group.whole is not None:
                    names = [group.whole, *(part.name for part in group.parts)]
                    found.update(dict.fromkeys(names, names))
    return found
