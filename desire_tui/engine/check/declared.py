"""What a script declares and assigns, as far as its text shows: the names a segment may use.

Loops, branches and jumps are not followed: an assignment that *could* be executed before the segment's first
`drun` counts. Where the script jumps (`go to`) or stops (`STOP`: commands may follow), every assignment
counts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.check.data_columns import data_columns
from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.lowering.constant_values import evaluate
from desire_tui.engine.lowering.scope import UNKNOWN, StaticScope
from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.commands import Drun, Simple
from desire_tui.engine.nodes.control import GoTo, Procedure
from desire_tui.engine.nodes.declarations import Declare
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.nodes.lazy_parts import written_target
from desire_tui.engine.nodes.names import assigned, dummies, invocation
from desire_tui.engine.values import SYSTEM_SLOTS, SYSTEM_VARIABLES, Kind, Quantity
from desire_tui.engine.whole_numbers import whole

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.nodes.declarations import Declared, DeclaredGroup
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.program import Placed, Program, SegmentText
    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.structure.structure import Structure

_KINDS = {"ARRAY": Kind.REAL, "STATE": Kind.REAL, "INTEGER": Kind.INTEGER, "COMPLEX": Kind.COMPLEX}
ELEMENTS_MOST = 1 << 40
_STATEMENTS_AT_ONCE = 100
"""Between two points where the work can be broken off."""


@dataclass
class _Seen:
    """Names met so far along the script."""

    scalars: set[str] = field(default_factory=set)
    quantities: dict[str, Quantity] = field(default_factory=dict)


class DeclaredNames:
    """The names met on one walk over the script, with those known at each segment's first `drun`."""

    def __init__(self, program: Program, structure: Structure) -> None:
        self._program = program
        self._next = SYSTEM_SLOTS + (1 << 32)
        self._constants = _constants(program.script)
        self._body_lines = {id(p) for s in structure.submodels.values() for p in s.body}
        self._seen = _Seen()
        self._before: dict[str | None, set[str]] = {}
        self._walk(program.script)
        jumps = any(
            isinstance(p.node, GoTo) or (isinstance(p.node, Simple) and p.node.word in {"STOP", "go"})
            for p in program.script
        )
        if jumps:
            self._before.clear()
        self._by_segments = _assigned_in_segments(program, structure)
        self._columns = data_columns(program)
        unknown = self._columns.perhaps.difference(self.everything, structure.functions, structure.submodels)
        unknown -= set(SYSTEM_VARIABLES)
        for name in sorted(self._columns.names.union(unknown).difference(self._seen.quantities)):
            self._seen.quantities[name] = Quantity(name, self._next, (UNKNOWN,), of_file=True)
            self._next += 1

    @property
    def array_names(self) -> frozenset[str]:
        """Every array's name."""
        return frozenset(name for name, q in self._seen.quantities.items() if q.shape)

    @property
    def quantities(self) -> Mapping[str, Quantity]:
        """What is declared, by its name; a size that only a run knows is `UNKNOWN`."""
        return self._seen.quantities

    @property
    def names_taken(self) -> list[Diagnostic]:
        """Errors 73 for columns of data files that are called like something else."""
        return self._columns.taken

    @property
    def constants(self) -> Mapping[str, float]:
        """The scalars to which the script assigns a constant value, once."""
        return self._constants

    @property
    def everything(self) -> frozenset[str]:
        """Every name that some statement of the program assigns or declares."""
        return frozenset().union(self._seen.scalars, self._seen.quantities, *self._by_segments.values())

    def scope_for(self, text: SegmentText) -> StaticScope:
        """Return the names that `text` may use. Results of other segments count as the script's."""
        scalars = set(self._before.get(text.label, self._seen.scalars))
        for label, names in self._by_segments.items():
            if label != text.label:
                scalars |= names
        quantities = [
            Quantity(q.name, q.slot, q.shape, q.kind, q.is_state, q.of_file)
            for q in self._seen.quantities.values()
        ]
        return StaticScope(quantities, scalars, self._constants, self._next, self._columns.times)

    # ------------------------------------------------------------------------------------------ the walk

    def _walk(self, script: Iterable[Placed]) -> None:
        for placed in script:
            node = placed.node
            if id(placed) in self._body_lines:
                continue
            if isinstance(node, Drun):
                self._before.setdefault(node.label, set(self._seen.scalars))
            elif isinstance(node, Declare):
                for group in node.groups:
                    self._declare(node.kind, group)
            else:
                self._seen.scalars.update(_assigned_by(node))

    def _declare(self, kind: str, group: DeclaredGroup) -> None:
        first = self._next
        for part in group.parts:
            self._declare_part(kind, part)
        if group.whole is None:
            return
        last = self._next
        if len(group.parts) == 1 and len(group.parts[0].dimensions) > 1:
            quantity = self._seen.quantities[group.parts[0].name]
            size = UNKNOWN if UNKNOWN in quantity.shape else last - first
        else:
            sizes = [self._seen.quantities[p.name] for p in group.parts]
            size = UNKNOWN if any(UNKNOWN in q.shape for q in sizes) else last - first
        self._seen.quantities[group.whole] = Quantity(
            group.whole, first, (size,), _KINDS[kind], is_state=kind == "STATE"
        )

    def _declare_part(self, kind: str, part: Declared) -> None:
        shape = tuple(self._size(d) for d in part.dimensions)
        size = 1
        for n in shape:
            size *= max(n, 1)
        if size > ELEMENTS_MOST:
            shape, size = tuple(UNKNOWN for _ in shape), 1
        self._seen.quantities[part.name] = Quantity(
            part.name, self._next, shape, _KINDS[kind], is_state=kind == "STATE"
        )
        self._next += size
        if not shape and kind in {"INTEGER", "COMPLEX"}:
            self._seen.scalars.add(part.name)
        if kind == "COMPLEX":
            self._seen.scalars.add("j")

    def _size(self, node: Expr) -> int:
        value = _evaluate(node, self._constants)
        size = whole(value, 1, ELEMENTS_MOST) if value is not None else None
        return UNKNOWN if size is None else size


