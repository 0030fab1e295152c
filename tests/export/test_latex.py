"""The LaTeX of expressions and statements, written by hand; three programs whole, in golden files.

`python -m tests.export.test_latex` writes the files anew: read what changed. That all examples compile (pdflatex) and
render (KaTeX with `strict: "error"`) was tried by hand; what those two need of brackets is counted here.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from desire_tui.cli import main
from desire_tui.engine.source import Source
from desire_tui.export.formats import Export
from desire_tui.export.latex.content import content

GOLDEN = Path(__file__).parent / "latex"
EXAMPLES = Path(__file__).parents[2] / "examples"
DECLARED = (
    "STATE s[3] | ARRAY u[3], v[3], W[3,3], buffer[9], F[4], m[3] | k_off = 2 | tau = 1 | x = 0 | y = 1 | z = 1 | alpha2 = 1\n"
    "s1 = 1 | p = 1 | q = 1 | drag = 1 | FUNCTION f(a$) = a$^2\n"
    "TMAX = 1 | NN = 2\ndrun\nDYNAMIC\n"
)


def latex(text, **options):
    return content(Export(Source(text), **options)).decode()


def equations(lines):
    """Return the rows of the equations of some lines."""
    made = latex(DECLARED + lines)
    found = re.findall(r"\\begin\{align\*\}\n(.*?)\n\\end\{align\*\}", made, re.DOTALL)
    return [row.strip().removesuffix(r" \\") for part in found for row in part.split("\n")]


@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        ("d/dt x = -k_off*x", r"\frac{\mathrm{d} x}{\mathrm{d} t} &= -k_{\mathrm{off}}\,x"),
        ("y = (x + 1)/(2*drag)", r"y &= \frac{x + 1}{2\,\mathrm{drag}}"),
        ("y = -x/z - x", r"y &= -\frac{x}{z} - x"),
        ("y = z - -x*2", r"y &= z - \left(-x \cdot 2\right)"),
        ("y = 2*-x", r"y &= 2\,\left(-x\right)"),
        ("y = x - (z - 1)", r"y &= x - \left(z - 1\right)"),
        ("y = -(x + z)*3", r"y &= -\left(x + z\right) \cdot 3"),
        ("y = (-x)^2", r"y &= \left(-x\right)^{2}"),
        ("y = -x^2", r"y &= -x^{2}"),
        ("y = x^y^z", r"y &\leftarrow x^{y^{z}}"),
        ("y = (x/z)^2", r"y &= \left(\frac{x}{z}\right)^{2}"),
        ("y = sin(x)^2 + exp(-z)", r"y &= \sin^{2}\left(x\right) + \exp\left(-z\right)"),
        ("y = ln(x)^2", r"y &= \left(\ln\left(x\right)\right)^{2}"),
        ("y = sqrt(abs(x))", r"y &= \sqrt{\left|x\right|}"),
        ("y = 1.35e8*x + 1e-7", r"y &= 1.35 \times 10^{8}\,x + 10^{-7}"),
        ("y = alpha2*PI", r"y &= \alpha_{2}\,\pi"),
        ("xdot = x", r"\dot{x} &= x"),
        ("y = y + 1", r"y &\leftarrow y + 1"),
        ("y = swtch(x)*z", r"y &= \left(\begin{cases} 1, & x > 0 \\ 0, & \text{otherwise} \end{cases}\right)\,z"),
        ("y = comp(x, 2, 3)", r"y &= \begin{cases} 3, & x > 0 \\ 2, & \text{otherwise} \end{cases}"),
        ("y = (x > 1 and not (z < 2 or t = 1))*2",
         r"y &= \left[x > 1 \land \lnot \left(z < 2 \lor t = 1\right)\right] \cdot 2"),
        ("y = lim(x) + floor(x)", r"y &= \max\left(0,\, x\right) + \left\lfloor x \right\rfloor"),
        ("y = func1(x; F)", r"y &= F\left(x\right)"),
        ("y = f(x)", r"y &= f\left(x\right)"),
        ("y = s[2] - W[1,3]", r"y &= s_{2} - W_{1,3}"),
        ("d/dt x = delay(x, tau)", r"\frac{\mathrm{d} x}{\mathrm{d} t} &= x\left(t - \tau\right)"),
        ("tdelay y = buffer(x, tau)", r"y &= x\left(t - \tau\right)"),
        ("Vectr d/dt s = W*v - W%*u + x*v", (r"\frac{\mathrm{d} \mathbf{s}}{\mathrm{d} t} &= \mathbf{W}\,\mathbf{v} - "
         r"\mathbf{W}^{\mathsf{T}}\,\mathbf{u} + x\,\mathbf{v}")),
        ("Vector u = v*v/s", r"\mathbf{u} &= \frac{\mathbf{v} \odot \mathbf{v}}{\mathbf{s}}"),
        ("Vector u = v{-1} - v", r"\mathbf{u} &= \mathrm{S}^{-1} \mathbf{v} - \mathbf{v}"),
        ("Vectr delta u = v; 0, 1", r"\mathbf{u} &\leftarrow \min\left(1,\, \max\left(0,\, \mathbf{u} + \mathbf{v}\right)\right)"),
        ("Vector u = [m] v", r"\mathbf{u} &= \begin{cases} \mathbf{v}, & \mathbf{m} = 0 \\ 0, & \text{otherwise} \end{cases}"),
        ("MATRIX W = u*v", r"\mathbf{W} &= \mathbf{u}\,\mathbf{v}^{\mathsf{T}}"),
        ("DOT y = u*v - u*1", r"y &= \mathbf{u}^{\mathsf{T}}\,\mathbf{v} - \sum_{i} \mathbf{u}_{i}"),
        ("store u = x", r"u_{k} &\leftarrow x"),
        ("trkhld y, z = p, x", r"y &\leftarrow \begin{cases} z, & p > 0 \\ \text{unchanged}, & \text{otherwise} \end{cases}"),
    ],
)  # fmt: skip
def test_a_line(line, wanted):
    assert equations(line)[0] == wanted


def test_branches_are_cases():
    assert equations("if x - 1\ny = 1 | q = 2\nelse\ny = 0\nif z\np = 3\nend if\nend if\nq = 7") == [
        r"y &= \begin{cases} 1, & x - 1 > 0 \\ 0, & \text{otherwise} \end{cases}",
        r"q &= \begin{cases} 2, & x - 1 > 0 \\ \text{unchanged}, & \text{otherwise} \end{cases}",
        r"p &= \begin{cases} 3, & x - 1 \le 0 \land z > 0 \\ \text{unchanged}, & \text{otherwise} \end{cases}",
        "q &= 7",
    ]


def test_long_sums_go_on_in_the_next_row():
    rows = equations("y = " + " + ".join(f"sin({k}*x)" for k in range(1, 25)))
    assert len(rows) > 2
    assert all(row.startswith(r"&\quad + ") for row in rows[1:])
    assert "".join(row.replace(r"&\quad", "") for row in rows).count(r"\sin") == 24


def test_a_sum_of_thousands_of_terms_is_written():
    assert len(equations("y = " + " + ".join(["x"] * 5000))) > 100


def test_what_has_no_form_is_listed_with_its_line():
    made = latex(
        "ARRAY v[2], W[2,2], x[2], c[2]\nNN = 2\ndrun\nDYNAMIC\nCLEARN v = W(x) 0.1, -1\ny_1 = 2\ntype y_1\n"
    )
    assert "\\begin{verbatim}\nline 5: CLEARN v = W(x) 0.1, -1\n\\end{verbatim}" in made
    assert "y_{1} &= 2" in made


def test_units_stand_in_the_tables_and_settings_count():
    text = "k = 2 | m_1 = 3 | units 'k N/m, x %'\nTMAX = 1 | NN = 2 | drun\nDYNAMIC\nd/dt x = -k*x/m_1\n"
    made = latex(text, settings={"k": 5.0})
    assert "parameter & value & unit \\\\\n\\hline\n$k$ & $5$ & N/m \\\\\n$m_{1}$ & $3$ &  \\\\" in made
    assert r"$x(0)$ & $0$ & \% \\" in made


def test_one_segment_alone():
    text = "x = 1 | TMAX = 1 | NN = 2 | drun back\nDYNAMIC\nd/dt x = -x\nlabel back\nd/dt x = x\n"
    assert latex(text).count(r"\section*") == 2
    assert r"\section*{Segment back}" in latex(text, segment="back")
    assert latex(text, segment="back").count(r"\section*") == 1


def test_the_command_writes_a_file(tmp_path):
    path = tmp_path / "lorenz.tex"
    done = CliRunner().invoke(main, ["export", str(EXAMPLES / "ch2" / "lorenz.src"), "-o", str(path)])
    assert (done.exit_code, done.output) == (0, f"{path}\n")
    assert path.read_text(encoding="utf-8").startswith("\\documentclass{article}\n")


NAMES = ("ch2/lorenz", "ch6/normaliser_submodel", "ch4/schmitt_trigger")


def made_of(name):
    path = EXAMPLES / f"{name}.src"
    return content(Export(Source(path.read_text(encoding="utf-8"), path.name, path))).decode()


@pytest.mark.parametrize("name", NAMES)
def test_a_whole_document(name):
    assert made_of(name) == (GOLDEN / f"{Path(name).name}.tex").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "name", ["ch7/glucose_tolerance", "ch2/torpedo", "ch3/servo_pid", "ch6/delays", "ch6/vector_recursions"]
)
def test_brackets_and_environments_are_in_pairs(name):
    text = re.sub(r"\\begin\{verbatim\}.*?\\end\{verbatim\}", "", made_of(name), flags=re.DOTALL)
    for part in re.findall(r"\\begin\{align\*\}.*?\\end\{align\*\}|\$[^$]+\$", text, re.DOTALL):
        assert len(re.findall(r"\\left(?!arrow)", part)) == len(re.findall(r"\\right(?!arrow)", part))
        bare = part.replace(r"\{", "").replace(r"\}", "")
        depth = 0
        for char in bare:
            depth += (char == "{") - (char == "}")
            assert depth >= 0
        assert depth == 0
        assert not re.search(r"_\{[^{}]*\}_|\^\{[^{}]*\}\^", part)  # double subscripts stop TeX


if __name__ == "__main__":
    GOLDEN.mkdir(exist_ok=True)
    for one in NAMES:
        (GOLDEN / f"{Path(one).name}.tex").write_text(made_of(one), encoding="utf-8")
