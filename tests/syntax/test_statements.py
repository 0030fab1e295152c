"""Every statement form of the language reference, sections 3 to 13: its text and the node it means."""

from __future__ import annotations

import re

import pytest

from desire_tui.engine import nodes as n
from desire_tui.engine.diagnostics import render_all
from desire_tui.engine.source import Source
from desire_tui.engine.syntax import parse, parse_command
from desire_tui.engine.syntax.lalr_tables import tables
from desire_tui.engine.syntax.statement_tokens import CLASSES
from desire_tui.engine.syntax.words import KEYWORDS


def N(value):
    return n.Number(float(value))


def V(name):
    return n.Name(name)


def op(operator, left, right):
    return n.Binary(operator, left, right)


def item(value, separator="", form=""):
    return n.WriteItem(value, form, separator)


x, y, z, a, b, u, v = map(V, "xyzabuv")
x_above_3 = n.Relation(">", x, N(3))
y3 = n.Element("y", (N(3),))

FORMS = {
    # --------------------------------------------------------------- expressions (section 4)
    "x = 2^3^2": n.Assign(x, op("^", N(2), op("^", N(3), N(2)))),
    "x = -2^2": n.Assign(x, n.Unary("-", op("^", N(2), N(2)))),
    "x = 3*-2": n.Assign(x, op("*", N(3), n.Unary("-", N(2)))),
    "x = 2^-1": n.Assign(x, op("^", N(2), n.Unary("-", N(1)))),
    "x = a - b - u": n.Assign(x, op("-", op("-", a, b), u)),
    "x = a/b*u": n.Assign(x, op("*", op("/", a, b), u)),
    "x = (a)": n.Assign(x, a),
    "x = 1.2E-07 + .85": n.Assign(x, op("+", N(1.2e-7), N(0.85))),
    "x = 9.0E+11 - 1E5": n.Assign(x, op("-", N(9e11), N(1e5))),
    "x = 5.": n.Assign(x, N(5)),
    "x = &17370": n.Assign(x, N(0o17370)),
    "x = &&FC2 + &&FFFF": n.Assign(x, op("+", N(0xFC2), N(-1))),
    "x = func1(y; F)": n.Assign(x, n.Call("func1", (y, V("F")))),
    "x = ran()": n.Assign(x, n.Call("ran", ())),
    "x = [a, b]": n.Assign(x, n.Pair(a, b)),
    "y[3] = a": n.Assign(y3, a),
    "x = A[2, a + 1]": n.Assign(x, n.Element("A", (N(2), op("+", a, N(1))))),
    "input = 0": n.Assign(V("input"), N(0)),
    "input=0": n.Assign(V("input"), N(0)),
    "step = 3": n.Assign(V("step"), N(3)),
    "data[2] = 3": n.Assign(n.Element("data", (N(2),)), N(3)),
    "x = input + to": n.Assign(x, op("+", V("input"), V("to"))),
    # --------------------------------------------------------------- declarations (section 3)
    "ARRAY x[3], A[m, n]": n.Declare(
        "ARRAY",
        (
            n.DeclaredGroup((n.Declared("x", (N(3),)),), None),
            n.DeclaredGroup((n.Declared("A", (V("m"), V("n"))),), None),
        ),
    ),
    "ARRAY a[n] + b[m] = ab": n.Declare(
        "ARRAY", (n.DeclaredGroup((n.Declared("a", (V("n"),)), n.Declared("b", (V("m"),))), "ab"),)
    ),
    "dimension x[3]": n.Declare("ARRAY", (n.DeclaredGroup((n.Declared("x", (N(3),)),), None),)),
    "STATE x[3], V[m,n] = v": n.Declare(
        "STATE",
        (
            n.DeclaredGroup((n.Declared("x", (N(3),)),), None),
            n.DeclaredGroup((n.Declared("V", (V("m"), V("n"))),), "v"),
        ),
    ),
    "STATE x": n.Declare("STATE", (n.DeclaredGroup((n.Declared("x", ()),), None),)),
    "INTEGER a": n.Declare("INTEGER", (n.DeclaredGroup((n.Declared("a", ()),), None),)),
    "COMPLEX z": n.Declare("COMPLEX", (n.DeclaredGroup((n.Declared("z", ()),), None),)),
    "FUNCTION f(a$, b$) = a$": n.Function("f", ("a$", "b$"), V("a$")),
    # --------------------------------------------------------------- script (section 5)
    "if x > 3 then": n.If(x_above_3, None),
    "if x>3 and not (a<=b or a<>b) then": n.If(
        n.Logical("and", x_above_3, n.Not(n.Logical("or", n.Relation("<=", a, b), n.Relation("<>", a, b)))),
        None,
    ),
    "else": n.Simple("else"),
    "proceed": n.Simple("proceed"),
    "for x = 1 to 10": n.For(x, N(1), N(10), None),
    "for x = a to b step -2": n.For(x, a, b, n.Unary("-", N(2))),
    "next": n.Simple("next"),
    "while x > 3": n.While(x_above_3),
    "end while": n.Simple("end while"),
    "end  while": n.Simple("end while"),
    "repeat": n.Simple("repeat"),
    "until x > 3": n.Until(x_above_3),
    "exit": n.Simple("exit"),
    "label here": n.Label("here"),
    "go to here": n.GoTo("here"),
    "go to 1100": n.GoTo("1100"),
    "PROCEDURE p(a, b; R1, R2)": n.Procedure("p", ("a", "b"), ("R1", "R2")),
    "PROCEDURE p": n.Procedure("p", (), ()),
    "PROCEDURE p(; R)": n.Procedure("p", (), ("R",)),
    "end": n.Simple("end"),
    "call p(a, 3; x, y[3])": n.CallProcedure("p", (a, N(3)), (x, y3)),
    "call p": n.CallProcedure("p", (), ()),
    "SUBMODEL s(x$, y$)": n.Submodel("s", ("x$", "y$")),
    "MACRO s(x$)": n.Submodel("s", ("x$",)),
    "data 1, 2*a; 3": n.Data((N(1), op("*", N(2), a), N(3))),
    "read x, y[3]": n.Read((x, y3)),
    "restore": n.Restore(None),
    "restore here": n.Restore("here"),
    "restore 210": n.Restore("210"),
    "input x, y[3]": n.Input(None, (x, y3)),
    "write x, y; z": n.Write(None, False, (item(x, ","), item(y, ";"), item(z))),
    "write 'a', x;": n.Write(None, False, (item(n.Text("a"), ","), item(x, ";"))),
    'write "it\'s", x,': n.Write(None, False, (item(n.Text("it's"), ","), item(x, ","))),
    "write $65; %a, %%b": n.Write(None, False, (item(N(65), ";", "$"), item(a, ",", "%"), item(b, "", "%%"))),
    "write": n.Write(None, False, ()),
    "connect 'f' as input 3": n.Connect(n.Text("f"), "input", N(3)),
    "connect 'f' as output a": n.Connect(n.Text("f"), "output", a),
    "disconnect 1, 2": n.Disconnect((N(1), N(2))),
    "write #3, x, y": n.Write(N(3), False, (item(x, ","), item(y))),
    "write ##3, x": n.Write(N(3), True, (item(x),)),
    "write #3": n.Write(N(3), False, ()),
    "input #3, y": n.Input(N(3), (y,)),
    "dump": n.Dump(None, "all"),
    "dump #3": n.Dump(N(3), "all"),
    "dump run": n.Dump(None, "run"),
    "time": n.Simple("time"),
    "note 'text'; x": n.Note((item(n.Text("text"), ";"), item(x))),
    "sh ls -l": n.FileCommand("sh", "ls -l"),
    "sh 'ls | wc'": n.FileCommand("sh", "ls | wc"),
    "help": n.FileCommand("help", None),
    "help d/dt": n.FileCommand("help", "d/dt"),
    "help 'FFT'": n.FileCommand("help", "FFT"),
    "irule 4": n.Irule(N(4)),
    "irule": n.Irule(None),
    "SEED 17": n.Seed(N(17)),
    "trace": n.Simple("trace"),
    "drun": n.Drun(None, False, False),
    "drun second": n.Drun("second", False, False),
    "drun *": n.Drun(None, False, True),
    "drunr": n.Drun(None, True, False),
    "drunr second": n.Drun("second", True, False),
    "reset": n.Simple("reset"),
    "clear": n.Simple("clear"),
    "STOP": n.Simple("STOP"),
    "go": n.Simple("go"),
    # --------------------------------------------------------------- commands (section 6)
    "erun": n.Simple("erun"),
    "zz": n.Simple("erun"),
    "run": n.Simple("run"),
    "ed": n.Simple("ed"),
    "edit": n.Simple("edit"),
    "keep": n.FileCommand("keep", None),
    "keep 'f'": n.FileCommand("keep", "f"),
    "keep+": n.FileCommand("keep+", None),
    "reload": n.Simple("reload"),
    "rld": n.Simple("reload"),
    "load 'f'": n.FileCommand("load", "f"),
    "load f.src": n.FileCommand("load", "f.src"),
    "old 'f'": n.FileCommand("load", "f"),
    "new": n.Simple("new"),
    "NEW": n.Simple("NEW"),
    "list": n.Simple("list"),
    "list+": n.Simple("list+"),
    "snapshot 'f.png'": n.FileCommand("snapshot", "f.png"),
    "notebook 'f.md'": n.FileCommand("notebook", "f.md"),
    "notebook off": n.FileCommand("notebook", "off"),
    "compare rule 4": n.FileCommand("compare", "rule 4"),
    "bye": n.Simple("bye"),
    "quit": n.Simple("bye"),
    "3 + a": n.Bare(op("+", N(3), a)),
    # --------------------------------------------------------------- matrices, vectors (sections 7, 9.2, 9.3)
    "MATRIX C = 0": n.MatrixAssign("C", N(0), False, None, None, None),
    "MATRIX C = A * B": n.MatrixAssign("C", op("*", V("A"), V("B")), False, None, None, None),
    "MATRIX B = A%": n.MatrixAssign("B", n.Transposed("A"), False, None, None, None),
    "MATRIX B = $In(A)": n.MatrixAssign("B", n.Call("$In", (V("A"),)), False, None, None, None),
    "MATRIX B = $Tr(A)": n.MatrixAssign("B", n.Call("$Tr", (V("A"),)), False, None, None, None),
    "MATRIX W = u & v; -1, 1": n.MatrixAssign("W", op("&", u, v), False, None, n.Unary("-", N(1)), N(1)),
    "DELTA W = [M] a*u": n.MatrixAssign("W", op("*", a, u), True, "M", None, None),
    "LEARN W = a": n.MatrixAssign("W", a, True, None, None, None),
    "Vector y = x": n.VectorAssign("y", x, False, False, None),
    "VECTOR y = x": n.VectorAssign("y", x, False, False, None),
    "Vectr y = x": n.VectorAssign("y", x, False, False, None),
    "Vector y = A% * x": n.VectorAssign("y", op("*", n.Transposed("A"), x), False, False, None),
    "Vector y = [m] v": n.VectorAssign("y", v, False, False, "m"),
    "Vector y^ = v": n.VectorAssign("y", v, False, True, None),
    "Vectr delta x = v": n.VectorAssign("x", v, True, False, None),
    "Vector delta x = v": n.VectorAssign("x", v, True, False, None),
    "Delta x = v": n.VectorAssign("x", v, True, False, None),
    "Vector delta = v": n.VectorAssign("delta", v, False, False, None),
    "Vector y = x{-1}": n.VectorAssign("y", n.Shifted("x", n.Unary("-", N(1))), False, False, None),
    "Vector y = P#": n.VectorAssign("y", n.RowOf("P"), False, False, None),
    "DOT x = u*v": n.Dot(x, op("*", u, v), False),
    "AVG y[3] = u*A%*v": n.Dot(y3, op("*", op("*", u, n.Transposed("A")), v), True),
    # --------------------------------------------------------------- DYNAMIC segments (section 9)
    "DYNAMIC": n.Simple("DYNAMIC"),
    "OUT": n.Simple("OUT"),
    "step": n.Simple("step"),
    "SAMPLE a": n.Sample(a),
    "if x - 3": n.If(None, op("-", x, N(3))),
    "end if": n.Simple("end if"),
    "d/dt x = a": n.Derivative(x, a),
    "d/dt y[3] = a": n.Derivative(y3, a),
    "Vectr d/dt x = v": n.VectorDerivative("x", v),
    "MAT d/dt x = v": n.VectorDerivative("x", v),
    "Mat d/dt x = v": n.VectorDerivative("x", v),
    "store X = x": n.Store("X", x),
    "get x = X": n.Get(x, "X"),
    "tdelay y = D(x, a": n.Delay(y, "D", x, a, True),
    "tdelay y = D(x, a)": n.Delay(y, "D", x, a, True),
    "delay y = D(x, (a)": n.Delay(y, "D", x, a, False),
    "trkhld y, x = a, b": n.TrackHold(y, x, a, b),
    "func y = F(x": n.FunctionTable(y, n.Call("func1", (x, V("F")))),
    "func2 y = F(a, b; X, Y": n.FunctionTable(y, n.Call("func2", (a, b, V("F"), V("X"), V("Y")))),
    "invoke s(x, y)": n.Invoke("s", (x, y)),
    "s(x, y)": n.Bare(n.Call("s", (x, y))),
    "term -y": n.Term(n.Unary("-", y)),
    "dispt x, y[3]": n.Request("dispt", None, (x, y3)),
    "dispxy x, y": n.Request("dispxy", None, (x, y)),
    "DISPXY x, y, a, b": n.Request("DISPXY", None, (x, y, a, b)),
    "type x, y": n.Request("type", None, (x, y)),
    "type #2, x": n.Request("type", N(2), (x,)),
    "stash x, y": n.Request("stash", None, (x, y)),
    "recover x": n.Request("recover", None, (x,)),
    "SHOW A, 5": n.Show("A", N(5)),
    "SHOW A": n.Show("A", None),
    "CLEARN v = W(x) a, b": n.Learn("CLEARN", "v", "W", "x", a, b, False),
    "CLEARN v = W(x) a, b#": n.Learn("CLEARN", "v", "W", "x", a, b, True),
    "CLEARN v = W(x) a, 0.5#": n.Learn("CLEARN", "v", "W", "x", a, N(0.5), True),
    "PLEARN y = W*x; a": n.Learn("PLEARN", "y", "W", "x", a, None, False),
    "INTP v = W*x; a": n.Learn("INTP", "v", "W", "x", a, None, False),
    "JACOBIAN": n.Simple("JACOBIAN"),
    # --------------------------------------------------------------- FFT, graphs (sections 12, 13)
    "FFT F,x,y,z": n.Fft("F", (x, y, z)),
    "FFT I, 64, y, z": n.Fft("I", (N(64), y, z)),
    "FFT R,x,y,z,u,v": n.Fft("R", (x, y, z, u, v)),
    "FFT C,x,y,z": n.Fft("C", (x, y, z)),
    "display 0": n.Display("0", ()),
    "display 1": n.Display("1", ()),
    "display 2": n.Display("2", ()),
    "display F": n.Display("F", ()),
    "display Q": n.Display("Q", ()),
    "display R": n.Display("R", ()),
    "display Y": n.Display("Y", ()),
    "display A": n.Display("A", ()),
    "display B": n.Display("B", ()),
    "display W 10, 20": n.Display("W", (N(10), N(20))),
    "display C 7": n.Display("C", (N(7),)),
    "display C16": n.Display("C", (N(16),)),
    "display N14": n.Display("N", (N(14),)),
    "display N -18": n.Display("N", (n.Unary("-", N(18)),)),
    "display N-18": n.Display("N", (n.Unary("-", N(18)),)),
    "display N colr + 1": n.Display("N", (op("+", V("colr"), N(1)),)),
    "plot x, y": n.Plot((x, y)),
    "plot x, y, 3": n.Plot((x, y, N(3))),
    "plot z": n.Plot((z,)),
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
    classes = {cls for cls in vars(n).values() if isinstance(cls, type) and issubclass(cls, n.Statement)}
    assert {type(node) for node in FORMS.values()} == classes - {n.Statement}


def test_tokenizer_and_grammar_know_the_same_words() -> None:
    """Every keyword the tokenizer makes begins a statement of the grammar, and the other way round."""
    table = tables()
    begins = {kind for kind in table.actions[table.start] if kind not in CLASSES and kind[0].isalpha()}
    assert begins == set(KEYWORDS.values()) | {"go to", "end if", "end while", "list+", "keep+", "d/dt"}


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
