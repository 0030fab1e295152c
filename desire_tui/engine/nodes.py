"""The nodes of a parsed program: what the user wrote, nothing more.

Offsets `start` and `end` of a node count from the start of **its statement's raw text**, so that a parsed
statement can be kept by its text and used again wherever it stands; `Placed.at` is the offset of that raw
text in the source. Two nodes are equal when they say the same, wherever they stand.
"""

from __future__ import annotations

from dataclasses import MISSING, Field, dataclass, field
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeVar, dataclass_transform

from desire_tui.engine.source import Source, Span

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic

T = TypeVar("T")


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def node(cls: type[T]) -> type[T]:
    """Make a slotted record class with the methods of a dataclass, frozen for the type checker only.

    Why not `dataclass(slots=True)`: its generated methods for these 63 classes cost 40 ms at every start,
    so here `__init__` is generated when a class is first used. Freezing at run time would cost another 1.5
    µs a node.
    """
    own = dict(vars(cls))
    names = tuple(own.get("__annotations__", ()))
    defaults = {name: own.pop(name) for name in names if name in own}
    specified = {name: value for name, value in defaults.items() if isinstance(value, Field)}
    for unwanted in ("__dict__", "__weakref__"):
        own.pop(unwanted, None)
    own.update(
        __slots__=names,
        __match_args__=names,
        __init__=_first_init,
        __eq__=_equal,
        __repr__=_shown,
        __hash__=None,
        _defaults_=defaults,
        _compared_=tuple(name for name in names if name not in specified or specified[name].compare),
        _shown_=tuple(name for name in names if name not in specified or specified[name].repr),
    )
    made: type[T] = type(cls.__name__, cls.__bases__, own)
    return made


def _first_init(self: Any, *args: object, **kwargs: object) -> None:
    """Generate the class's `__init__`, put it in this one's place, and call it."""
    cls = type(self)
    parameters: list[str] = []
    body: list[str] = []
    scope: dict[str, Any] = {"MISSING": MISSING}
    for name in cls.__slots__:
        value: Any = cls._defaults_.get(name, MISSING)
        if isinstance(value, Field):
            if value.default_factory is not MISSING:
                scope[f"_{name}"] = value.default_factory
                parameters.append(f"{name}=MISSING")
                body.append(f"self.{name} = _{name}() if {name} is MISSING else {name}")
                continue
            value = value.default
        if value is MISSING:
            parameters.append(name)
        else:
            scope[f"_{name}"] = value
            parameters.append(f"{name}=_{name}")
        body.append(f"self.{name} = {name}")
    exec(f"def __init__(self, {', '.join(parameters)}):\n " + "\n ".join(body or ["pass"]), scope)  # noqa: S102
    cls.__init__ = scope["__init__"]
    cls.__init__(self, *args, **kwargs)


def _equal(self: Any, other: Any) -> bool:
    if type(self) is not type(other):
        return NotImplemented  # type: ignore[no-any-return]
    return all(getattr(self, name) == getattr(other, name) for name in self._compared_)


def _shown(self: Any) -> str:
    return f"{type(self).__name__}({', '.join(f'{name}={getattr(self, name)!r}' for name in self._shown_)})"


class Node:
    """Anything with a place in its statement."""

    __slots__ = ()
    start: int
    end: int


def _at() -> int:
    return field(default=0, compare=False, repr=False)


class Placed(NamedTuple):
    """A statement, the offset of its raw text in the source, its line number if the file carries numbers."""

    node: Statement
    at: int
    number: int | None = None

    def span(self, part: Node | None = None) -> Span:
        """Place in the source of the statement or of a part of it."""
        part = part or self.node
        return Span(self.at + part.start, self.at + part.end)


# --------------------------------------------------------------------------------------------- expressions


@node
class Number(Node):
    """A numeric literal (decimal, `&` octal, `&&` hexadecimal)."""

    value: float
    start: int = _at()
    end: int = _at()


@node
class Text(Node):
    """A quoted string, without its quotes."""

    value: str
    start: int = _at()
    end: int = _at()


@node
class Name(Node):
    """A name read or assigned: scalar or whole array."""

    name: str
    start: int = _at()
    end: int = _at()


@node
class Element(Node):
    """A subscripted name, `A[i, k]`."""

    name: str
    subscripts: tuple[Expr, ...]
    start: int = _at()
    end: int = _at()