def _assigned_by(node: Statement) -> tuple[str, ...]:
    """Names that a script statement could give a value; a PROCEDURE's dummies get theirs from calls."""
    if isinstance(node, Procedure):
        return dummies(node)
    return tuple(target.name for target in assigned(node).targets)


def _assigned_in_segments(program: Program, structure: Structure) -> dict[str | None, set[str]]:
    bodies: set[str] = set()  # of all submodels: which of them a segment reaches is not looked for
    for submodel in structure.submodels.values():
        names: set[str] = set()
        for placed in submodel.body:
            _add_assigned(placed.node, names)
        bodies |= names.difference(submodel.dummies)
    found: dict[str | None, set[str]] = {}
    for segment in program.segments:
        names = found.setdefault(segment.label, set())
        invokes = False
        for number, placed in enumerate(segment.body):
            if number % _STATEMENTS_AT_ONCE == 0:
                cancellation_point()
            invokes |= _add_assigned(placed.node, names)
        if invokes:
            names |= bodies
    return found


def _add_assigned(node: Statement, names: set[str]) -> bool:
    """Add the names that a segment's statement could give a value; report whether it invokes a submodel.

    A submodel may assign its arguments.
    """
    known = written_target(node)
    if known is not None:
        names.add(known)
        return False
    targets = assigned(node).targets
    if targets:
        for target in targets:
            names.add(target.name)
        return False
    invoked = invocation(node)
    if invoked is None:
        return False
    names.update(argument.name for argument in invoked[1] if isinstance(argument, Name))
    return True


def _constants(script: Iterable[Placed]) -> dict[str, float]:
    """Scalars that the script assigns exactly once, and from constants: sizes mostly."""
    values: dict[str, float] = {}
    often: set[str] = set()
    for placed in script:
        node = placed.node
        names = _assigned_by(node)
        for name in names:
            if name in values or name in often:
                often.add(name)
                values.pop(name, None)
                continue
            value = None
            if isinstance(node, Assign) and isinstance(node.target, Name):
                value = _evaluate(node.value, values)
            if value is None:
                often.add(name)
            else:
                values[name] = value
    return values


def _evaluate(node: Expr, known: dict[str, float]) -> float | None:
    """Return the value of an expression of numbers and known scalars, None of any other."""
    try:
        return evaluate(node, lambda part: known.get(part.name) if isinstance(part, Name) else None)
    except (ArithmeticError, ValueError):
        return None
