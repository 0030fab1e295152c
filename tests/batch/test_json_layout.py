"""The public layout of `desire run --json` (headless.md 3), field by field."""

from __future__ import annotations

import json
from math import exp

import pytest

import desire_tui
from desire_tui.engine.outputs.json_file import as_json

NUMBER, WHOLE, TEXT, TRUTH = "number", "whole number", "text", "truth"


class OrNull:
    def __init__(self, what):
        self.what = what


class Mapped:
    def __init__(self, what):
        self.what = what


class Nested:
    """A number or lists of them in any depth."""


PROBLEM = {
    "code": WHOLE, "severity": ("error", "warning"), "message": TEXT, "file": OrNull(TEXT),
    "line": OrNull(WHOLE), "column": OrNull(WHOLE), "end_line": OrNull(WHOLE), "end_column": OrNull(WHOLE),
    "hint": OrNull(TEXT),
}  # fmt: skip
CURVE = {"name": TEXT, "x": OrNull(TEXT), "values": [NUMBER]}
RUN = {
    "segment": OrNull(TEXT), "line": WHOLE, "request": ("dispt", "dispxy", "DISPXY", "type", "none"),
    "overlay": TRUTH, "rule": WHOLE, "scale": NUMBER, "t0": NUMBER, "tmax": NUMBER, "nn": WHOLE, "dt": NUMBER,
    "t": [NUMBER], "curves": [CURVE], "ended": ("tmax", "term", "stopped", "failed"), "end_time": NUMBER,
    "steps": WHOLE, "rejected": WHOLE, "derivative_calls": WHOLE, "jacobian_calls": WHOLE, "dt_least": NUMBER,
    "dt_most": NUMBER, "order": WHOLE, "seconds": NUMBER, "parameters": Mapped(NUMBER),
    "initial": Mapped(NUMBER), "continues": TRUTH,
}  # fmt: skip
LAYOUT = {
    "desire": TEXT, "program": TEXT, "status": ("done", "failed", "stopped", "limit"), "problems": [PROBLEM],
    "console": TEXT, "runs": [RUN], "plots": [{"x": NUMBER, "y": NUMBER, "color": WHOLE}],
    "quantities": Mapped(Nested()), "timings": {"parse_s": NUMBER, "compile_s": NUMBER, "run_s": NUMBER},
}  # fmt: skip


def complaints(value, layout, place="result"):
    """Return where a value is not what the layout says."""
    match layout:
        case "number":
            right = value in ("inf", "-inf", "nan") or (type(value) in (int, float))
            return [] if right else [place]
        case "whole number":
            return [] if type(value) is int else [place]
        case "text":
            return [] if type(value) is str else [place]
        case "truth":
            return [] if type(value) is bool else [place]
        case tuple():
            return [] if value in layout else [place]
        case OrNull():
            return [] if value is None else complaints(value, layout.what, place)
        case Mapped():
            return [
                w for name, item in value.items() for w in complaints(item, layout.what, f"{place}.{name}")
            ]
        case Nested():
            if isinstance(value, list):
                return [w for i, item in enumerate(value) for w in complaints(item, layout, f"{place}[{i}]")]
            return complaints(value, NUMBER, place)
        case [item]:
            if not isinstance(value, list):
                return [place]
            return [w for i, one in enumerate(value) for w in complaints(one, item, f"{place}[{i}]")]
        case _:
            if not isinstance(value, dict) or list(value) != list(layout):
                return [f"{place}: {list(value) if isinstance(value, dict) else value}"]
            return [w for name in layout for w in complaints(value[name], layout[name], f"{place}.{name}")]


def data_of(text, **options):
    """Run a program; return its JSON, read again, whose layout is as it must be."""
    data = json.loads(as_json(desire_tui.run(text, **options)), parse_constant=pytest.fail)
    assert complaints(data, LAYOUT) == []
    return data


EVENTFUL = """COMPLEX z, Z[2] | z = [3, -4] | INTEGER k | k = 7 | ARRAY A[2,3] | A[2,3] = 5
TMAX = 1 | DT = 0.1 | NN = 3 | x = 1 | scale = 4
plot 0.5, -0.25, 12
write 'k = '; k
drun
display 2
drun
irule 14 | ERMAX = 1E-6 | display 1
drun xy
drun pairs
drun list
drun nothing
NN = 4 | t = 1 | TMAX = 3
drun maps
DYNAMIC
d/dt x = -x
dispt x, A[2,3]
label xy
d/dt x = -x
y = 2*x
dispxy x, y
term 0.1 - x
label pairs
d/dt x = 1
y = 2*x
dispxy x, y
type t, y
label list
d/dt x = 1
type x
label nothing
d/dt x = 1
label maps
w = t | v = 1.0E+200*w
DISPXY w, v, v, w
"""


