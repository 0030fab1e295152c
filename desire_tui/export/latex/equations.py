"""The lines of a segment as equations: groups that hold at different times, branches as cases."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.left_chains import chain
from desire_tui.engine.nodes.assignments import Assign, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Simple
from desire_tui.engine.nodes.control import If
from desire_tui.engine.nodes.display import Request, Show, ShowArea
from desire_tui.engine.nodes.expressions import Binary, Element, Name, Number
from desire_tui.engine.nodes.names import invocation
from desire_tui.engine.nodes.segment import (
    Delay,
    Derivative,
    Event,
    Every,
    FunctionTable,
    Get,
    Sample,
    Store,
    Term,
    TrackHold,
    VectorDerivative,
)
from desire_tui.engine.nodes.walk import walk
from desire_tui.export.latex.expressions import ATOM, OTHERWISE, PRODUCT, SUM, cases, parenthesised

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from desire_tui.engine.nodes.expressions import Expr, Target
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.structure.structure import SubmodelText
    from desire_tui.export.latex.expressions import Expressions

UNCHANGED = r"\text{unchanged}"
_BECOMES = r"\leftarrow"
_DT = r"\mathrm{d} t"


class Equation(NamedTuple):
    """`left relation right`."""

    left: str
    relation: str
    right: str


@dataclass
class Group:
    """Equations that hold at the same times; `when` says which, empty for always."""

    when: str = ""
    equations: list[Equation] = field(default_factory=list)


class _Branch(NamedTuple):
    """An open `if`: its condition and the opposite, as LaTeX."""

    holds: str
    fails: str
    is_else: bool = False

    @property
    def here(self) -> str:
        return self.fails if self.is_else else self.holds


class SegmentEquations:
    """Makes the equations of statements in the order of the text.

    `left_out` are statements that have no form as mathematics, `notes` sentences about signs that are used.
    """

    def __init__(self, submodels: Mapping[str, SubmodelText]) -> None:
        self._submodels = submodels
        self.groups = [Group()]
        self.left_out: list[Placed] = []
        self.notes: list[str] = []
        self._branches: list[_Branch] = []
        self._pending: dict[tuple[str, str], list[tuple[tuple[str, ...], str]]] = {}
        self._jumps = False
        """Whether assignments here are jumps of quantities that equations elsewhere move."""

    def add_all(self, statements: Iterable[Placed], writer: Expressions) -> None:
        """Add statements; an `if` that is open at the end ends there."""
        depth = len(self._branches)
        for placed in statements:
            self._add(placed, placed.node, writer)
        del self._branches[depth:]
        if not self._branches:
            self._flush()

    def _add(self, placed: Placed, node: Statement, writer: Expressions) -> None:
        write = writer.write
        match node:
            case Derivative(target, value):
                self._equation(rf"\frac{{\mathrm{{d}} {write(target)}}}{{{_DT}}}", "=", write(value))
            case VectorDerivative(name, value):
                self._equation(
                    rf"\frac{{\mathrm{{d}} {writer.name(name)}}}{{{_DT}}}", "=", write(value, outer=True)
                )
            case Assign(target, value):
                self._equation(write(target), self._relation(target.name, value), write(value))
            case VectorAssign() | MatrixAssign():
                self._array(node, writer)
            case Dot(target, value, average):
                self._equation(
                    write(target), self._relation(target.name, value), _dot(value, writer, average=average)
                )
            case Delay(variable, _, source, tau):
                self._equation(write(variable), "=", writer.delayed(source, tau))
            case FunctionTable(target, call):
                self._equation(write(target), "=", write(call))
            case TrackHold(held, tracked, control, value):
                self._track(held, tracked, control, value, writer)
            case Store(array, variable):
                self._note_points()
                self._equation(writer.element(array, "k"), _BECOMES, write(variable))
            case Get(variable, array):
                self._note_points()
                self._equation(write(variable), "=", writer.element(array, "k"))
            case Term(value):
                self.notes.append(f"The run ends when ${writer.positive(value)[0]}$.")
            case If(_, value) if value is not None:
                self._branches.append(_Branch(*writer.positive(value)))
            case Simple(word):
                self._word(word)
            case Sample(every):
                self._begin(f"At every ${write(every, PRODUCT)}$th sampling time:")
            case Event(value):
                self._begin(f"When ${write(value)}$ becomes positive:", jumps=True)
            case Every(period, first):
                begins = "0" if first is None else write(first)
                self._begin(f"At $t = {begins}$ and every ${write(period)}$ from then on:", jumps=True)
            case Request(kind) if kind != "recover":
                return
            case Show() | ShowArea():
                return
            case _:
                self._invoke(placed, node, writer)

    def _invoke(self, placed: Placed, node: Statement, writer: Expressions) -> None:
        """Add a submodel's equations for its arguments; note what is no equation."""
        invoked = invocation(node)
        submodel = self._submodels.get(invoked[0]) if invoked is not None else None
        if invoked is None or submodel is None:
            self.left_out.append(placed)
            return
        args = [writer.stands_for(one) for one in invoked[1]]
        self.add_all(submodel.body, writer.within(dict(zip(submodel.dummies, args, strict=False))))

    # ---------------------------------------------------------------------------------- one equation

    def _equation(self, left: str, relation: str, right: str) -> None:
        if not self._branches:
            self.groups[-1].equations.append(Equation(left, relation, right))
            return
        conditions = tuple(branch.here for branch in self._branches)
        self._pending.setdefault((left, relation), []).append((conditions, right))

    def _relation(self, name: str, value: Expr) -> str:
        """Return `=`, or that a quantity takes a new value, which its old one or a moment decides."""
        own = any(isinstance(part, Name | Element) and part.name == name for part in walk(value))
        return _BECOMES if own or self._jumps else "="

    def _array(self, node: VectorAssign | MatrixAssign, writer: Expressions) -> None:
        left, right = writer.name(node.name), writer.write(node.value, outer=isinstance(node, MatrixAssign))
        relation = self._relation(node.name, node.value)
        if node.delta:
            relation, right = (
                _BECOMES,
                f"{left} + {writer.write(node.value, PRODUCT, outer=isinstance(node, MatrixAssign))}",
            )
        if isinstance(node, VectorAssign) and node.largest:
            right = rf"\operatorname{{largest}}{parenthesised(right)}"
            self.notes.append(r"$\operatorname{largest}$ keeps the largest element and makes all others 0.")
        if node.lower is not None and node.upper is not None:
            low, high = writer.write(node.lower), writer.write(node.upper)
            right = rf"\min\left({high},\, \max\left({low},\, {right}\right)\right)"
        if node.mask is not None:
            mask = writer.name(node.mask)
            rows = ((right, f"{mask} = 0"), ("0", OTHERWISE))
            if isinstance(node, MatrixAssign):
                rows = ((right, rf"{mask} \ne 0"), (UNCHANGED, OTHERWISE))
            right = cases(*rows)
        self._equation(left, relation, right)

    def _track(self, held: Target, tracked: Target, control: Expr, value: Expr, writer: Expressions) -> None:
        self._branches.append(_Branch(*writer.positive(control)))
        self._equation(writer.write(held), _BECOMES, writer.write(tracked))
        self._equation(writer.write(tracked), _BECOMES, writer.write(value))
        self._branches.pop()
        if not self._branches:
            self._flush()

    def _note_points(self) -> None:
        note = "$k$ counts the sampling times."
        if note not in self.notes:
            self.notes.append(note)

    # ------------------------------------------------------------------------------ times and branches

    def _word(self, word: str) -> None:
        if word == "else" and self._branches:
            self._branches[-1] = self._branches[-1]._replace(is_else=True)
        elif word in {"end if", "proceed"} and self._branches:
            self._branches.pop()
            if not self._branches:
                self._flush()
        elif word == "OUT":
            self._begin("At sampling times:")
        elif word == "step":
            self._begin("At the start of each integration step:")
        elif word == "end event":
            self._begin("At all times:")

    def _begin(self, when: str, *, jumps: bool = False) -> None:
        self._flush()
        self._jumps = jumps
        self.groups.append(Group(when))

    def _flush(self) -> None:
        """Write what the branches that are closed assign, each quantity once."""
        for (left, relation), rows in self._pending.items():
            self.groups[-1].equations.append(Equation(left, relation, self._cases(rows)))
        self._pending.clear()

    def _cases(self, rows: list[tuple[tuple[str, ...], str]]) -> str:
        shown = [(value, r" \land ".join(conditions)) for conditions, value in rows]
        if len(rows) == 2 and all(len(conditions) == 1 for conditions, _ in rows):
            (first, _), (second, _) = rows
            if first != second:  # `if` and its `else`
                return cases(shown[0], (shown[1][0], OTHERWISE))
        return cases(*shown, (UNCHANGED, OTHERWISE))


