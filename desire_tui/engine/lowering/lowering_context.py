"""Where the lowering stands: the place in the text, the names that hold here, the problems found so far."""

from __future__ import annotations

from abc import ABC, abstractmethod
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.data_classes import dataclass, replace
from desire_tui.engine.diagnostics import Diagnostic, closest
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.lowered.expressions import Const, Load
from desire_tui.engine.lowered.statements import Where
from desire_tui.engine.lowering.persistence import Flow
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.source import Source, Span
from desire_tui.engine.values import Kind, Quantity

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from desire_tui.engine.lowered.expressions import Value
    from desire_tui.engine.lowered.segment import Breakpoints, DelayedValue, StateRange
    from desire_tui.engine.lowered.statements import Action
    from desire_tui.engine.lowering.scope import SegmentScope
    from desire_tui.engine.nodes.declarations import Function
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.record import Node

Extent = tuple[int, ...]
"""What is computed: a scalar `()`, a vector of n elements `(n,)` or a matrix `(m, n)`."""

SCALAR: Extent = ()

BAD = Const(0.0)
"""Stands for an expression with a problem that has been reported."""

DEPTH_MAX = 60
"""Nested FUNCTION calls and invocations; deeper ones are recursion in all but name."""

EXPANSIONS_MOST = 20_000
"""FUNCTION calls that one segment may expand: 20 FUNCTIONs that each call the next twice make a million."""

PLACES_MOST = 4
"""Places that a message names besides its own: the nearest uses, and the line of the segment."""


@dataclass
class Argument:
    """An argument of a FUNCTION being expanded: lowered at its first use, then shared by all uses.

    `outer` is the frame in which its text `node` stands.
    """

    node: Expr
    outer: ExpansionFrame
    value: Value | None = None


UNKNOWN_SLOT = -1
_NO_NAMES: Mapping[str, str] = {}
_NO_ARGUMENTS: Mapping[str, Argument] = {}


class ExpansionFrame(NamedTuple):
    """How names read in the text being lowered: dummies stand for something else.

    `at` is the offset of the statement's raw text in the source; `rename` gives a submodel's dummies their
    actual names, `arguments` a FUNCTION's its arguments. `invoked` are the places of the invocations and
    calls that led here, the innermost last, `calls` the names of the FUNCTIONs among them.
    """

    at: int
    rename: Mapping[str, str] = _NO_NAMES
    arguments: Mapping[str, Argument] = _NO_ARGUMENTS
    invoked: tuple[Span, ...] = ()
    calls: tuple[str, ...] = ()


@dataclass(frozen=True)
class FunctionText:
    """A FUNCTION statement and the offset of its raw text."""

    node: Function
    at: int


