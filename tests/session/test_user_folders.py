"""Files kept between sessions are private; a cache that others can write is not believed."""

from __future__ import annotations

from stat import S_IMODE

import pytest

from desire_tui.editor import recovery
from desire_tui.editor.recovery import SavedTab
from desire_tui.engine import disk_cache
from desire_tui.panes.command_history import CommandHistory


@pytest.fixture
def places(tmp_path, monkeypatch):
    """State and cache folder of this test, as an old version made them: open to all who pass."""
    (tmp_path / "mine").mkdir(mode=0o700)
    for kind in ("STATE", "CACHE"):
        monkeypatch.setenv(f"XDG_{kind}_HOME", str(tmp_path / "mine" / kind))
        (tmp_path / "mine" / kind / "desire-tui").mkdir(parents=True, mode=0o755)
    return tmp_path / "mine"


def mode_of(path):
    return S_IMODE(path.stat().st_mode)


def test_recovery_history_and_cache_are_private(places):
    state, cache = places / "STATE" / "desire-tui", places / "CACHE" / "desire-tui"
    old = state / "history.json"
    old.write_text("[]")
    old.chmod(0o644)
    assert recovery.store(recovery.recovery_file(), [SavedTab(None, "a", "text")])
    CommandHistory(old).add("write 1")
    disk_cache.write("thing", b"content")
    assert disk_cache.read("thing") == b"content"
    for folder in (state, cache):
        assert mode_of(folder) == 0o700
        files = list(folder.iterdir())
        assert files
        assert {mode_of(file) for file in files} == {0o600}


def test_a_relative_cache_path_does_not_count(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    for kind in ("STATE", "CACHE", "CONFIG"):
        monkeypatch.setenv(f"XDG_{kind}_HOME", "here")
    disk_cache.write("thing", b"content")
    recovery.store(recovery.recovery_file(), [SavedTab(None, "a", "text")])
    assert not (tmp_path / "here").exists()
    from desire_tui.common import config

    _, wrong = config.load()
    assert len(wrong) == 3
    assert "XDG_CACHE_HOME=here" in wrong[0]


def test_code_is_loaded_only_from_a_folder_that_nobody_else_can_write(places):
    from desire_tui.engine.codegen.jit import compiler

    text = "define double @one() { ret double 1.0 }"
    compiler.compile_and_keep(text, "one", level=0, vectorize=False)
    assert compiler.kept_code("one") is not None
    folder = places / "CACHE" / "desire-tui"
    for writable in (folder, folder.parent, places):
        before = mode_of(writable)
        writable.chmod(0o777)
        assert compiler.kept_code("one") is None
        writable.chmod(before)
    assert compiler.kept_code("one") is not None
