"""Object files put into memory by our own linker: what LLVM's would have made of them, or left to LLVM."""

from __future__ import annotations

import ctypes
import struct
from pathlib import Path

import pytest

from desire_tui.engine.codegen.jit import compiler, placed_code
from desire_tui.engine.codegen.jit import object_file as object_file_module
from desire_tui.engine.codegen.jit.compiler import compile_text
from desire_tui.engine.codegen.jit.linker import LinkedCode
from desire_tui.engine.codegen.jit.object_file import UnknownFormError, image_of
from desire_tui.engine.codegen.jit.placed_code import NotPlacedError, PlacedCode

TEXT = """
@count = internal global i64 5
@zeros = internal global [600 x i64] zeroinitializer
@table = internal constant [2 x ptr] [ptr @add, ptr @multiply]
declare void @llvm.memmove.p0.p0.i64(ptr, ptr, i64, i1)
declare double @desire.pow.1(double, double)
define internal double @add(double %x) {
  %y = fadd double %x, 0.1
  ret double %y
}
define internal double @multiply(double %x) {
  %y = fmul double %x, 1.7
  ret double %y
}
define i64 @next() {
  %old = load i64, ptr @count
  %new = add i64 %old, 1
  store i64 %new, ptr @count
  %at = getelementptr i64, ptr @zeros, i64 %new
  %there = load i64, ptr %at
  %sum = add i64 %there, %new
  ret i64 %sum
}
define double @chosen(i64 %k, double %x) {
  %at = getelementptr ptr, ptr @table, i64 %k
  %f = load ptr, ptr %at
  %y = call double %f(double %x)
  %z = call double @desire.pow.1(double %y, double 0.3)
  ret double %z
}
define i64 @switched(i64 %k) {
  switch i64 %k, label %other [ i64 0, label %a  i64 1, label %b  i64 2, label %c  i64 3, label %d  i64 4, label %e ]
a:
  %n = call i64 @next()
  ret i64 %n
b:
  ret i64 91
c:
  %m = mul i64 %k, 17
  ret i64 %m
d:
  ret i64 -3
e:
  %o = call i64 @switched(i64 2)
  ret i64 %o
other:
  ret i64 0
}
define void @moved(ptr %to, ptr %from, i64 %size) {
  call void @llvm.memmove.p0.p0.i64(ptr %to, ptr %from, i64 %size, i1 false)
  ret void
}
"""
LEVELS = pytest.mark.parametrize("level", [0, 2])


def object_file(text=TEXT, level=0):
    return compiler._object_file(text, level, slp=False, vectorize=False)


def results(code):
    """Call everything in TEXT."""
    integer, real = ctypes.c_int64, ctypes.c_double
    chosen = ctypes.CFUNCTYPE(real, integer, real)(code.address("chosen"))
    switched = ctypes.CFUNCTYPE(integer, integer)(code.address("switched"))
    moved = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, integer)(code.address("moved"))
    memory = (real * 4)(1.5, 2.5, 3.5, 4.5)
    at = ctypes.addressof(memory)
    moved(at + 8, at, 24)
    return (
        [chosen(k, x).hex() for k in range(2) for x in (0.3, 7.0)],
        [switched(k) for k in (0, 0, 1, 2, 3, 4, 5)],
        list(memory),
    )


@LEVELS
def test_calls_tables_and_variables_are_as_llvm_links_them(monkeypatch, level):
    ours = compile_text(TEXT, level=level)
    assert isinstance(ours, PlacedCode)
    found = results(ours)
    monkeypatch.setattr(compiler, "can_place", lambda: False)
    theirs = compile_text(TEXT, level=level)
    assert isinstance(theirs, LinkedCode)
    assert found == results(theirs)
    assert found[1:] == ([6, 7, 91, 34, -3, 34, 0], [1.5, 1.5, 2.5, 3.5])


def test_each_copy_has_variables_of_its_own():
    copies = [compile_text(TEXT, level=0) for _ in range(2)]
    assert results(copies[0])[1][:2] == results(copies[1])[1][:2] == [6, 7]


def _mapped():
    """Address and mode of each piece of this process's memory."""
    lines = Path("/proc/self/maps").read_text().splitlines()
    return {int(line.split("-")[0], 16): line.split()[1] for line in lines}


def test_memory_is_never_both_writable_and_executable():
    code = compile_text(TEXT, level=0)
    start = code.address("next") & -4096
    mapped = _mapped()
    assert mapped[start].startswith("r-x")
    assert not any(
        "w" in mode and "x" in mode for at, mode in mapped.items() if start <= at < start + code.size
    )


def test_memory_is_given_back():
    code = compile_text(TEXT, level=0)
    start = code.address("next") & -4096
    assert start in _mapped()
    del code
    assert not _mapped().get(start, "").startswith("r-x")


@pytest.mark.parametrize("length", [0, 30, 64, 200, 900])
def test_what_is_cut_off_is_left_to_llvm(length):
    with pytest.raises(UnknownFormError):
        image_of(object_file()[:length])


def test_other_machines_and_relocations_are_left_to_llvm():
    content = bytearray(object_file())
    content[18] = 183  # the machine: AArch64
    with pytest.raises(UnknownFormError):
        image_of(bytes(content))
    content = object_file()
    absolute = struct.pack("<I", 1)
    start = next(at for at in range(0, len(content) - 24, 8) if _is_relocation(content, at))
    assert content[start + 8 : start + 12] == absolute
    with pytest.raises(UnknownFormError):
        image_of(content[: start + 8] + struct.pack("<I", 10) + content[start + 12 :])


def _is_relocation(content, at):
    offset, kind, symbol, _ = struct.unpack_from("<QIIq", content, at)
    return 0 < offset < 2000 and kind == 1 and 0 < symbol < 40


def test_a_form_that_is_not_known_is_linked_by_llvm(monkeypatch):
    def unknown(content):
        raise UnknownFormError

    monkeypatch.setattr(object_file_module, "image_of", unknown)
    code = compile_text(TEXT, level=0)
    assert isinstance(code, LinkedCode)
    assert results(code)[1][2:4] == [91, 34]


def test_a_function_that_the_process_does_not_have():
    text = "declare void @desire.nowhere()\ndefine void @f() {\ncall void @desire.nowhere()\nret void\n}"
    with pytest.raises(KeyError):
        compile_text(text, level=0)


def test_a_system_that_makes_no_memory_executable(monkeypatch):
    class Refusing:
        def __getattr__(self, name):
            return getattr(system, name) if name != "mprotect" else lambda *_: -1

    system = placed_code._system()
    image = image_of(object_file())
    monkeypatch.setattr(placed_code, "_system", Refusing)
    assert not placed_code.can_place.__wrapped__()
    with pytest.raises(NotPlacedError):
        PlacedCode(image, compiler.machine().address_of)
