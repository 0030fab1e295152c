"""Native code that other processes find again; without a good file nothing is lost."""

from __future__ import annotations

import ctypes
import marshal
import os
import subprocess
import sys
import threading

import pytest

from desire_tui.engine import disk_cache
from desire_tui.engine.codegen.jit import compiler, stored_code
from desire_tui.engine.codegen.jit.compiler import compile_and_keep, compile_text, kept_code, machine
from desire_tui.engine.codegen.jit.linker import LinkedCode

TEXT = """
define i64 @seven(i64 %x) {
  %y = add i64 %x, 7
  ret i64 %y
}
"""


def seven(code):
    return ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64)(code.address("seven"))(35)


def test_code_is_found_again(folder):
    assert kept_code("test") is None
    assert seven(compile_and_keep(TEXT, "test", level=2, vectorize=False)) == 42
    (file,) = folder.iterdir()
    assert file.name.startswith("code-test-")
    found = kept_code("test")
    assert found is not None
    assert seven(found) == 42
    assert kept_code("other") is None


@pytest.mark.parametrize("damage", [b"", b"\0", b"\0" * 1000])
def test_a_damaged_file_is_not_looked_at(folder, damage):
    compile_and_keep(TEXT, "test", level=0, vectorize=False)
    (file,) = folder.iterdir()
    content = file.read_bytes()
    file.write_bytes(damage)
    assert kept_code("test") is None
    file.write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
    assert kept_code("test") is None


def test_whole_but_no_code(folder):
    compile_and_keep(TEXT, "test", level=0, vectorize=False)
    names = [p.name for p in folder.iterdir()]
    disk_cache.write(names[0], b"not an object file")
    assert kept_code("test") is None


def test_a_folder_that_cannot_be_written(monkeypatch):
    monkeypatch.setattr(disk_cache, "_path", lambda _: "/proc/nowhere/code.o")
    assert seven(compile_and_keep(TEXT, "test", level=0, vectorize=False)) == 42
    assert kept_code("test") is None


def test_what_was_compiled_is_found_by_its_text_and_how(folder, compiled):
    def made(text=TEXT, level=0, **how):
        return seven(compile_text(text, level=level, keep=True, **how))

    assert made() == made() == 42
    assert compiled == [0]
    assert made(level=2) == made(level=2, slp=True) == made(level=2, vectorize=True) == 42
    assert made(TEXT.replace("7", "8")) == 43
    assert compiled == [0, 2, 2, 2, 0]
    assert [made(level=2), made(level=2, slp=True), made(TEXT.replace("7", "8"))] == [42, 42, 43]
    assert len(compiled) == 5
    seven(compile_text(TEXT, level=0))  # for a session that shares nothing
    assert len(compiled) == 6


@pytest.mark.parametrize("field", ["triple", "cpu", "features", "library"])
def test_code_for_another_machine_is_not_taken(folder, compiled, monkeypatch, field):
    seven(compile_text(TEXT, level=0, keep=True))
    other = machine().host._replace(**{field: "another"})
    monkeypatch.setattr(machine(), "host", other)
    assert kept_code("test") is None
    seven(compile_text(TEXT, level=0, keep=True))
    assert compiled == [0, 0]
    assert len(list(folder.iterdir())) == 2


def test_another_file_under_this_name_is_not_taken(folder):
    compile_and_keep(TEXT, "test", level=0, vectorize=False)
    compile_and_keep(TEXT.replace("7", "8"), "other", level=0, vectorize=False)
    test, other = (next(folder.glob(f"code-{name}-*")) for name in ("test", "other"))
    other.replace(test)
    assert kept_code("test") is None


@pytest.mark.parametrize("form", [(), 3, ("{file}",), ("{file}", ()), ("{file}", (1, 2, 3)), ("{file}", 7)])
def test_whole_and_marked_but_of_another_form(folder, form):
    compile_and_keep(TEXT, "test", level=0, vectorize=False)
    (file,) = folder.iterdir()
    named = (
        tuple(file.name if part == "{file}" else part for part in form) if isinstance(form, tuple) else form
    )
    disk_cache.write(file.name, marshal.dumps(named))
    assert kept_code("test") is None