@node
class Call(Node):
    """`f(a, b)`: library function, FUNCTION, or (as a statement in a segment) a submodel invocation.

    `$In` and `$Tr` of MATRIX statements are calls of those names.
    """

    name: str
    args: tuple[Expr, ...]
    start: int = _at()
    end: int = _at()


@node
class Unary(Node):
    """A sign."""

    op: Literal["-", "+"]
    operand: Expr
    start: int = _at()
    end: int = _at()


@node
class Binary(Node):
    """Two operands; `&` only in MATRIX and DELTA terms (`u & v`)."""

    op: Literal["+", "-", "*", "/", "^", "&"]
    left: Expr
    right: Expr
    start: int = _at()
    end: int = _at()


@node
class Transposed(Node):
    """`A%`."""

    name: str
    start: int = _at()
    end: int = _at()


@node
class Shifted(Node):
    """`x{k}`: element i is x[i+k], 0 outside."""

    name: str
    by: Expr
    start: int = _at()
    end: int = _at()


@node
class RowOf(Node):
    """`P#`: the row of P that iRow selects."""

    name: str
    start: int = _at()
    end: int = _at()


@node
class Pair(Node):
    """`[a, b]`, a complex number."""

    re: Expr
    im: Expr
    start: int = _at()
    end: int = _at()


Expr = Number | Text | Name | Element | Call | Unary | Binary | Transposed | Shifted | RowOf | Pair
Target = Name | Element


@node
class Relation(Node):
    """`a <= b`."""

    op: Literal["=", "<", ">", "<=", ">=", "<>"]
    left: Expr
    right: Expr
    start: int = _at()
    end: int = _at()


@node
class Logical(Node):
    """`C and D`, `C or D`."""

    op: Literal["and", "or"]
    left: Condition
    right: Condition
    start: int = _at()
    end: int = _at()


@node
class Not(Node):
    """`not C`."""

    operand: Condition
    start: int = _at()
    end: int = _at()


Condition = Relation | Logical | Not

# --------------------------------------------------------------------------------------------- statements


class Statement(Node):
    """Anything that stands alone between two `|`."""

    __slots__ = ()


@node
class Assign(Statement):
    """`x = e`, `x[i] = e`: script assignment, defined variable, difference equation, Jacobian element."""

    target: Target
    value: Expr
    start: int = _at()
    end: int = _at()


@node
class Bare(Statement):
    """An expression alone: a command prints it; in a segment `name(a, b)` invokes a submodel."""

    value: Expr
    start: int = _at()
    end: int = _at()


@node
class If(Statement):
    """`if C then` (script, `condition` set) or `if e` (segment, `value` set)."""

    condition: Condition | None
    value: Expr | None
    start: int = _at()
    end: int = _at()


@node
class For(Statement):
    """`for v = a to b [step s]`."""

    variable: Target
    first: Expr
    last: Expr
    by: Expr | None
    start: int = _at()
    end: int = _at()


@node
class While(Statement):
    """`while C`."""

    condition: Condition
    start: int = _at()
    end: int = _at()


@node
class Until(Statement):
    """`until C`."""

    condition: Condition
    start: int = _at()
    end: int = _at()


Word = Literal[
    "else", "proceed", "end if", "next", "end while", "repeat", "exit", "end", "STOP", "go", "reset", "clear",
    "time", "trace", "DYNAMIC", "OUT", "step", "JACOBIAN",
    "erun", "run", "bye", "new", "NEW", "list", "list+", "ed", "edit", "reload", "keep+",
]  # fmt: skip


@node
class Simple(Statement):
    """A statement that is its keyword, aliases replaced (`zz` → `erun`, `rld` → `reload`, `quit` → `bye`)."""

    word: Word
    start: int = _at()
    end: int = _at()


@node
class FileCommand(Statement):
    """`keep 'f'`, `load 'f'`, `snapshot 'f'`, `notebook 'f'|on|off`, `help x`, `sh …`, `compare …`."""

    word: Literal["keep", "keep+", "load", "snapshot", "notebook", "help", "sh", "compare"]
    argument: str | None
    start: int = _at()
    end: int = _at()


@node
class Label(Statement):
    """`label L`: jump target in the script; starts a labelled segment after DYNAMIC."""

    name: str
    start: int = _at()
    end: int = _at()


@node
class GoTo(Statement):
    """`go to L`; a line number keeps its digits."""

    target: str
    start: int = _at()
    end: int = _at()


@node
class Procedure(Statement):
    """`PROCEDURE p(a, b; R1, R2)`."""

    name: str
    values: tuple[str, ...]
    references: tuple[str, ...]
    start: int = _at()
    end: int = _at()