class LoweringContext(ABC):
    """State shared by everything that lowers one segment.

    What lowers parts of an expression calls `lower` for the operands (see `expressions`).

    `assigned` holds the place of the first assignment to each scalar of the segment.
    """

    def __init__(self, scope: SegmentScope, source: Source, functions: Mapping[str, FunctionText]) -> None:
        self.scope = scope
        self.source = source
        self.functions = functions
        self.flow = Flow()
        self.frame = ExpansionFrame(0)
        self.plain = True
        """Names read as they are written: the frame replaces none."""
        self.problems: list[Diagnostic] = []
        self.assigned: dict[str, tuple[Span, ...]] = {}
        self.plain_states: dict[int, StateRange] = {}
        """A segment's states, where all are plain (`plain_lines`), by the ids of their `d/dt` lines."""
        self.reads_as_written = False
        """Whether all names of all lines stand for themselves: no submodel, no library function redefined."""
        self.assigned_arrays = False
        self.expansions = 0
        self.assigned_scalar: str | None = None
        """The scalar that the present statement assigns."""
        self.assigned_slots: tuple[int, int] | None = None
        """Slots of the array that the present statement assigns; None where it may be read freely."""
        self.assigned_array = ""
        """Its name."""
        self.reported: set[str] = set()
        self.reads: dict[str, int] = {}
        """Names that the expression being lowered has read, and their slots; UNKNOWN_SLOT for a name that was
        not ready to be read, and under "" for what is more than reading a name."""
        self.row_chosen: Where | None = None
        """Where a row `P#` is read first, if the segment leaves iRow to the script."""
        self.row_read: Where | None = None
        """Where the present statement reads a row `P#` that the segment itself chooses."""
        self.breakpoints: list[Breakpoints] = []
        self.computed_first: list[Action] = []
        """What the present statement computes first: the pieces of its long chains (`long_chains`)."""
        self.delays: list[DelayedValue] = []
        """What `delay(x, tau)` remembers."""
        self.rule: int | None = None
        """The integration rule, 0 without states; None: not known yet."""
        self.redefines_library = not functions.keys().isdisjoint(LIBRARY)

    @abstractmethod
    def lower(self, node: Expr, extent: Extent = SCALAR) -> Value:
        """Return the value of an expression over `extent`; problems are noted."""

    def enter(self, frame: ExpansionFrame) -> None:
        """Go on in another text."""
        self.frame = frame
        self.plain = not (frame.rename or frame.arguments)

    # ------------------------------------------------------------------------------------------ places

    def span(self, part: Node) -> Span:
        """Place of a part of the statement being lowered."""
        return Span(self.frame.at + part.start, self.frame.at + part.end)

    def where(self, part: Node) -> Where:
        """Place for a lowered statement."""
        frame = self.frame
        return Where(
            Span(frame.at + part.start, frame.at + part.end), frame.invoked[0] if frame.invoked else None
        )

    def report(self, key: str, part: Node | Span, **facts: object) -> Const:
        """Note a problem; the result stands for the expression that cannot be lowered."""
        span = part if isinstance(part, Span) else self.span(part)
        if isinstance(part, Name) and span.end - span.start > len(part.name):
            span = self.source.name_within(span, part.name)  # a statement that keeps the name alone
        self.add(Diagnostic(key, span, facts, self.source))
        return BAD

    def add(self, problem: Diagnostic) -> None:
        """Note a problem of the text being lowered, and the invocations and calls that led there."""
        places = self.frame.invoked[::-1]
        if len(places) > PLACES_MOST:
            places = (*places[: PLACES_MOST - 1], places[-1])
        related = tuple(Diagnostic("expanded-here", s, {}, self.source) for s in places)
        self.problems.append(replace(problem, related=(*problem.related, *related)) if related else problem)

    def first_report(self, name: str) -> bool:
        """Whether no problem with this name has been reported yet; from now on one has."""
        if name in self.reported:
            return False
        self.reported.add(name)
        return True

    # ------------------------------------------------------------------------------------------ names

    def actual(self, name: str) -> str:
        """Return what a name of the text stands for: itself, or the argument given for a dummy."""
        frame = self.frame
        while name in frame.arguments:
            argument = frame.arguments[name]
            if not isinstance(argument.node, Name):
                return name
            name, frame = argument.node.name, argument.outer
        return frame.rename.get(name, name)

    def quantity(self, name: str) -> Quantity | None:
        """Return the quantity a name of the text stands for."""
        return self.scope.names.get(self.actual(name))

    def read(self, node: Name) -> Value:
        """Read a scalar. Reports errors 200, 69, 218."""
        name = self.actual(node.name)
        load = self.flow.ready.get(name)
        if load is not None:
            return load
        quantity = self.scope.names.get(name)
        if quantity is not None and quantity.shape:
            return self.report("array-as-number", node, name=name)
        if quantity is not None and quantity.kind is Kind.COMPLEX:
            return self.report("complex-in-dynamic", node, name=name)
        if quantity is None or not self.scope.is_defined(quantity):
            return self._undefined(node, name, quantity)
        load = Load(quantity.slot)
        if name in self.assigned:
            self.flow.read_slot(quantity.slot)
        else:
            self.flow.ready[name] = load
        return load

    def _undefined(self, node: Name, name: str, quantity: Quantity | None) -> Value:
        places = self.assigned.get(name)
        if places is None:
            if not self.first_report(name):
                return BAD
            if name in LIBRARY:
                self.report("function-without-arguments", node, name=name)
            else:
                close = closest(name, self.known_names(name))
                self.report("undefined-in-segment", node, name=name, close=close)
            return BAD
        if name == self.assigned_scalar and quantity is not None:
            # difference equation x = x + e whose target is new: starts at 0 [O]
            self.flow.read_slot(quantity.slot)
            return Load(quantity.slot)
        if self.first_report(name):
            line = self.source.position(places[0].start).row
            self.report("used-before-set", node, name=name, line=line)
        return BAD

    def known_names(self, but: str) -> Iterator[str]:
        """Yield the names of scalars and arrays other than `but`."""
        return (name for name in chain(self.scope.names, self.assigned) if name != but)

    def known_function(self, name: str) -> bool:
        """Whether `name` can be called in a segment."""
        return name in self.functions or (name in LIBRARY and "D" in LIBRARY[name].where)