def test_where_llvm_links_its_object_files_are_kept(folder, compiled, monkeypatch):
    monkeypatch.setattr(compiler, "can_place", lambda: False)
    for _ in range(2):
        code = compile_text(TEXT, level=0, keep=True)
        assert isinstance(code, LinkedCode)
        assert seven(code) == 42
    assert compiled == [0]


def test_code_that_calls_what_this_process_lacks_is_not_taken(folder, monkeypatch):
    text = "declare i64 @outside()\ndefine i64 @f() {\n%y = call i64 @outside()\nret i64 %y\n}"
    own = ctypes.CFUNCTYPE(ctypes.c_int64)(lambda: 42)
    with monkeypatch.context() as there:
        known = machine()._symbols | {"outside": ctypes.cast(own, ctypes.c_void_p).value}
        there.setattr(machine(), "_symbols", known)
        code = compile_and_keep(text, "calls", level=0, vectorize=False)
        assert ctypes.CFUNCTYPE(ctypes.c_int64)(code.address("f"))() == 42
        assert kept_code("calls") is not None
    assert kept_code("calls") is None


def test_the_folder_keeps_what_was_used_lately(folder, monkeypatch):
    monkeypatch.setattr(disk_cache, "_NOTED_EVERY_SECONDS", 10.0)
    for number in range(6):
        compile_and_keep(TEXT, f"n{number}", level=0, vectorize=False)
        (file,) = folder.glob(f"code-n{number}-*")
        os.utime(file, (1000 + number, 1000 + number))
    (folder / "other").write_bytes(b"x" * 5000)
    assert kept_code("n1") is not None
    size = file.stat().st_size
    disk_cache.trim("code-", 3 * size + size // 2)
    kept = sorted(file.name.split("-")[1] for file in folder.glob("code-*"))
    assert kept == ["n1", "n4", "n5"]
    assert (folder / "other").exists()


def test_the_folder_is_bounded(folder, monkeypatch):
    monkeypatch.setattr(stored_code, "_BYTES_MOST", 20_000)
    what = (b"x" * 1000, ("f",))
    largest = 0
    for number in range(400):
        stored_code.keep(f"n{number}", machine().host, what)
        largest = max(
            largest, sum(file.stat().st_size for file in folder.iterdir()) if number % 10 == 0 else 0
        )
    assert largest < 20_000 + 200 * 1100
    assert len(list(folder.iterdir())) < 399


def test_several_at_once(folder):
    def work():
        texts = [TEXT.replace("7", str(number)) for number in range(8)]
        found.extend(seven(compile_text(text, level=0, keep=True)) for text in texts)

    found: list[int] = []
    threads = [threading.Thread(target=work) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(found) == sorted(3 * [35 + number for number in range(8)])
    assert all(file.name.startswith("code-") for file in folder.iterdir())


PROGRAM = """
TMAX = 2 | DT = 0.01 | NN = 101
x = 1 | y = 0.2
drun
DYNAMIC
d/dt x = y
d/dt y = -sin(x) - 0.1*y + cos(t)
z = exp(-x)*y
dispt x, y, z
"""


def test_a_second_process_compiles_nothing_and_loads_no_llvm(tmp_path):
    program = tmp_path / "p.src"
    program.write_text(PROGRAM)
    code = (
        "import sys\n"
        "from desire_tui.__main__ import main\n"
        "from desire_tui.engine.codegen.jit import compiler\n"
        "translate, count = compiler._object_file, [0]\n"
        "def counted(*a, **k): count[0] += 1; return translate(*a, **k)\n"
        "compiler._object_file = counted\n"
        f"try: main(['run', {str(program)!r}, '--csv', '-'])\n"
        "except SystemExit as end: assert not end.code\n"
        "late = 'llvmlite', '_hashlib', 'json', 'desire_tui.engine.data_files.data_file'\n"
        "print(count[0], *sorted(sys.modules.keys() & set(late)), file=sys.stderr)\n"
    )
    surroundings = os.environ | {"XDG_CACHE_HOME": str(tmp_path / "cache")}
    first, second = (
        subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=surroundings
        )
        for _ in range(2)
    )
    assert int(first.stderr.split()[0]) > 0
    assert "llvmlite" in first.stderr
    assert second.stderr.split() == ["0"]
    assert first.stdout == second.stdout
    assert first.stdout.count("\n") > 100