@node
class CallProcedure(Statement):
    """`call p(e1, e2; r1, r2)`."""

    name: str
    values: tuple[Expr, ...]
    references: tuple[Expr, ...]
    start: int = _at()
    end: int = _at()


@node
class Submodel(Statement):
    """`SUBMODEL s(a$, b$)` or `MACRO`."""

    name: str
    dummies: tuple[str, ...]
    start: int = _at()
    end: int = _at()


@node
class Invoke(Statement):
    """`invoke s(a, b)`; the form without the word is a `Bare` call."""

    name: str
    args: tuple[Expr, ...]
    start: int = _at()
    end: int = _at()


@node
class Function(Statement):
    """`FUNCTION f(a$, b$) = e`."""

    name: str
    dummies: tuple[str, ...]
    body: Expr
    start: int = _at()
    end: int = _at()


@node
class Declared(Node):
    """One name of a declaration; no dimensions for a scalar."""

    name: str
    dimensions: tuple[Expr, ...]
    start: int = _at()
    end: int = _at()


@node
class DeclaredGroup(Node):
    """`a[n] + b[m] = ab`: names that stand side by side, and the name of the whole (None without `=`)."""

    parts: tuple[Declared, ...]
    whole: str | None
    start: int = _at()
    end: int = _at()


@node
class Declare(Statement):
    """ARRAY, STATE, INTEGER or COMPLEX."""

    kind: Literal["ARRAY", "STATE", "INTEGER", "COMPLEX"]
    groups: tuple[DeclaredGroup, ...]
    start: int = _at()
    end: int = _at()


@node
class Data(Statement):
    """`data 1, 2*3; 4`."""

    items: tuple[Expr, ...]
    start: int = _at()
    end: int = _at()


@node
class Read(Statement):
    """`read a, B, c[2]`."""

    targets: tuple[Target, ...]
    start: int = _at()
    end: int = _at()


@node
class Restore(Statement):
    """`restore`, `restore label`, `restore 210`."""

    target: str | None
    start: int = _at()
    end: int = _at()


@node
class Input(Statement):
    """`input x, A` (channel None: the console) or `input #n, x`."""

    channel: Expr | None
    targets: tuple[Target, ...]
    start: int = _at()
    end: int = _at()


@node
class WriteItem(Node):
    """An item of `write` with the separator behind it: `,` (tab), `;` (nothing) or `` (the end).

    `form`: `` plain, `$` one character, `%` octal, `%%` hexadecimal. Strings are `Text`.
    """

    value: Expr
    form: Literal["", "$", "%", "%%"]
    separator: Literal["", ",", ";"]
    start: int = _at()
    end: int = _at()


@node
class Write(Statement):
    """`write …`, `write #n, …`, `write ##n, …` (`raw`)."""

    channel: Expr | None
    raw: bool
    items: tuple[WriteItem, ...]
    start: int = _at()
    end: int = _at()


@node
class Connect(Statement):
    """`connect 'f' as input n`."""

    file: Expr
    mode: Literal["input", "output"]
    channel: Expr
    start: int = _at()
    end: int = _at()


@node
class Disconnect(Statement):
    """`disconnect n, m`."""

    channels: tuple[Expr, ...]
    start: int = _at()
    end: int = _at()


@node
class Dump(Statement):
    """`dump`, `dump #n`, `dump run` [X]."""

    channel: Expr | None
    what: Literal["all", "run"]
    start: int = _at()
    end: int = _at()


@node
class Note(Statement):
    """`note 'text'; x`: into the notebook, items as in `write`."""

    items: tuple[WriteItem, ...]
    start: int = _at()
    end: int = _at()


@node
class Irule(Statement):
    """`irule n`; bare prints the current rule."""

    rule: Expr | None
    start: int = _at()
    end: int = _at()


@node
class Seed(Statement):
    """`SEED n`."""

    value: Expr
    start: int = _at()
    end: int = _at()


@node
class Drun(Statement):
    """`drun`, `drun L`, `drun *` (`star`), `drunr …` (`reset`)."""

    label: str | None
    reset: bool
    star: bool
    start: int = _at()
    end: int = _at()


@node
class Fft(Statement):
    """`FFT F, n, x, y`."""

    kind: Literal["F", "I", "R", "C"]
    args: tuple[Expr, ...]
    start: int = _at()
    end: int = _at()


