"""Every statement form of language.md 3 to 13: its text and the node it means."""

from __future__ import annotations

import re
from typing import get_args

import pytest

from desire_tui.engine.diagnostics import render_all
from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Seed, Simple
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Declared, DeclaredGroup, Function, Submodel
from desire_tui.engine.nodes.display import Display, GraphText, Plot, Request, Show, ShowArea
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
    Unary,
)
from desire_tui.engine.nodes.faulty import Faulty
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
from desire_tui.engine.nodes.segment import (
    Delay,
    Derivative,
    Event,
    Every,
    Fast,
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
from desire_tui.engine.nodes.statements import Statement
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.lalr_tables import tables
from desire_tui.engine.syntax.parse import parse, parse_command
from desire_tui.engine.syntax.statement_tokens import CLASSES
from desire_tui.engine.syntax.words import KEYWORDS


def N(value):
    return Number(float(value))


def V(name):
    return Name(name)


def op(operator, left, right):
    return Binary(operator, left, right)


def item(value, separator="", form=""):
    return WriteItem(value, form, separator)


x, y, z, a, b, u, v = map(V, "xyzabuv")
x_above_3 = Relation(">", x, N(3))
y3 = Element("y", (N(3),))

FORMS = {
    # --------------------------------------------------------------- expressions (language.md 4)
    "x = 2^3^2": Assign(x, op("^", N(2), op("^", N(3), N(2)))),
    "x = -2^2": Assign(x, Unary("-", op("^", N(2), N(2)))),
    "x = 3*-2": Assign(x, op("*", N(3), Unary("-", N(2)))),
    "x = 2^-1": Assign(x, op("^", N(2), Unary("-", N(1)))),
    "x = a - b - u": Assign(x, op("-", op("-", a, b), u)),
    "x = a/b*u": Assign(x, op("*", op("/", a, b), u)),
    "x = (a)": Assign(x, a),
    "x = 1.2E-07 + .85": Assign(x, op("+", N(1.2e-7), N(0.85))),
    "x = 9.0E+11 - 1E5": Assign(x, op("-", N(9e11), N(1e5))),
    "x = 5.": Assign(x, N(5)),
    "x = &17370": Assign(x, N(0o17370)),
    "x = &&FC2 + &&FFFF": Assign(x, op("+", N(0xFC2), N(-1))),
    "x = func1(y; F)": Assign(x, Call("func1", (y, V("F")))),
    "x = ran()": Assign(x, Call("ran", ())),
    "x = [a, b]": Assign(x, Pair(a, b)),
    "y[3] = a": Assign(y3, a),
    "x = A[2, a + 1]": Assign(x, Element("A", (N(2), op("+", a, N(1))))),
    "input = 0": Assign(V("input"), N(0)),
    "input=0": Assign(V("input"), N(0)),
    "step = 3": Assign(V("step"), N(3)),
    "data[2] = 3": Assign(Element("data", (N(2),)), N(3)),
    "x = input + to": Assign(x, op("+", V("input"), V("to"))),
    # --------------------------------------------------------------- declarations (language.md 3)
    "ARRAY x[3], A[m, n]": Declare(
        "ARRAY",
        (
            DeclaredGroup((Declared("x", (N(3),)),), None),
            DeclaredGroup((Declared("A", (V("m"), V("n"))),), None),
        ),
    ),
    "ARRAY a[n] + b[m] = ab": Declare(
        "ARRAY", (DeclaredGroup((Declared("a", (V("n"),)), Declared("b", (V("m"),))), "ab"),)
    ),
    "dimension x[3]": Declare("ARRAY", (DeclaredGroup((Declared("x", (N(3),)),), None),)),
    "STATE x[3], V[m,n] = v": Declare(
        "STATE",
        (
            DeclaredGroup((Declared("x", (N(3),)),), None),
            DeclaredGroup((Declared("V", (V("m"), V("n"))),), "v"),
        ),
    ),
    "STATE x": Declare("STATE", (DeclaredGroup((Declared("x", ()),), None),)),
    "INTEGER a": Declare("INTEGER", (DeclaredGroup((Declared("a", ()),), None),)),
    "COMPLEX z": Declare("COMPLEX", (DeclaredGroup((Declared("z", ()),), None),)),
    "FUNCTION f(a$, b$) = a$": Function("f", ("a$", "b$"), V("a$")),
    # --------------------------------------------------------------- script (language.md 5)
    "if x > 3 then": If(x_above_3, None),
    "if x>3 and not (a<=b or a<>b) then": If(
        Logical("and", x_above_3, Not(Logical("or", Relation("<=", a, b), Relation("<>", a, b)))),
        None,
    ),
    "else": Simple("else"),
    "proceed": Simple("proceed"),
    "for x = 1 to 10": For(x, N(1), N(10), None),
    "for x = a to b step -2": For(x, a, b, Unary("-", N(2))),
    "next": Simple("next"),
    "while x > 3": While(x_above_3),
    "end while": Simple("end while"),
    "end  while": Simple("end while"),
    "repeat": Simple("repeat"),
    "until x > 3": Until(x_above_3),
    "exit": Simple("exit"),
    "label here": Label("here"),
    "go to here": GoTo("here"),
    "go to 1100": GoTo("1100"),
    "PROCEDURE p(a, b; R1, R2)": Procedure("p", ("a", "b"), ("R1", "R2")),
    "PROCEDURE p": Procedure("p", (), ()),
    "PROCEDURE p(; R)": Procedure("p", (), ("R",)),
    "end": Simple("end"),
    "call p(a, 3; x, y[3])": CallProcedure("p", (a, N(3)), (x, y3)),
    "call p": CallProcedure("p", (), ()),
    "SUBMODEL s(x$, y$)": Submodel("s", ("x$", "y$")),
    "MACRO s(x$)": Submodel("s", ("x$",)),
    "data 1, 2*a; 3": Data((N(1), op("*", N(2), a), N(3))),
    "data 'f.csv'": LoadData("f.csv"),
    "read x, y[3]": Read((x, y3)),
    "restore": Restore(None),
    "restore here": Restore("here"),
    "restore 210": Restore("210"),
    "input x, y[3]": Input(None, (x, y3)),
    "write x, y; z": Write(None, False, (item(x, ","), item(y, ";"), item(z))),
    "write 'a', x;": Write(None, False, (item(Text("a"), ","), item(x, ";"))),
    'write "it\'s", x,': Write(None, False, (item(Text("it's"), ","), item(x, ","))),
    "write $65; %a, %%b": Write(None, False, (item(N(65), ";", "$"), item(a, ",", "%"), item(b, "", "%%"))),
    "write": Write(None, False, ()),
    "connect 'f' as input 3": Connect(Text("f"), "input", N(3)),
    "connect 'f' as output a": Connect(Text("f"), "output", a),
    "disconnect 1, 2": Disconnect((N(1), N(2))),
    "write #3, x, y": Write(N(3), False, (item(x, ","), item(y))),
    "write ##3, x": Write(N(3), True, (item(x),)),
    "write #3": Write(N(3), False, ()),
    "input #3, y": Input(N(3), (y,)),
    "dump": Dump(None, "all"),
    "dump #3": Dump(N(3), "all"),
    "dump run": Dump(None, "run"),
    "time": Simple("time"),
    "note 'text'; x": Note((item(Text("text"), ";"), item(x))),
    "sh ls -l": FileCommand("sh", "ls -l"),
    "sh 'ls | wc'": FileCommand("sh", "ls | wc"),
    "help": FileCommand("help", None),
    "help d/dt": FileCommand("help", "d/dt"),
    "help 'FFT'": FileCommand("help", "FFT"),
    "irule 4": Irule(N(4)),
    "irule": Irule(None),
    "SEED 17": Seed(N(17)),
    "trace": Simple("trace"),
    "drun": Drun(None, False, False),
    "drun second": Drun("second", False, False),
    "drun *": Drun(None, False, True),
    "drunr": Drun(None, True, False),
    "drunr second": Drun("second", True, False),
    "reset": Simple("reset"),
    "clear": Simple("clear"),
    "STOP": Simple("STOP"),
    "go": Simple("go"),
    # --------------------------------------------------------------- commands (language.md 6)
    "erun": Simple("erun"),
    "zz": Simple("erun"),
    "run": Simple("run"),
    "ed": Simple("ed"),
    "edit": Simple("edit"),
    "keep": FileCommand("keep", None),
    "keep 'f'": FileCommand("keep", "f"),
    "keep+": FileCommand("keep+", None),
    "reload": Simple("reload"),
    "rld": Simple("reload"),
    "load 'f'": FileCommand("load", "f"),
    "load f.src": FileCommand("load", "f.src"),
    "old 'f'": FileCommand("load", "f"),
    "new": Simple("new"),
    "NEW": Simple("NEW"),
    "list": Simple("list"),
    "list+": Simple("list+"),
    "snapshot 'f.png'": FileCommand("snapshot", "f.png"),
    "notebook 'f.md'": FileCommand("notebook", "f.md"),
    "note #210-230,530": FileCommand("note", "210-230,530"),
    "edit 210-240,260": FileCommand("edit", "210-240,260"),
    "ed 70": FileCommand("ed", "70"),
    "list 300 - 320; 400": FileCommand("list", "300 - 320; 400"),
    "list+ 300": FileCommand("list+", "300"),
    "auto": Simple("auto"),
    "auto 300, 10": FileCommand("auto", "300, 10"),
    "edit = 3": Assign(Name("edit"), N(3)),
    "notebook off": FileCommand("notebook", "off"),
    "compare rule 4": FileCommand("compare", "rule 4"),
    "bye": Simple("bye"),
    "quit": Simple("bye"),
    "3 + a": Bare(op("+", N(3), a)),
    # --------------------------------------------------------------- matrices, vectors (language.md 7, 9.2, 9.3)
    "MATRIX C = 0": MatrixAssign("C", N(0), False, None, None, None),
    "MATRIX C = A * B": MatrixAssign("C", op("*", V("A"), V("B")), False, None, None, None),
    "MATRIX B = A%": MatrixAssign("B", Transposed("A"), False, None, None, None),
    "MATRIX B = $In(A)": MatrixAssign("B", Call("$In", (V("A"),)), False, None, None, None),
    "MATRIX B = $Tr(A)": MatrixAssign("B", Call("$Tr", (V("A"),)), False, None, None, None),
    "MATRIX W = u & v; -1, 1": MatrixAssign("W", op("&", u, v), False, None, Unary("-", N(1)), N(1)),
    "DELTA W = [M] a*u": MatrixAssign("W", op("*", a, u), True, "M", None, None),
    "LEARN W = a": MatrixAssign("W", a, True, None, None, None),
    "Vector y = x": VectorAssign("y", x, False, False, None),
    "VECTOR y = x": VectorAssign("y", x, False, False, None),
    "Vectr y = x": VectorAssign("y", x, False, False, None),
    "Vector y = A% * x": VectorAssign("y", op("*", Transposed("A"), x), False, False, None),
    "Vector y = [m] v": VectorAssign("y", v, False, False, "m"),
    "Vector y^ = v": VectorAssign("y", v, False, True, None),
    "Vectr delta x = v": VectorAssign("x", v, True, False, None),
    "Vector delta x = v": VectorAssign("x", v, True, False, None),
    "Delta x = v": VectorAssign("x", v, True, False, None),
    "delta h = v": VectorAssign("h", v, True, False, None),
    "delta h = [m] v; 0, x": VectorAssign("h", v, True, False, "m", N(0), x),
    "UPDATE h = v; a; b": VectorAssign("h", v, True, False, None, a, b),
    "VECTR delta x = v; 0, 1": VectorAssign("x", v, True, False, None, N(0), N(1)),
    "Delta x = v; a, b": VectorAssign("x", v, True, False, None, a, b),
    "Matrix A = 1": MatrixAssign("A", N(1), False, None, None, None),
    "LEARN W = a*v; 0, 1": MatrixAssign("W", op("*", a, v), True, None, N(0), N(1)),
    "Mat d/dt A = B": VectorDerivative("A", Name("B")),
    "delta = v": Assign(Name("delta"), v),
    "UPDATE[2] = v": Assign(Element("UPDATE", (N(2),)), v),
    "Vector delta = v": VectorAssign("delta", v, False, False, None),
    "Vector y = x{-1}": VectorAssign("y", Shifted("x", Unary("-", N(1))), False, False, None),
    "Vector y = P#": VectorAssign("y", RowOf("P"), False, False, None),
    "DOT x = u*v": Dot(x, op("*", u, v), False),
    "AVG y[3] = u*A%*v": Dot(y3, op("*", op("*", u, Transposed("A")), v), True),
    # --------------------------------------------------------------- DYNAMIC segments (language.md 9)
    "DYNAMIC": Simple("DYNAMIC"),
    "OUT": Simple("OUT"),
    "step": Simple("step"),
    "SAMPLE a": Sample(a),
    "if x - 3": If(None, op("-", x, N(3))),
    "end if": Simple("end if"),
    "d/dt x = a": Derivative(x, a),
    "d/dt y[3] = a": Derivative(y3, a),
    "Vectr d/dt x = v": VectorDerivative("x", v),
    "MAT d/dt x = v": VectorDerivative("x", v),
    "Mat d/dt x = v": VectorDerivative("x", v),
    "store X = x": Store("X", x),
    "get x = X": Get(x, "X"),
    "tdelay y = D(x, a": Delay(y, "D", x, a, True),
    "tdelay y = D, x, a": Delay(y, "D", x, a, True),
    "delay y = D; x; a": Delay(y, "D", x, a, False),
    "tdelay y = D(x, a)": Delay(y, "D", x, a, True),
    "delay y = D(x, (a)": Delay(y, "D", x, a, False),
    "trkhld y, x = a, b": TrackHold(y, x, a, b),
    "func y = F(x": FunctionTable(y, Call("func1", (x, V("F")))),
    "func2 y = F(a, b; X, Y": FunctionTable(y, Call("func2", (a, b, V("F"), V("X"), V("Y")))),
    "invoke s[x, y)": Invoke("s", (x, y)),
    "invoke s(x; y]": Invoke("s", (x, y)),
    "invoke s[x]": Invoke("s", (x,)),
    "invoke s(x, y)": Invoke("s", (x, y)),
    "s(x, y)": Bare(Call("s", (x, y))),
    "term -y": Term(Unary("-", y)),
    "event -y": Event(Unary("-", y)),
    "event x - a": Event(Binary("-", x, a)),
    "every a": Every(a, None),
    "fast": Fast(),
    "every 24, a": Every(N(24), a),
    "end event": Simple("end event"),
    "dispt x, y[3]": Request("dispt", None, (x, y3)),
    "dispxy x, y": Request("dispxy", None, (x, y)),
    "DISPXY x, y, a, b": Request("DISPXY", None, (x, y, a, b)),
    "type x, y": Request("type", None, (x, y)),
    "type #2, x": Request("type", N(2), (x,)),
    "stash x, y": Request("stash", None, (x, y)),
    "recover x": Request("recover", None, (x,)),
    "SHOW": ShowArea(by_size=False),
    "SHOW *": ShowArea(by_size=True),
    "SHOW A, 5": Show("A", N(5)),
    "SHOW A": Show("A", None),
    "CLEARN v = W*x; a, b": Learn("CLEARN", "v", "W", "x", a, b, False),
    "CLEARN v = W*x, a; 0.5#": Learn("CLEARN", "v", "W", "x", a, N(0.5), True),
    "PLEARN y = W(x) a": Learn("PLEARN", "y", "W", "x", a, None, False),
    "INTP y = W(x) a": Learn("INTP", "y", "W", "x", a, None, False),
    "CLEARN v = W(x) a, b": Learn("CLEARN", "v", "W", "x", a, b, False),
    "CLEARN v = W(x) a, b#": Learn("CLEARN", "v", "W", "x", a, b, True),
    "CLEARN v = W(x) a, 0.5#": Learn("CLEARN", "v", "W", "x", a, N(0.5), True),
    "CLEARN v = W*x; a, b#": Learn("CLEARN", "v", "W", "x", a, b, True),
    "PLEARN y = W*x; a": Learn("PLEARN", "y", "W", "x", a, None, False),
    "INTP v = W*x; a": Learn("INTP", "v", "W", "x", a, None, False),
    "JACOBIAN": Simple("JACOBIAN"),
    # --------------------------------------------------------------- FFT, graphs (language.md 12, 13)
    "FFT F,x,y,z": Fft("F", (x, y, z)),
    "FFT I, 64, y, z": Fft("I", (N(64), y, z)),
    "FFT R,x,y,z,u,v": Fft("R", (x, y, z, u, v)),
    "FFT C,x,y,z": Fft("C", (x, y, z)),
    "display 0": Display("0", ()),
    "display 1": Display("1", ()),
    "display 2": Display("2", ()),
    "display F": Display("F", ()),
    "display fit": Display("fit", ()),
    "display Q": Display("Q", ()),
    "display R": Display("R", ()),
    "display Y": Display("Y", ()),
    "display A": Display("A", ()),
    "display B": Display("B", ()),
    "display W 10, 20": Display("W", (N(10), N(20))),
    "display C 7": Display("C", (N(7),)),
    "display C16": Display("C", (N(16),)),
    "display N14": Display("N", (N(14),)),
    "display N -18": Display("N", (Unary("-", N(18)),)),
    "display N-18": Display("N", (Unary("-", N(18)),)),
    "display N colr + 1": Display("N", (op("+", V("colr"), N(1)),)),
    "title 'Rabbits | foxes'": GraphText("title", "Rabbits | foxes"),
    'xlabel "time, s"': GraphText("xlabel", "time, s"),
    "ylabel''": GraphText("ylabel", ""),
    "units 'x m'": GraphText("units", "x m"),
    "display logy": Display("logy", ()),
    "plot x, y": Plot((x, y)),
    "plot x, y, 3": Plot((x, y, N(3))),
    "plot z": Plot((z,)),
}


@pytest.mark.parametrize("text", FORMS)
def test_form(text: str) -> None:
    for _ in range(3):  # the grammar, the shape's pattern, the shape's function
        placed, problems = parse_command(Source(text + " -- a comment"))
        assert not problems, render_all(problems)
        assert [p.node for p in placed] == [FORMS[text]]
        node = placed[0].node
        assert (placed[0].at, node.start, node.end) == (0, 0, len(text))


def test_every_keyword_has_a_form() -> None:
    first_words = {re.match(r"[A-Za-z0-9/]+", text)[0] for text in FORMS}
    assert set(KEYWORDS) <= first_words
    assert {type(node) for node in FORMS.values()} == {*get_args(Statement)} - {Faulty}


def test_tokenizer_and_grammar_know_the_same_words() -> None:
    """Every keyword the tokenizer makes begins a statement of the grammar, and the other way round."""
    table = tables()
    begins = {kind for kind in table.actions[table.start] if kind not in CLASSES and kind[0].isalpha()}
    assert begins == set(KEYWORDS.values()) | {
        "go to",
        "end if",
        "end while",
        "end event",
        "list+",
        "keep+",
        "d/dt",
    }


LINES = {
    "x = 1 | y = 2": ["x = 1", "y = 2"],
    "| x = 1 ||": ["x = 1"],
    "x = 1 -- a | y = 2": ["x = 1"],
    "write '|--|' | x = 1": ["write '|--|'", "x = 1"],
    "if a > b then x = 1 | else x = 2 | proceed": ["if a > b then", "x = 1", "else", "x = 2", "proceed"],
    "if a > b then x = 1 else x = 2 proceed": ["if a > b then", "x = 1", "else", "x = 2", "proceed"],
    "if a > b then exit else proceed": ["if a > b then", "exit", "else", "proceed"],
    "if a > b then -- why": ["if a > b then"],
    "else proceed": ["else", "proceed"],
    "else if a > b then write x | proceed": ["else", "if a > b then", "write x", "proceed"],
    "for i = 1 to 3 | write i | next": ["for i = 1 to 3", "write i", "next"],
}


@pytest.mark.parametrize("line", LINES)
def test_line_of_statements(line: str) -> None:
    placed, problems = parse_command(Source(line))
    assert not problems
    assert [line[p.span().start : p.span().end] for p in placed] == LINES[line]


def test_places_of_parts() -> None:
    text = "a = 1\n  if (x + 1)*y > 3 then -- c"
    placed = parse(Source(text)).script[1]
    relation = placed.node.condition
    assert text[slice(*placed.span(relation))] == "(x + 1)*y > 3"
    assert text[slice(*placed.span(relation.left.left))] == "(x + 1)"
    assert text[slice(*placed.span(relation.right))] == "3"
