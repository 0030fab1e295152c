"""A file is replaced whole or not at all."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from desire_tui.engine import file_in_place
from desire_tui.engine.atomic_file import replacing
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.files import write_bytes, write_file


def replace_text(path, text):
    with replacing(path) as file:
        file.write(text)


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("old", [None, "old"])
@pytest.mark.parametrize(
    "failure", [OSError(28, "No space left on device"), ValueError(), KeyboardInterrupt()]
)
def test_a_write_that_fails_half_way_changes_nothing(tmp_path, old, failure):
    path = tmp_path / "out.txt"
    if old is not None:
        path.write_text(old)
    before = names(tmp_path)

    def fail():
        with replacing(path) as file:
            file.write("new" * 100_000)
            file.flush()
            raise failure

    with pytest.raises(type(failure)):
        fail()
    assert names(tmp_path) == before
    assert old is None or path.read_text() == old


@pytest.mark.parametrize(("write", "content"), [(write_file, "new"), (write_bytes, b"new")])
def test_a_failure_is_error_106_and_the_old_file_stays(tmp_path, write, content):
    path = tmp_path / "out.npz"
    path.write_bytes(b"old")

    def fill_the_disk(file):
        file.write(content)
        raise OSError(28, "No space left on device")

    with pytest.raises(DesireError) as caught:
        write(path, fill_the_disk)
    (problem,) = caught.value.diagnostics
    assert problem.code == 106
    assert "No space left on device" in problem.message
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["out.npz"]


def test_readers_see_the_old_file_until_the_new_one_is_whole(tmp_path):
    path = tmp_path / "out.txt"
    path.write_text("old")
    with replacing(path) as file:
        file.write("new\n")
        file.flush()
        assert path.read_text() == "old"
    assert path.read_text() == "new\n"
    assert names(tmp_path) == ["out.txt"]


def test_line_ends_and_letters_stay_as_written(tmp_path):
    path = tmp_path / "out.txt"
    replace_text(path, "a\r\nb\nπ")
    assert path.read_bytes() == "a\r\nb\nπ".encode()


def test_permissions_are_kept_and_new_files_get_the_usual_ones(tmp_path):
    path, fresh = tmp_path / "out.txt", tmp_path / "fresh.txt"
    path.write_text("old")
    path.chmod(0o750)
    before = os.umask(0o027)
    try:
        replace_text(path, "new")
        replace_text(fresh, "new")
    finally:
        os.umask(before)
    assert path.stat().st_mode & 0o7777 == 0o750
    assert fresh.stat().st_mode & 0o7777 == 0o640


def test_links_are_followed(tmp_path):
    folder, link, broken = tmp_path / "folder", tmp_path / "link", tmp_path / "broken"
    folder.mkdir()
    target = folder / "out.txt"
    target.write_text("old")
    link.symlink_to(target)
    broken.symlink_to("folder/fresh.txt")
    for path, read in ((link, target), (broken, folder / "fresh.txt")):
        replace_text(path, "new")
        assert path.is_symlink()
        assert read.read_text() == "new"
    assert names(folder) == ["fresh.txt", "out.txt"]


def test_a_write_protected_file_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "out.txt"
    path.write_text("old")
    path.chmod(0o444)
    monkeypatch.setattr(os, "access", lambda *_: False)  # the administrator may write everywhere
    with pytest.raises(PermissionError), replacing(path) as file:
        file.write("new")
    assert path.read_text() == "old"


def test_folders_are_made_only_where_that_is_asked_for(tmp_path):
    with pytest.raises(FileNotFoundError), replacing(tmp_path / "a" / "out.txt"):
        pass
    with replacing(tmp_path / "a" / "b" / "out.txt", make_folder=True) as file:
        file.write("new")
    assert (tmp_path / "a" / "b" / "out.txt").read_text() == "new"


def test_the_longest_names_a_disk_takes(tmp_path):
    path = tmp_path / ("n" * 251 + ".txt")
    replace_text(path, "new")
    assert path.read_text() == "new"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_is_written_and_stays_a_pipe(tmp_path):
    pipe, read = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: read.append(pipe.read_text()), daemon=True)
    reader.start()
    replace_text(pipe, "new")
    reader.join(120)
    assert read == ["new"]
    assert pipe.is_fifo()


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="needs /proc")
def test_a_file_that_is_open_already_is_written_itself(tmp_path):
    path = tmp_path / "out.txt"
    with path.open("w+") as file:
        replace_text(f"/proc/self/fd/{file.fileno()}", "new")
        assert file.read() == "new"


# ------------------------------------------------------------------------------------------ written in place


@pytest.fixture
def linked(tmp_path):
    """Make a file with two names."""
    path = tmp_path / "out.txt"
    path.write_text("the old content, longer than the new")
    path.chmod(0o640)
    os.link(path, tmp_path / "other.txt")
    return path


@pytest.mark.parametrize("text", ["new", "new" * 100_000, ""])
def test_all_names_of_a_file_show_the_new_content(linked, tmp_path, text):
    before = linked.stat()
    replace_text(linked, text)
    assert linked.read_text() == (tmp_path / "other.txt").read_text() == text
    assert linked.stat().st_ino == before.st_ino
    assert linked.stat().st_mode == before.st_mode
    assert names(tmp_path) == ["other.txt", "out.txt"]


@pytest.mark.parametrize("times", [1, 2])
def test_a_disk_that_fills_up_in_place_leaves_the_old_content(linked, tmp_path, monkeypatch, times):
    old, pour, calls = linked.read_text(), file_in_place._pass_on, []

    def pass_on(source, to):
        calls.append(to)
        if len(calls) == times:
            to.write(b"half")
            to.flush()
            raise OSError(28, "No space left on device")
        pour(source, to)

    monkeypatch.setattr(file_in_place, "_pass_on", pass_on)
    with pytest.raises(OSError, match="No space left"):
        replace_text(linked, "new" * 100_000)
    assert linked.read_text() == old
    assert names(tmp_path) == ["other.txt", "out.txt"]


def test_where_nothing_can_be_put_back_the_error_names_the_copy(linked, tmp_path, monkeypatch):
    old = linked.read_text()

    def fails(source, path):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(file_in_place, "_pour", fails)
    with pytest.raises(OSError, match="what it held is kept in") as caught:
        replace_text(linked, "new")
    (kept,) = (name for name in names(tmp_path) if name.endswith(".old"))
    assert str(tmp_path / kept) in caught.value.strerror
    assert (tmp_path / kept).read_text() == old
    assert (tmp_path / kept).stat().st_mode & 0o777 == 0o600


def test_a_kill_while_written_in_place_leaves_the_old_content_beside_it(linked, tmp_path):
    old = linked.read_text()
    killed = f"""
