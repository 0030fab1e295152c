"""Small programs treated as large ones, and a folder of their own for what is stored."""

from __future__ import annotations

import pytest

from desire_tui.engine import disk_cache
from desire_tui.engine.codegen import native_model
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.session import workspace
from desire_tui.engine.warm_start import start_file


@pytest.fixture
def stored(tmp_path, monkeypatch):
    """Store the starts of all programs; the folder where that is done."""
    monkeypatch.setattr(workspace, "STORED_LEAST", 0)
    monkeypatch.setattr(native_model, "SMALL", -1)
    monkeypatch.setattr(start_file, "engine_digest", lambda: b"this one")  # who edits it stores nothing
    folder, usual = tmp_path / "cache", disk_cache._path
    monkeypatch.setattr(
        disk_cache, "_path", lambda name: str(folder / name) if name.startswith("start-") else usual(name)
    )
    return folder


@pytest.fixture
def code(stored, monkeypatch):
    """Store the code there too."""
    machine()
    monkeypatch.setattr(disk_cache, "_path", lambda name: str(stored / name))
    return stored
