"""Loops as one function do what their statements do one by one: the same bits, ways out, stops and errors."""

from __future__ import annotations

import struct

import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.interpreter import hot_loops
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.library import LIBRARY
from tests.interpreter.stand_in import RecordingHost, run

SETUP = """
INTEGER i | COMPLEX w | ARRAY A[7], T[4]
data 0; 1; 5; 9 | read T
x = 0.3 | y = 2 | s = 0 | i = 0 | w = [1, 2] | u = 0 | count = 0
FUNCTION f(a) = a*x + 1
PROCEDURE p(a; r)
r = r + a
count = count + 1
end
PROCEDURE q(n; r)
for m = 1 to n
r = r + m*0.25
x = r
next
end
PROCEDURE look(n; r)
for m = 1 to n
x = x + 0.25
s = s + r
next
end
"""
LOOPS = {
    "counted": "for k = 1 to 700 | s = s + k/7 | next",
    "backwards": "for k = 3 to -4 step -0.01 | s = s*0.9 + k | next",
    "whole variable": "for i = 1 to 700 | s = s + i/3 | next",
    "in each other": "for k = 1 to 300 | for h = 1 to k/20 | s = s + h*k | next | y = y + s | next",
    "no pass inside": "for k = 1 to 300 | for h = 1 to 0 | s = 1 | next | y = y + h | next",
    "while": "while u < 500 | u = u + 1 | s = s + sin(u) | end while",
    "repeat": "repeat | u = u + 1 | s = s + x^u | until u >= 500",
    "while in for": "for k = 1 to 260 | u = 0 | while u < 3 | u = u + 1 | s = s + u/k | end while | next",
    "repeat in while": "while u < 400 | repeat | u = u + 1 | y = y/1.01 | until u/5 = trnc(u/5) | end while",
    "branches": "for k = 1 to 600 | if k < 300 then | s = s + 1 | else | s = s - 0.3 | y = k | proceed | next",
    "branch reached late": "for k = 1 to 600 | if k > 400 then | s = s + k | z = s | proceed | next",
    "new name late": "for k = 1 to 900 | if k = 700 then | z = z + 5 | proceed | if k > 800 then | z = z + 1 | proceed | next",
    "exit": "for k = 1 to 900 | s = s + k | if s > 1.2e5 then | exit | proceed | next",
    "exit inside": "for k = 1 to 300 | for h = 1 to 9 | if h > 3 then | exit | proceed | s = s + h | next | next",
    "exit of while": "while 1 > 0 | u = u + 1 | if u > 450 then | exit | proceed | end while",
    "writes": "for k = 1 to 900 | s = s + k | if k/150 = trnc(k/150) then | write k, s | proceed | next",
    "writes inside": "for k = 1 to 300 | for h = 1 to 3 | s = s + h | if s = 1500 then | write k, h, s | proceed | next | next",
    "calls": "for k = 1 to 900 | if k > 600 then | call p(k; s) | proceed | next",
    "goes out": "for k = 1 to 900 | s = s + k | if k = 650 then | go to out | proceed | next | label out",
    "goes on inside": "for k = 1 to 900 | if k > 500 then | go to on | proceed | s = s + 1 | label on | y = y + 1 | next",
    "elements": "for k = 1 to 700 | A[1 + k - 7*trnc(k/7)] = A[3] + k | s = s + A[2] | next",
    "table": "for k = 1 to 500 | s = s + func1(k/500, T) | next",
    "function of x": "for k = 1 to 500 | x = x/1.1 | s = s + f(k) | next",
    "complex": "for k = 1 to 500 | w = w*[0.6, 0.8] + k | next",
    "whole": "for k = 1 to 500 | i = k/3 | s = s + i | next",
    "names of a procedure": "for k = 1 to 3 | call q(300; s) | next",
    "another name of x": "call q(400; x)",
    "another name is read": "call look(300; x)",
    "random": "for k = 1 to 500 | s = s + ran() + gauss(0) | next",
    "conditions": "for k = 1 to 500 | if k > 20 and not (k < 100 or s > 9e4) then | s = s + (k > 3)*k | proceed | next",
    "clear": "for k = 1 to 500 | if k = 400 then | clear | s = 7 | k = 499 | proceed | next",
    "powers": "for k = 1 to 500 | s = s + k^3 - x^2 + y^0.5 + (k/500)^-2 | next",
}  # fmt: skip


def state(host: RecordingHost) -> tuple[list[tuple[str, bytes]], str]:
    found = []
    for quantity in host.values:
        if host.values.is_defined(quantity):
            data = host.values.data[quantity.slot : quantity.slot + quantity.slots]
            found.append((quantity.name, struct.pack(f"{len(data)}d", *data)))
    return found, host.text


@pytest.fixture
def fused(monkeypatch) -> list[int]:
    """The places of loops that became functions."""
    places: list[int] = []
    fuse = hot_loops.fuse

    def noting(machine, code, opening, passes):
        function = fuse(machine, code, opening, passes)
        places.append(opening)
        return function

    monkeypatch.setattr(hot_loops, "fuse", noting)
    return places


@pytest.mark.parametrize("name", LOOPS)
def test_a_loop_leaves_the_same_numbers(name, fused, monkeypatch):
    text = SETUP + LOOPS[name].replace(" | ", "\n")
    hot = state(run(text))
    assert fused
    monkeypatch.setattr(hot_loops, "HOT", -1)
    del fused[:]
    assert hot == state(run(text))
    assert not fused