import os, signal
from desire_tui.engine import file_in_place
from desire_tui.engine.atomic_file import replacing
file_in_place._pour = lambda *_: os.kill(os.getpid(), signal.SIGKILL)
with replacing({str(linked)!r}) as file:
    file.write("new")
"""
    done = subprocess.run([sys.executable, "-c", killed], check=False)
    assert done.returncode == -9
    (kept,) = (name for name in names(tmp_path) if name.startswith("out.txt."))
    assert (tmp_path / kept).read_text() == old


def test_a_folder_that_takes_no_new_files_does_not_keep_a_file_from_being_written(tmp_path, monkeypatch):
    path = tmp_path / "folder" / "out.txt"
    path.parent.mkdir()
    path.write_text("old")
    node = path.stat().st_ino
    monkeypatch.setattr(os, "access", lambda name, _: name != str(path.parent))
    monkeypatch.setattr("tempfile.gettempdir", lambda: str(tmp_path))
    replace_text(path, "new")
    assert path.read_text() == "new"
    assert path.stat().st_ino == node
    assert names(tmp_path) == ["folder"]
    assert names(path.parent) == ["out.txt"]


def test_attributes_are_kept_also_where_a_new_file_cannot_have_them(tmp_path, monkeypatch):
    path = tmp_path / "out.txt"
    path.write_text("old")
    try:
        os.setxattr(path, "user.author", b"Ada")
    except OSError:
        pytest.skip("this file system has no attributes")
    replace_text(path, "new")
    assert os.getxattr(path, "user.author") == b"Ada"
    node = path.stat().st_ino

    def refused(*_):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "setxattr", refused)
    replace_text(path, "newer")
    assert path.stat().st_ino == node
    assert os.getxattr(path, "user.author") == b"Ada"
    assert path.read_text() == "newer"


@pytest.mark.skipif(os.getuid() != 0, reason="only the administrator gives files away")
def test_the_owner_is_kept_also_where_a_new_file_cannot_have_him(tmp_path, monkeypatch):
    path = tmp_path / "out.txt"
    path.write_text("old")
    os.chown(path, 1234, 1234)
    replace_text(path, "new")
    assert (path.stat().st_uid, path.stat().st_gid) == (1234, 1234)

    def refused(*_):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "chown", refused)
    replace_text(path, "newer")
    assert (path.stat().st_uid, path.read_text()) == (1234, "newer")
