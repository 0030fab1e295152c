"""Native code that other processes find again; without a good file nothing is lost."""

from __future__ import annotations

import ctypes

import pytest

from desire_tui.engine import disk_cache
from desire_tui.engine.codegen.jit.compiler import compile_and_keep, kept_code

TEXT = """
define i64 @seven(i64 %x) {
  %y = add i64 %x, 7
  ret i64 %y
}
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(disk_cache, "_path", lambda name: str(tmp_path / "cache" / name))
    return tmp_path / "cache"


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
