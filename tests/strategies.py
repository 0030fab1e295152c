"""Hypothesis strategies for the language's trees: expressions, conditions, statements, programs.

Trees are built from nodes, not from text: `format_statement` turns them into text. Names include words that are
keywords elsewhere (`input`, `step`, `to`), because a program may use them.
"""

from __future__ import annotations

from hypothesis import strategies as st

from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Seed, Simple
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Declared, DeclaredGroup, Function, Submodel
from desire_tui.engine.nodes.display import Display, Plot, Request, Show, ShowArea
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
from desire_tui.engine.nodes.files import (
    Connect,
    Data,
    Disconnect,
    Dump,
    Input,
    LoadData,
    Note,
    Read,
    Restore,
    Write,
    WriteItem,
)
from desire_tui.engine.nodes.program import Placed, Program, SegmentText
from desire_tui.engine.nodes.segment import (
    Delay,
    Derivative,
    FunctionTable,
    Get,
    Invoke,
    Learn,
    Sample,
    Store,
    Term,
    TrackHold,
    VectorDerivative,
)
from desire_tui.engine.source import Source

PLAIN = ["x", "y", "xdot", "alpha_1", "A", "W2", "v$", "t", "TMAX", "d", "dt", "e1", "a_b"]
WORDS = [
    "input",
    "output",
    "step",
    "to",
    "then",
    "and",
    "as",
    "data",
    "time",
    "end",
    "type",
    "else",
    "run",
    "go",
    "N",
]
names = st.sampled_from(PLAIN + WORDS)
plain_names = st.sampled_from(PLAIN)
numbers = st.one_of(
    st.integers(0, 10**6).map(float),
    st.floats(0, allow_nan=False, allow_infinity=False),
    st.integers(-32768, -1).map(float),
).map(Number)
strings = st.text(st.characters(exclude_categories=("Cs", "Cc")), max_size=12).filter(
    lambda text: not ("'" in text and '"' in text)
)


def _some(of, least=1, most=3):
    return st.lists(of, min_size=least, max_size=most).map(tuple)


relation_signs = st.sampled_from(["=", "<", ">", "<=", ">=", "<>"])


def _grown(inner):
    """Expressions one level above `inner`."""
    return st.one_of(
        st.builds(Binary, st.sampled_from("+-*/^"), inner, inner),
        st.builds(Unary, st.sampled_from("-+"), inner),
        st.builds(Element, names, _some(inner)),
        st.builds(Call, plain_names, _some(inner, least=0)),
        st.builds(Shifted, names, inner),
        st.builds(Pair, inner, inner),
        st.builds(Truth, st.builds(Relation, relation_signs, inner, inner)),
    )


leaves = st.one_of(names.map(Name), numbers, names.map(Transposed), names.map(RowOf))
expressions = st.recursive(leaves, _grown, max_leaves=12)
targets = st.one_of(names.map(Name), st.builds(Element, names, _some(expressions)))
relations = st.builds(Relation, relation_signs, expressions, expressions)
conditions = st.recursive(
    relations,
    lambda inner: st.one_of(
        st.builds(Logical, st.sampled_from(["and", "or"]), inner, inner), st.builds(Not, inner)
    ),
    max_leaves=5,
)
maybe = st.none() | expressions
all_targets = _some(targets)


@st.composite
def items(draw, least=0):
    """Items of write: every one but the last needs a separator behind it."""
    count = draw(st.integers(least, 4))
    made = []
    for i in range(count):
        separators = [",", ";"] if i < count - 1 else ["", ",", ";"]
        value = draw(st.one_of(expressions, strings.map(Text)))
        form = draw(st.sampled_from(["", "$", "%", "%%"])) if not isinstance(value, Text) else ""
        made.append(WriteItem(value, form, draw(st.sampled_from(separators))))
    return tuple(made)


