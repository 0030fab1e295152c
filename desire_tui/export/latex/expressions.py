"""Expressions as LaTeX: fractions, roots, powers, cases for switches, vectors and matrices in bold."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.left_chains import chain
from desire_tui.engine.nodes.expressions import (
    Binary,
    Call,
    Element,
    Logical,
    Name,
    Not,
    Number,
    Pair,
    Relation,
    RowOf,
    Shifted,
    Text,
    Transposed,
    Truth,
    Unary,
)
from desire_tui.engine.nodes.signs import whole_literal
from desire_tui.export.latex.symbols import COMMA, escaped, number

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from desire_tui.engine.nodes.expressions import Condition, Expr
    from desire_tui.export.latex.symbols import Symbols

LOOSE, SUM, PRODUCT, POWER, ATOM = range(5)
"""How tightly a text binds: one that binds less than its place wants stands in parentheses."""
_NAMED = {
    "sin": r"\sin", "cos": r"\cos", "tan": r"\tan",
    "asin": r"\arcsin", "acos": r"\arccos", "atan": r"\arctan",
    "sinh": r"\sinh", "cosh": r"\cosh", "tanh": r"\tanh", "exp": r"\exp", "ln": r"\ln", "log": r"\log_{10}",
    "max": r"\max", "min": r"\min",
}  # fmt: skip
_POWERED = frozenset({"sin", "cos", "tan", "sinh", "cosh", "tanh"})
"""Functions whose powers are written `\\sin^2 x`."""
_RELATIONS = {"=": "=", "<": "<", ">": ">", "<=": r"\le", ">=": r"\ge", "<>": r"\ne"}
_OPPOSITE = {"=": r"\ne", "<": r"\ge", ">": r"\le", "<=": ">", ">=": "<", "<>": "="}


def parenthesised(text: str) -> str:
    """Return a text in parentheses of its height."""
    return rf"\left({text}\right)"


def cases(*rows: tuple[str, str]) -> str:
    """Return values with the conditions under which they hold."""
    return r"\begin{cases} " + r" \\ ".join(f"{value}, & {when}" for value, when in rows) + r" \end{cases}"


OTHERWISE = r"\text{otherwise}"


class Expressions:
    """Writes expressions. `ranks` are the numbers of dimensions of arrays by their names.

    `own` are the program's FUNCTIONs; `given` has what stands for the dummies of a submodel.
    """

    def __init__(
        self, symbols: Symbols, ranks: Mapping[str, int], own: frozenset[str], given: Mapping[str, Expr]
    ) -> None:
        self._symbols, self._ranks, self._own, self._given = symbols, ranks, own, given

    def within(self, given: Mapping[str, Expr]) -> Expressions:
        """Return the writer for the body of a submodel."""
        return Expressions(self._symbols, self._ranks, self._own, given)

    def within_function(self, dummies: Sequence[str]) -> Expressions:
        """Return the writer for the body of a FUNCTION, whose dummies are no arrays of the program."""
        ranks = {name: rank for name, rank in self._ranks.items() if name not in dummies}
        return Expressions(self._symbols, ranks, self._own, {})

    def dummy(self, name: str) -> str:
        """Return a FUNCTION's dummy as a symbol."""
        return self._symbols.symbol(name)

    def function(self, name: str) -> str:
        """Return a FUNCTION's name as a symbol."""
        return self._symbols.symbol(name)

    def stands_for(self, node: Expr) -> Expr:
        """Return an argument of a submodel: what an outer submodel's dummy stands for, or itself."""
        return self._given.get(node.name, node) if isinstance(node, Name) else node

    def name(self, name: str) -> str:
        """Return a name as a symbol, an array's in bold."""
        stands_for = self._given.get(name)
        if isinstance(stands_for, Name | Element):
            return Expressions(self._symbols, self._ranks, self._own, {}).write(stands_for)
        return self._symbols.symbol(name, bold=bool(self._ranks.get(name)))

    def element(self, name: str, subscript: str) -> str:
        """Return an array's element as a symbol."""
        stands_for = self._given.get(name)
        own = stands_for.name if isinstance(stands_for, Name) else name
        return self._symbols.symbol(own, [subscript])

    def rank(self, node: Expr) -> int:
        """Return how many dimensions a value has."""
        match node:
            case Name(name) | Transposed(name):
                stands_for = self._given.get(name)
                return self._ranks.get(stands_for.name if isinstance(stands_for, Name) else name, 0)
            case Shifted() | RowOf():
                return 1
            case Unary(_, operand):
                return self.rank(operand)
            case Call(name, args):
                return 0 if name == "func2" else max(map(self.rank, args[:1] or ()), default=0)
            case Binary("^", left, _):
                return self.rank(left)
            case Binary():
                first, steps = chain(node)
                rank = self.rank(first)
                for step in steps:
                    right = self.rank(step.right)
                    rank = right if (step.op, rank, right) == ("*", 2, 1) else max(rank, right)
                return rank
            case _:
                return 0

    def write(self, node: Expr, place: int = LOOSE, *, outer: bool = False) -> str:
        """Return an expression; `outer`: a product of vectors is a matrix, as in MATRIX and DELTA."""
        text, binds = self._text(node, outer=outer)
        return parenthesised(text) if binds < place else text

    def _text(self, node: Expr, *, outer: bool = False) -> tuple[str, int]:
        match node:
            case Number(value):
                text = number(value)
                return text, PRODUCT if r"\times" in text or text.startswith("-") else ATOM
            case Text(value):
                return rf"\text{{{escaped(value)}}}", ATOM
            case Name(name):
                return self.name(name), ATOM
            case Element(name, subscripts):
                stands_for = self._given.get(name)
                own = stands_for.name if isinstance(stands_for, Name) else name
                return self._symbols.symbol(own, [self.write(one) for one in subscripts]), ATOM
            case Call():
                return self._call(node)
            case Transposed(name):
                return rf"{self.name(name)}^{{\mathsf{{T}}}}", POWER
            case Shifted(name, by):
                return rf"\mathrm{{S}}^{{{self.write(by)}}} {self.name(name)}", PRODUCT
            case RowOf(name):
                return rf"\operatorname{{row}}\left({self.name(name)}\right)", POWER
            case Pair(re, im):
                return rf"{self.write(re, SUM)} + \mathrm{{j}}\,{self.write(im, PRODUCT)}", SUM
            case Truth(holds):
                return rf"\left[{self.condition(holds)}\right]", ATOM
            case Unary(op, operand):
                inner = self.write(operand, PRODUCT)
                return (f"-{inner}" if op == "-" else inner), SUM
            case Binary("^", left, right):
                return self._power(left, right)
            case Binary():
                return self._chain(node, outer=outer)
        assert_never(node)

    def _power(self, left: Expr, right: Expr) -> tuple[str, int]:
        exponent = self.write(right)
        whole = whole_literal(right)
        if isinstance(left, Call) and left.name in _POWERED and whole is not None and whole > 1:
            inside = self.write(left.args[0])
            return rf"{_NAMED[left.name]}^{{{exponent}}}\left({inside}\right)", POWER
        return f"{self.write(left, ATOM)}^{{{exponent}}}", POWER

    def _chain(self, node: Binary, *, outer: bool) -> tuple[str, int]:
        """Write a sum or product of any length."""
        first, steps = chain(node)
        is_negative = False
        while isinstance(first, Unary) and steps[0].op not in "+-":  # -k*x: of the whole product
            is_negative ^= first.op == "-"
            first = first.operand
        text, binds = self._text(first, outer=outer)
        rank = self.rank(first)
        for step in steps:
            right = self.rank(step.right)
            if step.op in "+-":
                text = text if binds >= SUM else parenthesised(text)
                text, is_negative = f"-{text}" if is_negative else text, False
                text, binds = f"{text} {step.op} {self.write(step.right, PRODUCT, outer=outer)}", SUM
            elif step.op == "/":
                text, binds = rf"\frac{{{text}}}{{{self.write(step.right)}}}", PRODUCT
            else:
                text = text if binds >= PRODUCT else parenthesised(text)
                factor = self.write(step.right, PRODUCT)
                text, binds = self._product(text, factor, step.op, rank, right, outer=outer), PRODUCT
            rank = right if (step.op, rank, right) == ("*", 2, 1) else max(rank, right)
        return (f"-{text}", SUM) if is_negative else (text, binds)

    @staticmethod
    def _product(left: str, right: str, op: str, ranks: int, other: int, *, outer: bool) -> str:
        if op == "&":
            return rf"\min\left({left},\, {right}^{{\mathsf{{T}}}}\right)"
        if (ranks, other) == (1, 1) and outer:
            return rf"{left}\,{right}^{{\mathsf{{T}}}}"
        if ranks == other and ranks > 0:
            return rf"{left} \odot {right}"
        return rf"{left} \cdot {right}" if right[:1].isdigit() else rf"{left}\,{right}"

    # ------------------------------------------------------------------------------------- functions

    def _call(self, node: Call) -> tuple[str, int]:
        name, args = node.name, node.args
        if name in self._own:
            return self.called(self._symbols.symbol(name), args), POWER
        if name in _NAMED:
            return self.called(_NAMED[name], args), POWER
        x = self.write(args[0]) if args else ""
        match name:
            case "sqrt":
                return rf"\sqrt{{{x}}}", ATOM
            case "abs":
                return rf"\left|{x}\right|", ATOM
            case "floor" | "ceil":
                return rf"\left\l{name} {x} \right\r{name}", ATOM
            case "lim":
                return rf"\max\left(0,\, {x}\right)", POWER
            case "sat" | "SAT":
                low = "-1" if name == "sat" else "0"
                return rf"\min\left(1,\, \max\left({low},\, {x}\right)\right)", POWER
            case "swtch" | "heav":
                return cases(("1", f"{x} > 0"), ("0", OTHERWISE)), LOOSE
            case "comp":
                minus, plus = self.write(args[1]), self.write(args[2])
                return cases((plus, f"{x} > 0"), (minus, OTHERWISE)), LOOSE
            case "rect":
                return cases(("1", rf"\left|{x}\right| < 1"), ("0", OTHERWISE)), LOOSE
            case "deadc":
                return cases(("-1", f"{x} < -1"), ("1", f"{x} > 1"), ("0", OTHERWISE)), LOOSE
            case "tri":
                return rf"1 - \left|{x}\right|", SUM
            case "recip":
                return rf"\frac{{1}}{{{x}}}", PRODUCT
            case "sigmoid":
                return rf"\frac{{1}}{{1 + \exp\left(-{self.write(args[0], PRODUCT)}\right)}}", PRODUCT
            case "func1" | "func2":
                return self._table(node), POWER
            case "delay":
                return self._delayed(args), POWER
        return self.called(rf"\operatorname{{{name}}}", args if name not in {"gauss", "ran"} else ()), POWER

    def called(self, function: str, args: Sequence[Expr]) -> str:
        """Return a function's name with its arguments."""
        return rf"{function}\left({COMMA.join(self.write(one) for one in args)}\right)"

    def _table(self, node: Call) -> str:
        """Return `F(x)` for `func1(x; F)`, `F(x, y)` for `func2(x, y; F, X, Y)`."""
        count = 1 if node.name == "func1" else 2
        table = node.args[count]
        function = self._symbols.symbol(table.name) if isinstance(table, Name) else self.write(table)
        return self.called(function, node.args[:count])

    def _delayed(self, args: Sequence[Expr]) -> str:
        return self.delayed(args[0], args[1])

    def delayed(self, source: Expr, tau: Expr) -> str:
        r"""Return what a quantity was: `x\left(t - \tau\right)`."""
        then = f"t - {self.write(tau, PRODUCT)}"
        if isinstance(source, Name | Element):
            return rf"{self.write(source)}\left({then}\right)"
        return rf"\left.{self.write(source, ATOM)}\right|_{{{then}}}"

    # ------------------------------------------------------------------------------------ conditions

    def condition(self, node: Condition, place: int = LOOSE) -> str:
        """Return a condition."""
        match node:
            case Relation(op, left, right):
                return f"{self.write(left, SUM)} {_RELATIONS[op]} {self.write(right, SUM)}"
            case Not(operand):
                return rf"\lnot {parenthesised(self.condition(operand))}"
            case Logical(op, left, right):
                own = PRODUCT if op == "and" else SUM
                sign = r"\land" if op == "and" else r"\lor"
                text = f"{self.condition(left, own)} {sign} {self.condition(right, own + 1)}"
                return parenthesised(text) if own < place else text
        assert_never(node)

    def positive(self, node: Expr) -> tuple[str, str]:
        """Return that a value is above 0, as `if e` and `term e` ask, and that it is not."""
        if isinstance(node, Truth):
            holds = node.condition
            if isinstance(holds, Relation):
                left, right = self.write(holds.left, SUM), self.write(holds.right, SUM)
                return self.condition(holds), f"{left} {_OPPOSITE[holds.op]} {right}"
            return self.condition(holds), rf"\lnot {parenthesised(self.condition(holds))}"
        text = self.write(node, SUM)
        return f"{text} > 0", rf"{text} \le 0"
