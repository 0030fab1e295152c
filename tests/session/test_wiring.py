"""A session's parts are complete when they are made, and know each other in one direction only."""

from __future__ import annotations

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import desire_tui
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

ENGINE = Path(desire_tui.__file__).parent / "engine"
PROGRAM = """TMAX = 1 | DT = 0.1 | NN = 11 | x = 1
for i = 1 to 2
  drunr
next
STOP
write x
DYNAMIC
d/dt x = -x
type x
"""


def _imports(path):
    """Everything a module imports: at its top, in functions, for types only."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


@pytest.mark.parametrize("room", ["session", "runtime", "graph", "integration"])
def test_no_module_imports_itself_in_a_circle(room):
    paths = {
        "desire_tui.engine." + ".".join(path.relative_to(ENGINE).with_suffix("").parts): path
        for path in (ENGINE / room).rglob("*.py")
    }
    graph = {name: paths.keys() & set(_imports(path)) - {name} for name, path in paths.items()}
    assert any(graph.values())
    TopologicalSorter(graph).prepare()  # raises CycleError


def _parts(session):
    """The session's objects, and what each of them holds that can be called or is such an object itself."""
    seen, waiting = {}, [session]
    while waiting:
        part = waiting.pop()
        if id(part) in seen or not type(part).__module__.startswith("desire_tui.engine.session"):
            continue
        held = getattr(part, "__dict__", {})
        seen[id(part)] = {
            (type(part).__name__, name): value
            for name, value in held.items()
            if callable(value) or type(value).__module__.startswith("desire_tui.engine.session.")
        }
        waiting += held.values()
    return {key: value for part in seen.values() for key, value in part.items()}


STATE = {("Activity", "state"), ("Runs", "start"), ("ScriptRunner", "stopped")}
"""What changes as a session works; everything else is wiring."""


def test_nothing_is_wired_after_construction():
    session = Session(Listener(), backend="reference")
    before = _parts(session)
    assert ("ScriptHost", "_commands") in before
    session.erun(Source(PROGRAM, "test.src"))
    session.go()
    after = _parts(session)
    changed = {key for key in before.keys() | after.keys() if before.get(key) is not after.get(key)}
    assert changed <= STATE