@node
class Display(Statement):
    """`display 2`, `display N14`, `display W 10,20`. `mode` is `0 1 2` or the letter."""

    mode: Literal["0", "1", "2", "A", "B", "C", "F", "N", "Q", "R", "W", "Y"]
    args: tuple[Expr, ...]
    start: int = _at()
    end: int = _at()


@node
class Plot(Statement):
    """`plot x, y [, c]`, `plot z [, c]`."""

    args: tuple[Expr, ...]
    start: int = _at()
    end: int = _at()


@node
class Show(Statement):
    """`SHOW A, ncol`."""

    name: str
    columns: Expr | None
    start: int = _at()
    end: int = _at()


@node
class MatrixAssign(Statement):
    """`MATRIX W = [M] sum ; lower, upper`; `DELTA` adds (`delta`)."""

    name: str
    value: Expr
    delta: bool
    mask: str | None
    lower: Expr | None
    upper: Expr | None
    start: int = _at()
    end: int = _at()


@node
class VectorAssign(Statement):
    """`Vector y = [m] v`, `Vector y^ = v` (`largest`), `Vectr delta x = v` (`delta`)."""

    name: str
    value: Expr
    delta: bool
    largest: bool
    mask: str | None
    start: int = _at()
    end: int = _at()


@node
class Dot(Statement):
    """`DOT s = u*v + …`; `AVG` divides by the length."""

    target: Target
    value: Expr
    average: bool
    start: int = _at()
    end: int = _at()


@node
class Derivative(Statement):
    """`d/dt x = e`."""

    target: Target
    value: Expr
    start: int = _at()
    end: int = _at()


@node
class VectorDerivative(Statement):
    """`Vectr d/dt x = v`."""

    name: str
    value: Expr
    start: int = _at()
    end: int = _at()


@node
class Store(Statement):
    """`store X = x`."""

    array: str
    variable: Target
    start: int = _at()
    end: int = _at()


@node
class Get(Statement):
    """`get x = X`."""

    variable: Target
    array: str
    start: int = _at()
    end: int = _at()


@node
class Delay(Statement):
    """`tdelay y = D(x, tau` (`per_step`) or `delay y = D(x, tau`."""

    variable: Target
    buffer: str
    source: Expr
    tau: Expr
    per_step: bool
    start: int = _at()
    end: int = _at()


@node
class TrackHold(Statement):
    """`trkhld y, y0 = p, x`."""

    held: Target
    tracked: Target
    control: Expr
    value: Expr
    start: int = _at()
    end: int = _at()


@node
class FunctionTable(Statement):
    """The older forms `func y = F(x`, `func2 f = F(x, y; X, Y`: `call` is the func1 or func2 they mean."""

    target: Target
    call: Call
    start: int = _at()
    end: int = _at()


@node
class Term(Statement):
    """`term e`."""

    value: Expr
    start: int = _at()
    end: int = _at()


@node
class Sample(Statement):
    """`SAMPLE m`."""

    every: Expr
    start: int = _at()
    end: int = _at()


@node
class Request(Statement):
    """`dispt`, `dispxy`, `DISPXY`, `type [#n,]`, `stash`, `recover`."""

    kind: Literal["dispt", "dispxy", "DISPXY", "type", "stash", "recover"]
    channel: Expr | None
    items: tuple[Target, ...]
    start: int = _at()
    end: int = _at()


@node
class Learn(Statement):
    """`CLEARN v = W(x) lrate, crit[#]`, `PLEARN y = W*x; lrate`, `INTP v = W*x; thresh`."""

    kind: Literal["CLEARN", "PLEARN", "INTP"]
    output: str
    weights: str
    input: str
    rate: Expr
    criterion: Expr | None
    conscience: bool
    start: int = _at()
    end: int = _at()


# --------------------------------------------------------------------------------------------- a program


@dataclass(frozen=True, slots=True)
class SegmentText:
    """The statements of one DYNAMIC program segment; `jacobian` are those behind its JACOBIAN line."""

    label: str | None
    body: tuple[Placed, ...]
    jacobian: tuple[Placed, ...]
    at: int


@dataclass(frozen=True)
class Program:
    """A parsed program. `script` is flat: blocks are found by `analysis.structure`.

    A program with `problems` can still be looked at (highlighting, completion), but not run.
    """

    source: Source
    script: tuple[Placed, ...]
    segments: tuple[SegmentText, ...]
    problems: tuple[Diagnostic, ...] = ()

    def segment(self, label: str | None) -> SegmentText | None:
        """Return the unlabelled segment (None) or the one with that label."""
        for segment in self.segments:
            if segment.label == label:
                return segment
        return None