def test_a_loop_that_runs_models_stays_as_it_is(fused):
    host = run("for k = 1 to 500 | s = k | drun | next")
    assert len(host.calls) == 500
    assert not fused


@pytest.mark.parametrize(
    ("body", "inner"),
    [
        ("write k", 0),
        ("s = k | call p(k; s)", 0),
        ("if k > 900 then | s = 1 | proceed | write k", 0),
        ("if k > 900 then | s = 1 | else | s = 2 | proceed | write k", 0),
        ("for h = 1 to 2 | s = h | next | repeat | s = s + 1 | until s > 3 | write k", 2),
        ("label on | while s < 2 | s = 3 | end while | drun", 1),
    ],
)
def test_what_every_pass_comes_to_is_seen_before_the_first(body, inner, monkeypatch):
    made = []
    monkeypatch.setattr(hot_loops, "_HotLoop", lambda *_: made.append(1))
    run(f"{SETUP}for k = 1 to 1 | {body} | next".replace(" | ", "\n"))
    assert len(made) == inner


def test_a_function_that_is_left_at_once_is_given_up(monkeypatch):
    entered = []
    fuse = hot_loops.fuse

    def counting(*args):
        function = fuse(*args)
        return lambda: entered.append(1) or function()

    monkeypatch.setattr(hot_loops, "fuse", counting)
    host = run("s = 0\nfor k = 1 to 5000\ns = s + 1\nif k > 0 then\nwrite k\nproceed\nnext")
    assert host["s"] == 5000
    assert len(host.written) == 5000
    assert len(entered) == 256


@pytest.mark.parametrize(
    ("body", "code", "piece"),
    [
        ("y = 1/(600 - k)", 5, "(600 - k)"),
        ("y = x\nz = sqrt(600 - k)", 47, "sqrt(600 - k)"),
        ("if k > 500 then\ny = 1\nelse\ny = exp(k*k)\nproceed", 3, "exp(k*k)"),
        ("for j = 1 to 3 step 600 - k\nnext", 23, "600 - k"),
        ("A[k/100] = 1", 2, "k/100"),
        ("y = f(600 - k)", 5, "a"),
    ],
)
def test_an_error_names_its_statement(body, code, piece, monkeypatch):
    text = f"ARRAY A[5] | x = 1\nFUNCTION f(a) = 1/a\nfor k = 1 to 900\n{body}\nnext"

    def problem():
        host = RecordingHost()
        with pytest.raises(DesireError) as caught:
            host.run(text)
        return caught.value.diagnostics[0], state(host)

    found, left = problem()
    monkeypatch.setattr(hot_loops, "HOT", -1)
    plain, plain_left = problem()
    assert (found.code, text[found.span.start : found.span.end]) == (code, piece)
    assert (found.span, found.message) == (plain.span, plain.message)
    assert [(r.span, r.message) for r in found.related] == [(r.span, r.message) for r in plain.related]
    assert left == plain_left


def test_the_user_gets_in_and_finds_the_numbers():
    host = RecordingHost()
    host.looks_allowed = 250
    seen = []
    looks = host.interrupted

    def look() -> bool:
        seen.append(host.values.cells[host.values.names["s"].slot])
        return looks()

    host.interrupted = look
    with pytest.raises(Interrupted):
        host.run("s = 0\nwhile 1 > 0\ns = s + 1\nend while")
    assert 10_000 < host["s"] < 20_000  # a look in 256 passes
    assert seen[-1] == host["s"]
    assert seen[-2] == host["s"] - 256


def test_a_stop_in_a_rare_branch_and_go():
    host = run("s = 0\nfor k = 1 to 900\ns = s + 1\nif k = 600 then\nSTOP\nproceed\nnext")
    assert (host["s"], host["k"]) == (600, 600)
    host.execute("s = 1000")
    host.interpreter.go()
    assert (host["s"], host["k"]) == (1300, 900)


def test_breakpoints_and_tracing_reach_a_loop_that_goes_round():
    host = RecordingHost()
    interpreter = host.load("s = 0\nfor k = 1 to 100000\ns = s + 1\ny = s\nnext")
    looks = host.interrupted

    def look() -> bool:
        if host.looks == 210:
            interpreter.halt_at([4])
        return looks()

    host.interrupted = look
    interpreter.run()
    at_stop = host["s"]
    assert interpreter.position is not None
    assert 200 < at_stop < 100_000
    interpreter.go()
    assert host["s"] == at_stop + 1
    interpreter.halt_at([])
    interpreter.stepping = True
    host.before = lambda placed: host["s"] > at_stop + 5 and interpreter.stop_here()
    interpreter.go()
    assert host["s"] == at_stop + 6
    interpreter.stepping = False
    interpreter.go()
    assert host["s"] == 100_000


@pytest.mark.parametrize(
    "name", [n for n, f in LIBRARY.items() if f.value and "S" in f.where and f.kind != "table"]
)
def test_library_functions_give_floats(name):
    """A variable keeps what it is given: a whole number would be another type there than in a cell."""
    entry = LIBRARY[name]
    for count in range(entry.fewest, entry.most + 1):
        value = entry.value(*[0.5] * count)
        assert type(value) is float or (entry.gives_complex and type(value) is complex)
