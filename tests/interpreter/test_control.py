"""STOP and go, commands, tracing, interruption, clear."""

from __future__ import annotations

import pytest

from desire_tui.engine.diagnostics import DesireError
from tests.interpreter.stand_in import Interrupted, World, run


def code_of(action) -> int:
    with pytest.raises(DesireError) as caught:
        action()
    return caught.value.diagnostics[0].code


def test_stop_and_go():
    world = run("x = 1\nSTOP\nx = 2\nSTOP\nx = 3")
    assert world["x"] == 1
    assert world.interpreter.position.node.value.value == 2
    world.interpreter.go()
    assert world["x"] == 2
    world.execute("x = 10 | go")
    assert world["x"] == 3
    assert world.interpreter.position is None
    assert code_of(world.interpreter.go) == 43


def test_stop_inside_a_loop_in_a_procedure():
    world = run(
        "PROCEDURE p(n; s)\nfor k = 1 to n\ns = s + k\nif k = 2 then | STOP | proceed\nnext\nend\nt = 0\ncall p(4; t)\nu = t"
    )
    assert world["t"] == 3
    world.execute("t = 100")
    world.interpreter.go()
    assert world["u"] == 107


def test_stop_in_a_procedure_called_by_a_command():
    world = World()
    world.load("PROCEDURE p(;s)\ns = 1\nSTOP\ns = 2\nend")
    world.execute("call p(;x) | y = x")
    assert world["x"] == 1
    world.interpreter.go()
    assert (world["x"], world["y"]) == (2, 2)
    world.execute("z = 5")
    assert world["z"] == 5


def test_commands_loop_print_and_define():
    world = run("")
    world.execute("s = 0 | for k = 1 to 10 | s = s + k | next | write s")
    world.execute("s*2")
    world.execute("FUNCTION f(a) = a*a | f(5) + 1")
    world.execute("FUNCTION f(a) = a | f(5)")
    assert world.text == "55\n110\n26\n5\n"


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
    world = run("")
    assert code_of(lambda: world.execute(line)) == code


@pytest.mark.parametrize(
    ("script", "code"), [("erun", 199), ("go", 199), ("1 + 2", 1), ("store X = x", 300), ("d/dt x = 1", 300)]
)
def test_what_is_no_script_statement(script, code):
    assert code_of(lambda: run(script)) == code


def test_a_changed_function_is_seen_by_the_script():
    world = run("FUNCTION f(a) = a + 1\nlabel L\nx = f(1)\nSTOP\ngo to L")
    world.execute("FUNCTION f(a) = a + 10")
    world.interpreter.go()
    assert world["x"] == 11


def test_clear_in_the_middle_forgets_everything_but_goes_on():
    world = run(
        "x = 5\nlabel L\ny = 1\nif scale = 1 then | scale = 2 | go to L | proceed\nclear\nw = 3 | y = 2"
    )
    assert world.values.find("x") is None
    assert (world["w"], world["y"], world["scale"]) == (3, 2, 1)


def test_a_loop_survives_clear():
    world = run("for k = 1 to 3\nwrite k;\nclear\nnext")
    assert world.text == "123"


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
    world = World()
    world.looks_allowed = 20
    with pytest.raises(Interrupted):
        world.run(script)
    world.looks_allowed = None
    world.execute("x = 1")
    assert world["x"] == 1


def test_long_scripts_without_loops_are_interrupted_too():
    world = World()
    world.looks_allowed = 1
    with pytest.raises(Interrupted):
        world.run("\n".join(f"x = {k}" for k in range(5000)))


def test_tracing_announces_each_statement():
    world = run("x = 1\ntrace\nx = 2\ny = 3\ntrace\nz = 4")
    assert [c[1] for c in world.calls if c[0] == "before"] == ["Assign", "Assign", "Simple"]


def test_stopping_before_a_traced_statement():
    world = World()
    interpreter = world.load("x = 1\nx = 2\nx = 3")
    interpreter.stepping = True
    allowed = [False]

    def before(placed):
        if not allowed[0]:
            interpreter.stop_here()
        allowed[0] = False

    world.before = before
    interpreter.run()
    assert world.values.find("x") is None
    for expected in (1, 2):
        allowed[0] = True
        interpreter.go()
        assert world["x"] == expected


def test_drun_and_rules_reach_the_host():
    world = run("irule 4\ndrun\ndrunr SECOND\ndrun *\nreset\nirule")
    assert world.calls == [
        ("drun", None, False),
        ("drun", "SECOND", False),
        ("reset",),
        ("drun", None, True),
        ("reset",),
    ]
    assert world.rule == 4
    assert world.text == "irule 4\n"


def test_names_a_run_defines_can_be_read_after_it():
    def drun(world, label):
        world.values.assign(world.values.scalar("fromrun").slot, 42.0)

    world = World()
    world.on_drun = drun
    world.run("drun\nx = fromrun")
    assert world["x"] == 42


def test_an_error_leaves_what_was_done():
    world = World()
    assert code_of(lambda: world.run("x = 1\ny = x/0\nx = 2")) == 5
    assert world["x"] == 1
    assert not world.values.is_defined(world.values.names["y"])
