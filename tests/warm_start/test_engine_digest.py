"""The engine's name changes with each of its files that decides what is stored."""

from __future__ import annotations

from pathlib import Path
from time import time_ns

import pytest

from desire_tui.engine.warm_start import engine_digest

digest = engine_digest.engine_digest.__wrapped__


@pytest.fixture
def engine(tmp_path, monkeypatch):
    """A small engine, which this process has just imported."""
    for room in ("", *engine_digest._ROOMS):
        (tmp_path / room / "inner").mkdir(parents=True)
        for name in ("a.py", "b.py", "inner/c.py", "desire.lark", "notes.txt"):
            (tmp_path / room / name).write_text("x = 1")
    monkeypatch.setattr(engine_digest.engine, "__file__", str(tmp_path / "__init__.py"))
    monkeypatch.setattr(engine_digest.engine, "IMPORTED_AT", time_ns() + 10**9)
    return tmp_path


@pytest.mark.parametrize(
    "name", ["values.py", "syntax/desire.lark", "codegen/inner/c.py", "lowering/new.py", "passes/a.py"]
)
def test_of_other_files(engine, name):
    before = digest()
    assert digest() == before
    (engine / name).write_text("y = 1")
    assert digest() not in (before, None)


def test_of_what_does_not_matter(engine):
    before = digest()
    (engine / "syntax/notes.txt").write_text("longer than it was")
    (engine / "syntax/__pycache__").mkdir()
    (engine / "syntax/__pycache__/a.py").write_text("longer than it was")
    assert digest() == before


def test_of_another_python(engine, monkeypatch):
    before = digest()
    monkeypatch.setattr(engine_digest.sys, "version", "another")
    assert digest() not in (before, None)


def test_of_files_that_changed_since_they_may_have_been_imported(engine, monkeypatch):
    monkeypatch.setattr(engine_digest.engine, "IMPORTED_AT", time_ns() - 10**11)
    assert digest() is None


def test_this_engine_is_known_by_all_its_rooms():
    rooms = {path.name for path in Path(engine_digest.engine.__file__).parent.iterdir() if path.is_dir()}
    assert rooms.issuperset(engine_digest._ROOMS)