def _dot(value: Expr, writer: Expressions, *, average: bool) -> str:
    """Return a sum of inner products: `u*v` is the transposed u times v, `u*1` the sum of all u."""
    first, steps = chain(value)
    terms: list[tuple[str, list[Expr]]] = [("", [first])]
    for step in steps:
        if step.op in "+-":
            terms.append((step.op, [step.right]))
        elif step.op == "*":
            terms[-1][1].append(step.right)
    pieces = []
    for sign, factors in terms:
        flat = [part for factor in factors for part in _factors(factor)]
        pieces.append(f" {sign} {_inner(flat, writer)}" if sign else _inner(flat, writer))
    text = "".join(pieces)
    return rf"\frac{{1}}{{n}}{parenthesised(text)}" if average else text


def _factors(node: Expr) -> list[Expr]:
    return [*_factors(node.left), node.right] if isinstance(node, Binary) and node.op == "*" else [node]


def _inner(factors: list[Expr], writer: Expressions) -> str:
    if isinstance(factors[-1], Number) and factors[-1].value == 1:
        summed = writer.write(factors[0], ATOM)
        return rf"\sum_{{i}} {parenthesised(summed) if '_' in summed else summed}_{{i}}"
    first, *rest = factors
    transposed = rf"{writer.write(first, PRODUCT)}^{{\mathsf{{T}}}}" if rest else writer.write(first, SUM)
    return r"\,".join([transposed, *(writer.write(one, PRODUCT) for one in rest)])