@st.composite
def declarations(draw):
    kind = draw(st.sampled_from(["ARRAY", "STATE", "INTEGER", "COMPLEX"]))
    dimensions = _some(expressions, least=1 if kind == "ARRAY" else 0)
    part = st.builds(Declared, names, dimensions)
    alone = st.builds(DeclaredGroup, st.tuples(part), st.none())
    joined = st.builds(DeclaredGroup, _some(part), names)
    return Declare(kind, draw(_some(alone | joined)))


@st.composite
def displays(draw):
    mode = draw(st.sampled_from("012ABCFNQRWY"))
    count = {"C": 1, "N": 1, "W": 2}.get(mode, 0)
    return Display(mode, tuple(draw(expressions) for _ in range(count)))


@st.composite
def transforms(draw):
    kind = draw(st.sampled_from("FIRC"))
    return Fft(kind, tuple(draw(expressions) for _ in range(5 if kind == "R" else 3)))


@st.composite
def matrices(draw):
    lower, upper = draw(st.one_of(st.just((None, None)), st.tuples(expressions, expressions)))
    value = draw(
        st.one_of(expressions, st.builds(Call, st.sampled_from(["$In", "$Tr"]), st.tuples(expressions)))
    )
    return MatrixAssign(draw(names), value, draw(st.booleans()), draw(st.none() | names), lower, upper)


@st.composite
def vectors(draw):
    delta = draw(st.booleans())
    largest = not delta and draw(st.booleans())
    bounded = delta and draw(st.booleans())
    lower, upper = draw(st.tuples(expressions, expressions)) if bounded else (None, None)
    return VectorAssign(draw(names), draw(expressions), delta, largest, draw(st.none() | names), lower, upper)


@st.composite
def learners(draw):
    kind = draw(st.sampled_from(["CLEARN", "PLEARN", "INTP"]))
    criterion = draw(st.one_of(numbers, names.map(Name))) if kind == "CLEARN" else None
    fast = kind == "CLEARN" and draw(st.booleans())
    return Learn(kind, draw(names), draw(names), draw(names), draw(expressions), criterion, fast)


@st.composite
def tables(draw):
    if draw(st.booleans()):
        call = Call("func1", (draw(expressions), Name(draw(names))))
    else:
        x, y, X, Y = (draw(expressions) for _ in range(4))
        call = Call("func2", (x, y, Name(draw(names)), X, Y))
    return FunctionTable(draw(targets), call)


SIMPLE = [
    *[
        "else",
        "proceed",
        "next",
        "repeat",
        "exit",
        "end",
        "go",
        "reset",
        "clear",
        "time",
        "trace",
        "OUT",
        "step",
    ],
    *["erun", "run", "bye", "new", "NEW", "list", "list+", "ed", "edit", "reload", "end if", "end while"],
]