def test_a_program_with_everything():
    data = data_of(EVENTFUL)
    assert (data["status"], data["problems"], data["program"]) == ("done", [], "<text>")
    assert data["desire"] == desire_tui.__version__
    assert data["console"].startswith("k = 7\n")
    assert data["plots"] == [{"x": 0.5, "y": -0.25, "color": 12}]
    quantities = data["quantities"]
    assert quantities["z"] == [3, -4]
    assert quantities["Z"] == [[0, 0], [0, 0]]
    assert quantities["A"] == [[0, 0, 0], [0, 0, 5]]
    assert quantities["k"] == 7
    runs = data["runs"]
    assert [r["request"] for r in runs] == ["dispt", "dispt", "dispxy", "dispxy", "type", "none", "DISPXY"]
    assert [r["segment"] for r in runs] == [None, None, "xy", "pairs", "list", "nothing", "maps"]
    assert [r["line"] for r in runs] == [5, 7, 9, 10, 11, 12, 14]
    assert [r["overlay"] for r in runs] == [False, True, False, False, False, False, False]
    assert [r["rule"] for r in runs] == [1, 1, 14, 14, 14, 14, 0]
    assert [r["ended"] for r in runs] == ["tmax", "tmax", "term", "tmax", "tmax", "tmax", "tmax"]


def test_each_field_of_a_run():
    first, second, orbit, both, listing, nothing, maps = data_of(EVENTFUL)["runs"]
    ten = (1 - 0.1 + 0.005) ** 10
    assert (first["scale"], first["t0"], first["tmax"], first["nn"], first["dt"]) == (4, 0, 1, 3, 0.1)
    assert first["t"] == pytest.approx([0, 0.5, 1])
    assert [(c["name"], c["x"]) for c in first["curves"]] == [("x", None), ("A[2,3]", None)]
    assert first["curves"][0]["values"] == pytest.approx([1, (1 - 0.1 + 0.005) ** 5, ten])
    assert first["curves"][1]["values"] == [5, 5, 5]  # unclipped: scale is 4
    assert (first["end_time"], first["steps"], first["rejected"], first["order"]) == (1, 10, 0, 0)
    assert (first["dt_least"], first["dt_most"], first["jacobian_calls"]) == (0.1, 0.1, 0)
    assert first["derivative_calls"] in (20, 21)
    assert first["seconds"] > 0
    assert (second["t0"], second["t"][0], second["t"][-1]) == (1, 1, pytest.approx(2))
    assert [(c["name"], c["x"]) for c in orbit["curves"]] == [("x", None), ("y", "x")]
    assert orbit["end_time"] == orbit["t"][-1]
    assert orbit["end_time"] > orbit["t0"]
    assert orbit["curves"][0]["values"][-1] == pytest.approx(
        ten**2 * exp(orbit["t0"] - orbit["end_time"]), rel=1e-4
    )
    assert orbit["jacobian_calls"] > 0
    assert orbit["order"] > 0
    assert 0 < orbit["dt_least"] <= orbit["dt_most"]
    assert [(c["name"], c["x"]) for c in both["curves"]] == [("x", None), ("y", "x"), ("t", None)]
    assert both["curves"][2]["values"] == both["t"]
    assert [(c["name"], c["x"]) for c in listing["curves"]] == [("x", None)]
    assert nothing["curves"] == []
    assert len(nothing["t"]) == 3
    assert [(c["name"], c["x"]) for c in maps["curves"]] == [("w", None), ("v", "w")]
    assert (maps["t"], maps["steps"], maps["dt_least"], maps["dt_most"]) == ([1, 2, 3, 4], 0, 0, 0)


def test_a_run_that_fails():
    data = data_of("x = 1\nTMAX = 5 | DT = 0.001 | NN = 6\ndrun\nDYNAMIC\nd/dt x = x*x\ndispt x\n")
    (run,), (problem,) = data["runs"], data["problems"]
    assert (data["status"], run["ended"]) == ("failed", "failed")
    assert run["t"] == pytest.approx([0, *range(1, len(run["t"]))])
    assert 1 < run["end_time"] <= 2
    assert (problem["severity"], problem["file"], problem["line"], problem["column"]) == (
        "error",
        "<text>",
        5,
        10,  # x*x
    )
    assert (problem["end_line"], problem["end_column"]) == (5, 13)
    assert problem["code"] > 0


def test_numbers_that_are_none_are_strings():
    data = data_of("NN = 3\nARRAY a[2]\ndrun\nDYNAMIC\nx = 0\ndispt x\nOUT\na[1] = 1/x\na[2] = 0/x\n")
    assert data["quantities"]["a"] == ["inf", "nan"]


def test_stopped_limited_and_unreadable_programs():
    assert data_of("x = 1\nSTOP\nx = 2\n")["status"] == "stopped"
    limited = data_of("TMAX = 1E+09 | DT = 0.001\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x\n", timeout=0.5)
    assert limited["status"] == "limit"
    assert [p["code"] for p in limited["problems"]] == [490]
    assert limited["runs"][-1:] == [] or limited["runs"][-1]["ended"] == "stopped"
    broken = data_of("x = (1\ny = 2)\n")
    assert (broken["status"], len(broken["problems"]), broken["runs"]) == ("failed", 2, [])


def test_a_warning_is_among_the_problems():
    text = "ARRAY J[1,1] | x = 1 | irule 14 | ERMAX = 1E-6 | TMAX = 1 | DT = 0.01 | NN = 3\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\nJACOBIAN\nJ[1,1] = -2\n"
    data = data_of(text)
    assert data["status"] == "done"
    assert [(p["code"], p["severity"], p["line"]) for p in data["problems"]] == [(462, "warning", 7)]
