"""Texts with addresses of this process: compiled once, placed with the addresses of the day."""

from __future__ import annotations

import ctypes

import pytest

from desire_tui.engine.codegen.compiler_state import CompilerState
from desire_tui.engine.codegen.jit import compiler
from desire_tui.engine.codegen.jit.compiler import compile_text
from desire_tui.engine.codegen.jit.linker import LinkedCode
from desire_tui.engine.codegen.jit.movable_text import has_addresses, movable_text
from desire_tui.engine.codegen.jit.placed_code import PlacedCode
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

CALLBACK = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)


pytestmark = pytest.mark.usefixtures("folder")


def text_for(name, memory, callback):
    """A function that adds what the callback makes of memory[2] to memory[0], and one that calls it."""
    return f"""
define double @{name}() {{
  %p = inttoptr i64 {ctypes.addressof(memory)} to ptr
  %at = getelementptr double, ptr %p, i64 2
  %x = load double, ptr %at
  %y = call double inttoptr (i64 {callback} to ptr)(double %x)
  %old = load double, ptr %p
  %new = fadd double %old, %y
  store double %new, ptr %p
  ret double %new
}}
define double @{name}.twice() {{
  %a = call double @{name}()
  %b = call double @{name}()
  ret double %b
}}"""


@pytest.mark.parametrize("level", [0, 2])
@pytest.mark.parametrize("who", [PlacedCode, LinkedCode])
def test_addresses_are_those_of_whoever_asks(compiled, monkeypatch, level, who):
    if who is LinkedCode:
        monkeypatch.setattr(compiler, "can_place", lambda: False)
    kept = []
    for number in range(3):
        memory = (ctypes.c_double * 3)(0.5, 0.0, number)
        callback = CALLBACK(lambda x, factor=number + 1: factor * x)
        name = f"f{number}"
        code = compile_text(
            text_for(name, memory, ctypes.cast(callback, ctypes.c_void_p).value), level=level, keep=True
        )
        assert isinstance(code, who)
        kept.append((code, memory, callback))
        found = ctypes.CFUNCTYPE(ctypes.c_double)(code.address(f"{name}.twice"))()
        assert found == memory[0] == 0.5 + 2 * (number + 1) * number
        assert ctypes.CFUNCTYPE(ctypes.c_double)(code.address(name))() == 0.5 + 3 * (number + 1) * number
    assert [memory[0] for _, memory, _ in kept] == [0.5, 6.5, 18.5]
    assert compiled == ([level] if who is PlacedCode else 3 * [level])


def test_addresses_that_are_the_same_stay_so():
    one = movable_text(_two(1000, 1000), ["f"])
    assert one.text == movable_text(_two(2000, 2000), ["f"]).text
    assert one.text != movable_text(_two(1000, 2000), ["f"]).text
    assert one.addresses == {"address.0": 1000}
    assert not has_addresses(one.text)


def _two(first, second):
    return f"define ptr @f() {{\n%a = inttoptr i64 {first} to ptr\n%b = inttoptr i64 {second} to ptr\nret ptr %b\n}}"


def test_names_are_replaced_whole():
    text = "define void @f() {\ncall void @f.a()\ncall void @ff()\ncall void @f()\n}"
    moved = movable_text(text, ["f", "f.a"])
    assert moved.text.count("@function.0(") == 2
    assert moved.text.count("@function.1(") == 1
    assert "@ff(" in moved.text
    assert moved.names == {"f": "function.0", "f.a": "function.1"}


@pytest.mark.parametrize("rule", [4, 9, 14, 17])
def test_another_session_compiles_no_quick_code(compiled, rule):
    text = (
        f"irule {rule} | ERMAX = 1.0E-06 | TMAX = 1 | DT = 0.01 | NN = 11\nx = 1 | y = 0.3\ndrun\n"
        "DYNAMIC\nd/dt x = swtch(y)*x - y\nd/dt y = -30*(y - cos(x)) + abs(x)\ndispt x, y\n"
    )
    found, quick = [], []
    for _ in range(2):
        state = CompilerState(keep=True)
        session = Session(compiler=state)
        session.erun(Source(text))
        run = session.runs[-1]
        found.append(run.rows[: run.count].tobytes())
        state.close()
        quick.append(compiled.count(0))
        compiled.clear()
    assert quick[0] > 0
    assert quick[1] == 0
    assert found[0] == found[1]