line_lists = st.lists(st.sampled_from(["210", "300-320", "70"]), min_size=1, max_size=3).map(",".join)
script_statements = st.one_of(
    st.builds(If, conditions, st.none()),
    st.builds(For, targets, expressions, expressions, maybe),
    st.builds(While, conditions),
    st.builds(Until, conditions),
    st.builds(Simple, st.sampled_from(SIMPLE)),
    st.builds(
        FileCommand,
        st.sampled_from(["keep", "keep+", "load", "snapshot", "notebook", "help", "sh", "compare"]),
        st.none() | strings.filter(bool),
    ),
    st.builds(Label, names),
    st.builds(GoTo, st.one_of(names, st.integers(0, 9999).map(str))),
    st.builds(Procedure, names, _some(names, least=0), _some(names, least=0)),
    st.builds(CallProcedure, names, _some(expressions, least=0), _some(expressions, least=0)),
    st.builds(Submodel, names, _some(names, least=0)),
    st.builds(Function, names, _some(names, least=0), expressions),
    declarations(),
    st.builds(Data, _some(expressions)),
    st.builds(LoadData, strings),
    st.builds(Read, all_targets),
    st.builds(Restore, st.none() | names | st.integers(0, 9999).map(str)),
    st.builds(Input, maybe, all_targets),
    st.builds(lambda c, raw, i: Write(c, raw and c is not None, i), maybe, st.booleans(), items()),
    st.builds(Connect, strings.map(Text), st.sampled_from(["input", "output"]), expressions),
    st.builds(Disconnect, _some(expressions)),
    st.one_of(st.builds(Dump, maybe, st.just("all")), st.just(Dump(None, "run"))),
    st.builds(Note, items()),
    st.builds(Irule, maybe),
    st.builds(Seed, expressions),
    st.builds(lambda label, reset, star: Drun(None if star else label, reset, star), st.none() | names,
              st.booleans(), st.booleans()),
    transforms(),
    displays(),
    st.builds(Plot, _some(expressions)),
    st.builds(Show, names, maybe),
    st.builds(ShowArea, st.booleans()),
    st.builds(FileCommand, st.sampled_from(["edit", "ed", "list", "list+", "auto", "note"]), line_lists),
)  # fmt: skip
shared_statements = st.one_of(
    st.builds(Assign, targets, expressions),
    matrices(),
    vectors(),
    st.builds(Dot, targets, expressions, st.booleans()),
)
dynamic_statements = st.one_of(
    st.builds(If, st.none(), expressions),
    st.builds(Bare, st.builds(Call, plain_names, _some(expressions, least=0))),
    st.builds(Invoke, names, _some(expressions, least=0)),
    st.builds(Derivative, targets, expressions),
    st.builds(VectorDerivative, names, expressions),
    st.builds(Store, names, targets),
    st.builds(Get, targets, names),
    st.builds(Delay, targets, names, expressions, expressions, st.booleans()),
    st.builds(TrackHold, targets, targets, expressions, expressions),
    tables(),
    st.builds(Term, expressions),
    st.builds(Sample, expressions),
    st.builds(
        Request, st.sampled_from(["dispt", "dispxy", "DISPXY", "stash", "recover"]), st.none(), all_targets
    ),
    st.builds(Request, st.just("type"), maybe, all_targets),
    learners(),
)
statements = st.one_of(script_statements, shared_statements, dynamic_statements)


def _placed(of):
    return st.lists(of.map(lambda node: Placed(node, 0)), max_size=6).map(tuple)


_bodies = _placed(
    st.one_of(dynamic_statements, shared_statements).filter(lambda node: not isinstance(node, Simple))
)


@st.composite
def programs(draw):
    """A program of any statements: it parses back to itself, but its blocks need not match."""
    script = draw(_placed(st.one_of(script_statements, shared_statements)))
    segments = [
        SegmentText(label, draw(_bodies), draw(_bodies), 0)
        for label in draw(st.sampled_from([[], [None], [None, "second"], [None, "second", "third"]]))
    ]
    return Program(Source(""), script, tuple(segments))


PIECES = """x = 3 + * ( ) [ ] { } , ; | ^ / - -- <= <> > < if then else proceed for to step next while end until repeat and
or not d/dt Vectr Vector delta MATRIX DELTA % # $ & &17 &&FF 1.5 1e 'a' ' " write read data ARRAY STATE DYNAMIC STOP label
L go dispt type display N C FFT F SHOW A PROCEDURE p call FUNCTION f( SUBMODEL func2 tdelay D(x CLEARN connect as input
output JACOBIAN sin _ \n ? é ’ – . .. 210 irule drun * sh help keep load""".split(" ")  # noqa: SIM905
broken_texts = st.one_of(
    st.lists(st.sampled_from(PIECES), max_size=30).map(" ".join),
    st.lists(st.sampled_from(PIECES), max_size=30).map("".join),
    st.text(max_size=60),
    st.binary(max_size=60).map(lambda raw: raw.decode("latin-1")),
)
"""Texts that are mostly no programs."""
