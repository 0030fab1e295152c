"""Expressions between two languages: what every reader makes and the writer writes.

Truth is a number here as in both languages: a relation is worth 1 or 0, and what is not 0 counts as true.
Functions are called by Desire's names (`ln`, `floor`, `sgn` …); a reader builds from them what its language
has beside.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

from desire_tui.engine.data_classes import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

Operator = Literal["+", "-", "*", "/", "^"]
Relational = Literal["=", "<>", "<", ">", "<=", ">="]


@dataclass(frozen=True, slots=True)
class Number:
    """A number, not negative; as the file spelled it, if it was spelled so that Desire reads it too."""

    value: float
    text: str = ""


@dataclass(frozen=True, slots=True)
class Name:
    """A quantity, or a function's dummy."""

    name: str


@dataclass(frozen=True, slots=True)
class Negative:
    """-x."""

    operand: Expression


@dataclass(frozen=True, slots=True)
class Binary:
    """Arithmetic of two operands."""

    operator: Operator
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class Relation:
    """A comparison, worth 1 or 0."""

    operator: Relational
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class Logical:
    """Both, or one of them at least: worth 1 or 0."""

    operator: Literal["and", "or"]
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class Not:
    """1 where the operand is 0, else 0."""

    operand: Expression


@dataclass(frozen=True, slots=True)
class Choice:
    """One expression where a condition holds, the other where it does not."""

    condition: Expression
    then: Expression
    otherwise: Expression


@dataclass(frozen=True, slots=True)
class Call:
    """A function of the library or of the model.

    A table is `func1` of a number and the table's name, an array's element `[]` of its name and a number.
    """

    function: str
    arguments: tuple[Expression, ...]


Expression: TypeAlias = Number | Name | Negative | Binary | Relation | Logical | Not | Choice | Call

ZERO, ONE = Number(0.0), Number(1.0)
TIME, PI, STEP = Name("<t>"), Name("<PI>"), Name("<DT>")
"""Desire's own quantities stand in angle brackets, so that a model may have some of these names."""
OWN_NAMES = frozenset({TIME.name, PI.name, STEP.name})


def number(value: float) -> Expression:
    """Return a number of any sign."""
    return Number(value) if value >= 0 else Negative(Number(-value))


def parts(expression: Expression) -> tuple[Expression, ...]:
    """Return the expressions that it is directly made of."""
    match expression:
        case Number() | Name():
            return ()
        case Negative(operand) | Not(operand):
            return (operand,)
        case Choice(condition, then, otherwise):
            return (condition, then, otherwise)
        case Call(_, arguments):
            return arguments
        case Binary() | Relation() | Logical():
            return (expression.left, expression.right)


def with_parts(expression: Expression, change: Callable[[Expression], Expression]) -> Expression:
    """Return it with each of its direct parts changed."""
    match expression:
        case Number() | Name():
            return expression
        case Negative(operand) | Not(operand):
            return replace(expression, operand=change(operand))
        case Choice(condition, then, otherwise):
            return Choice(change(condition), change(then), change(otherwise))
        case Call(function, arguments):
            return Call(function, tuple(change(argument) for argument in arguments))
        case Binary() | Relation() | Logical():
            return replace(expression, left=change(expression.left), right=change(expression.right))


def walk(expression: Expression) -> Iterator[Expression]:
    """Yield it and everything that it is made of."""
    rest = [expression]
    while rest:
        one = rest.pop()
        yield one
        rest.extend(parts(one))


def names_in(expression: Expression) -> set[str]:
    """Return the quantities that it reads, without what functions read beside their arguments."""
    return {one.name for one in walk(expression) if isinstance(one, Name)}


def functions_in(expression: Expression) -> set[str]:
    """Return the functions that it calls."""
    return {one.function for one in walk(expression) if isinstance(one, Call)}


def substituted(expression: Expression, values: Mapping[str, Expression]) -> Expression:
    """Return it with expressions in the place of names."""
    if isinstance(expression, Name):
        return values.get(expression.name, expression)
    return with_parts(expression, lambda part: substituted(part, values))


def total(terms: list[Expression]) -> Expression:
    """Return the sum; 0 of none."""
    if not terms:
        return ZERO
    result = terms[0]
    for term in terms[1:]:
        result = (
            Binary("-", result, term.operand) if isinstance(term, Negative) else Binary("+", result, term)
        )
    return result


def product(left: Expression, right: Expression) -> Expression:
    """Return the product; factors of 1 are left out."""
    if _is_one(left):
        return right
    if _is_one(right):
        return left
    return Binary("*", left, right)


def quotient(left: Expression, right: Expression) -> Expression:
    """Return the quotient; a divisor of 1 is left out."""
    return left if _is_one(right) else Binary("/", left, right)


def _is_one(expression: Expression) -> bool:
    return isinstance(expression, Number) and expression.value == 1
