"""STOP and go, commands, tracing, interruption, clear."""

from __future__ import annotations

import pytest

from desire_tui.engine.diagnostics import DesireError
from tests.interpreter.stand_in import Interrupted, RecordingHost, run


def code_of(action) -> int:
    with pytest.raises(DesireError) as caught:
        action()
    return caught.value.diagnostics[0].code


def test_stop_and_go():
    host = run("x = 1\nSTOP\nx = 2\nSTOP\nx = 3")
    assert host["x"] == 1
    assert host.interpreter.position.node.value.value == 2
    host.interpreter.go()
    assert host["x"] == 2
    host.execute("x = 10 | go")
    assert host["x"] == 3
    assert host.interpreter.position is None
    assert code_of(host.interpreter.go) == 43


def test_stop_inside_a_loop_in_a_procedure():
    host = run(
        "PROCEDURE p(n; s)\nfor k = 1 to n\ns = s + k\nif k = 2 then | STOP | proceed\nnext\nend\nt = 0\ncall p(4; t)\nu = t"
    )
    assert host["t"] == 3
    host.execute("t = 100")
    host.interpreter.go()
    assert host["u"] == 107


def test_stop_in_a_procedure_called_by_a_command():
    host = RecordingHost()
    host.load("PROCEDURE p(;s)\ns = 1\nSTOP\ns = 2\nend")
    host.execute("call p(;x) | y = x")
    assert host["x"] == 1
    host.interpreter.go()
    assert (host["x"], host["y"]) == (2, 2)
    host.execute("z = 5")
    assert host["z"] == 5


def test_commands_loop_print_and_define():
    host = run("")
    host.execute("s = 0 | for k = 1 to 10 | s = s + k | next | write s")
    host.execute("s*2")
    host.execute("FUNCTION f(a) = a*a | f(5) + 1")
    host.execute("FUNCTION f(a) = a | f(5)")
    assert host.text == "55\n110\n26\n5\n"


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("STOP", 22),
        ("display 2", 22),
        ("label L", 22),
        ("input x", 22),
        ("go", 43),
        ("for k = 1 to 3", 24),
        ("next", 27),
    ],
)
def test_what_is_no_command(line, code):
    host = run("")
    assert code_of(lambda: host.execute(line)) == code


@pytest.mark.parametrize(
    ("script", "code"), [("erun", 199), ("go", 199), ("1 + 2", 1), ("store X = x", 300), ("d/dt x = 1", 300)]
)
def test_what_is_no_script_statement(script, code):
    assert code_of(lambda: run(script)) == code


def test_a_changed_function_is_seen_by_the_script():
    host = run("FUNCTION f(a) = a + 1\nlabel L\nx = f(1)\nSTOP\ngo to L")
    host.execute("FUNCTION f(a) = a + 10")
    host.interpreter.go()
    assert host["x"] == 11


def test_clear_in_the_middle_forgets_everything_but_goes_on():
    host = run(
        "x = 5\nlabel L\ny = 1\nif scale = 1 then | scale = 2 | go to L | proceed\nclear\nw = 3 | y = 2"
    )
    assert host.values.find("x") is None
    assert (host["w"], host["y"], host["scale"]) == (3, 2, 1)


def test_a_loop_survives_clear():
    host = run("for k = 1 to 3\nwrite k;\nclear\nnext")
    assert host.text == "123"


@pytest.mark.parametrize(
    "script",
    [
        "label L | go to L",
        "while 1 = 1 | end while",
        "repeat | until 1 = 2",
        "for k = 1 to 1E300 | next",
        "PROCEDURE p()\nlabel M | go to M\nend\ncall p()",
    ],
)
def test_every_loop_can_be_ended(script):
    host = RecordingHost()
    host.looks_allowed = 20
    with pytest.raises(Interrupted):
        host.run(script)
    host.looks_allowed = None
    host.execute("x = 1")
    assert host["x"] == 1


def test_long_scripts_without_loops_are_interrupted_too():
    host = RecordingHost()
    host.looks_allowed = 1
    with pytest.raises(Interrupted):
        host.run("\n".join(f"x = {k}" for k in range(5000)))


def test_tracing_announces_each_statement():
    host = run("x = 1\ntrace\nx = 2\ny = 3\ntrace\nz = 4")
    assert [c[1] for c in host.calls if c[0] == "before"] == ["Assign", "Assign", "Simple"]


def test_stopping_before_a_traced_statement():
    host = RecordingHost()
    interpreter = host.load("x = 1\nx = 2\nx = 3")
    interpreter.stepping = True
    allowed = [False]

    def before(placed):
        if not allowed[0]:
            interpreter.stop_here()
        allowed[0] = False

    host.before = before
    interpreter.run()
    assert host.values.find("x") is None
    for expected in (1, 2):
        allowed[0] = True
        interpreter.go()
        assert host["x"] == expected


def test_drun_and_rules_reach_the_host():
    host = run("irule 4\ndrun\ndrunr SECOND\ndrun *\nreset\nirule")
    assert host.calls == [
        ("drun", None, False),
        ("drun", "SECOND", False),
        ("reset",),
        ("drun", None, True),
        ("reset",),
    ]
    assert host.rule == 4
    assert host.text == "irule 4\n"


def test_names_a_run_defines_can_be_read_after_it():
    def drun(host, label):
        host.values.assign(host.values.scalar("fromrun").slot, 42.0)

    host = RecordingHost()
    host.on_drun = drun
    host.run("drun\nx = fromrun")
    assert host["x"] == 42


def test_an_error_leaves_what_was_done():
    host = RecordingHost()
    assert code_of(lambda: host.run("x = 1\ny = x/0\nx = 2")) == 5
    assert host["x"] == 1
    assert not host.values.is_defined(host.values.names["y"])
