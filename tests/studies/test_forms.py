"""What varies and what is kept, as users write it; what is wrong is said with its place and a remedy."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.studies.design import Design
from desire_tui.studies.design_forms import over_mapping, over_texts, points_of, sample_texts
from desire_tui.studies.distributions import distribution
from desire_tui.studies.keep import kept


def test_what_can_be_kept():
    items = kept("x[end], max(abs(e)), t[miss<1 or y>2], y@0:2:0.5, A[2][end], p = min(x)").items
    assert [(item.label, item.kind, item.expression.text) for item in items] == [
        ("x[end]", "last", "x"),
        ("max(abs(e))", "max", "abs(e)"),
        ("t[miss<1 or y>2]", "when", "(miss<1 or y>2)"),
        ("y@0:2:0.5", "at", "y"),
        ("A[2][end]", "last", "A[2]"),
        ("p", "min", "x"),
    ]
    assert items[3].times == (0.0, 0.5, 1.0, 1.5, 2.0)
    assert kept("x@1").items[0].single
    assert kept(["x[end]", "x@(0, 3)"]).items[1].times == (0.0, 3.0)
    assert kept("max(a, b)[end]").items[0].expression.text == "max(a, b)"
    assert len(kept("x@0:0.3:0.1").items[0].times) == 4, "0.1 three times is 0.3, whatever the rounding"


@pytest.mark.parametrize(
    ("text", "column", "message", "hint"),
    [
        ("x", 1, "'x' has many values in a run", "x[end] is its last value"),
        ("y[end], mx(x)", 9, "'mx(x)' is no number of a run", "did you mean 'max(x)'?"),
        ("max(x, y)", 1, "'max(x, y)' has many values", "x[end]"),
        ("abs(x)", 1, "'abs(x)' has many values", "x[end]"),
        (
            "kurtosis(x)",
            1,
            "'kurtosis' is neither kept nor computed",
            "max, min, mean, std, integral, first, last",
        ),
        ("max(x) - min(x)", 1, "is computed from what is kept", "max(x - y)"),
        ("abs(x[end])", 1, "is computed from what is kept", "(x - y)[end]"),
        ("x@0:2", 3, "'0:2' names no times", "from, to, step"),
        ("x@0:2:-1", 7, "steps of -1 lead from 0 never to 2", "for instance"),
        ("x@0:1:1e-8", 3, "100000001 times are more than", "a larger step"),
        ("x@soon", 3, "'soon' is no number", "for instance"),
        ("x[end], x[end]", 9, "'x[end]' is kept twice", "peak = max(x)"),
        ("@2", 1, "an expression is missing", "for instance"),
        ("", 1, "nothing is kept", "for instance"),
    ],
)
def test_what_cannot_be_kept(text, column, message, hint):
    with pytest.raises(DesireError) as error:
        kept(text)
    problem = error.value.diagnostics[0]
    assert message in problem.message
    assert hint in problem.hint
    assert (problem.file, problem.line, problem.column) == ("--keep", 1, column)


def test_expressions_that_are_none():
    for text, column in (("max(e+)", 7), ("sin(e[end]", 6)):
        with pytest.raises(DesireError) as error:
            kept(f"{text}").expressions()
        assert error.value.diagnostics[0].column == column, text


def test_what_varies():
    found = over_texts(["UC=0.2:0.3:3", "lead = 0, 5, 10", "k=1:1000:4:log", "a[2]=1"])
    assert {name: values.tolist() for name, values in found.items()} == {
        "UC": [0.2, 0.25, 0.3], "lead": [0, 5, 10], "k": pytest.approx([1, 10, 100, 1000]), "a[2]": [1],
    }  # fmt: skip
    assert over_mapping({"k": 3, "r": [1, 2], "s": "0:1:3"})["s"].tolist() == [0, 0.5, 1]


@pytest.mark.parametrize(
    ("text", "column", "message"),
    [
        ("UC", 1, "'UC' names nothing that varies"),
        ("UC=", 1, "has nothing behind ="),
        ("UC=1:2", 4, "'1:2' names no values"),
        ("UC=1:2:x", 8, "'x' is no number"),
        ("UC=1:2:1000000000000", 8, "1e+12 values are more than 10,000,000"),
        ("UC=1:2:2.5", 8, "2.5 is no number of values"),
        ("1x=3", 1, "'1x' is no name of a quantity"),
        ("UC=-1:2:3:log", 4, "a logarithmic scale has no 0"),
        ("UC=1,,2", 6, "'' is no number"),
        ("UC=1,inf", 6, "'inf' is no number"),
    ],
)
def test_what_cannot_vary(text, column, message):
    with pytest.raises(DesireError) as error:
        over_texts([text])
    problem = error.value.diagnostics[0]
    assert message in problem.message
    assert (problem.file, problem.column) == ("--over", column)


@pytest.mark.parametrize(
    ("text", "column", "message", "hint"),
    [
        ("k=norml(1,2)", 3, "there is no distribution 'norml'", "did you mean 'normal'?"),
        ("k=normal(1)", 3, "normal takes 2 numbers, not 1", "mean, standard deviation"),
        ("k=normal(1,-2)", 12, "a standard deviation of -2 is not above 0", ""),
        ("k=uniform(2,1)", 3, "nothing lies between 2 and 1", ""),
        ("k=gamma()", 3, "gamma does not take these arguments", "a, loc, scale"),
        ("k=beta(-1,2)", 3, "beta is not defined for these numbers", "a, b, loc, scale"),
        ("k=normal", 3, "'normal' is no distribution", "for instance"),
        ("k=normal(a,2)", 10, "'a' is no number", ""),
    ],
)
def test_what_cannot_be_drawn(text, column, message, hint):
    with pytest.raises(DesireError) as error:
        sample_texts([text])
    problem = error.value.diagnostics[0]
    assert message in problem.message
    assert hint in problem.hint
    assert (problem.file, problem.column) == ("--sample", column)


def test_distributions_have_their_everyday_meaning_or_scipys():
    from scipy import stats

    u = np.linspace(0.001, 0.999, 1001)
    for text, same in (
        ("uniform(-1, 3)", stats.uniform(-1, 4)),
        ("normal(40, 4)", stats.norm(40, 4)),
        ("lognormal(0.5, 0.2)", stats.lognorm(0.2, scale=np.exp(0.5))),
        ("gamma(2, scale=3)", stats.gamma(2, scale=3)),
        ("randint(1, 7)", stats.randint(1, 7)),
    ):
        assert distribution(text).numbers(u) == pytest.approx(same.ppf(u), rel=1e-12, abs=1e-12), text
    assert repr(distribution(stats.gamma(2, scale=3))) == "gamma(2, scale=3)"


def test_what_varies_twice():
    for make in (
        lambda: over_texts(["k=1", "k=2"]),
        lambda: sample_texts(["k=normal(1,2), k=normal(2,2)"]),
        lambda: Design(over_texts(["k=1"]), sample_texts(["k=normal(1,2)"]), runs=3),
    ):
        with pytest.raises(DesireError, match="'k' is given twice"):
            make()


def test_studies_of_no_runs(tmp_path):
    (tmp_path / "empty.csv").write_text("")
    (tmp_path / "names.csv").write_text("a, b\n")
    drawn = sample_texts(["k=normal(1,2)"])
    for make, message in (
        (lambda: over_texts(["k=1:2:0"]), "'1:2:0' has no values"),
        (lambda: Design(over_mapping({"k": []})), "'k' has no values"),
        (lambda: Design({}, drawn), "nobody says how often"),
        (lambda: Design({}, drawn, runs=0), "runs is 0"),
        (lambda: points_of(tmp_path / "empty.csv"), "empty.csv is empty"),
        (lambda: Design({}, points=points_of(tmp_path / "names.csv")), "its list is empty"),
        (lambda: Design({}, points={"a": np.ones(2), "b": np.ones(3)}), "2 and 3 values"),
        (lambda: Design({}, points={"a": np.ones(2)}, runs=3), "3 runs are wanted of a list of 2"),
        (lambda: Design({}, drawn, runs=1 << 40, method="sobol"), "Sobol sequence has"),
    ):
        with pytest.raises(DesireError, match=message):
            make()


def test_lists_from_files(tmp_path):
    path = tmp_path / "runs.csv"
    path.write_text("k, a[2]\n1, 2\n\n3, 4e-1\n")
    found = points_of(str(path))
    assert {name: values.tolist() for name, values in found.items()} == {"k": [1, 3], "a[2]": [2, 0.4]}
    for text, message in (("k,r\n1\n", "1 value in a line of 2"), ("k\nx\n", "'x' is no number")):
        path.write_text(text)
        with pytest.raises(DesireError, match=message) as error:
            points_of(path)
        assert (error.value.diagnostics[0].file, error.value.diagnostics[0].line) == (str(path), 2)


@pytest.mark.parametrize(
    "text",
    [
        "k;r\n1,5;2\n-3;4e-1\n",
        "\ufeffk\tr\r\n# b\r\n1.5\t2\r\n\r\n-3\t.4\r\n",
        '"k","r"\n1.5,"2"\n-3,0.4\n',
    ],
)
def test_lists_as_spreadsheets_write_them(tmp_path, text):
    path = tmp_path / "runs.csv"
    path.write_text(text, "utf-8", newline="")
    found = points_of(path)
    assert {name: values.tolist() for name, values in found.items()} == {"k": [1.5, -3], "r": [2, 0.4]}


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("k,r\n1,2\n\n\n3,x4\n", (5, 3), "'x4' is no number"),
        ("k,r\n1,\n", (2, 3), "a number is missing"),
        ("k, k\n1,2\n", (1, 4), "'k' is given twice"),
        ("k,,r\n1,2,3\n", (1, 3), "a name is missing here"),
        ("k,2r\n1,2\n", (1, 3), "'2r' is no name"),
        ("k,r\n1,2,3\n", (2, 1), "3 values in a line of 2"),
    ],
)
def test_what_is_wrong_in_a_list_is_said_with_its_place(tmp_path, text, place, message):
    path = tmp_path / "runs.csv"
    path.write_text(text)
    with pytest.raises(DesireError, match=message) as error:
        points_of(path)
    problem = error.value.diagnostics[0]
    assert (problem.line, problem.column) == place
