"""`desire fmt`: files in place, folders, standard input, what would change."""

from __future__ import annotations

import os

import pytest
from click.testing import CliRunner

from desire_tui.cli import main

BEFORE, AFTER = "x=1|y =2\n", "x = 1 | y = 2\n"


def fmt(*words, given=None):
    return CliRunner().invoke(main, ["fmt", *map(str, words)], input=given)


def test_a_file_is_rewritten_once(tmp_path):
    path = tmp_path / "a.src"
    path.write_text(BEFORE)
    done = fmt(path)
    assert (done.exit_code, done.stderr, path.read_text()) == (0, f"{path}: laid out\n", AFTER)
    before = path.stat().st_mtime_ns
    assert (fmt(path).stderr, path.stat().st_mtime_ns) == ("", before)


def test_check_names_what_would_change_and_changes_nothing(tmp_path):
    for name, text in (("b.src", BEFORE), ("a.src", AFTER), ("c.txt", BEFORE)):
        (tmp_path / name).write_text(text)
    told = fmt(tmp_path, "--check")
    assert (told.exit_code, told.stderr) == (1, f"{tmp_path / 'b.src'}: would change\n")
    assert (tmp_path / "b.src").read_text() == BEFORE
    assert fmt(tmp_path / "a.src", "--check").exit_code == 0


def test_diff_prints_the_rows(tmp_path):
    path = tmp_path / "a.src"
    path.write_text("y = 1\nx=1")
    told = fmt(path, "--diff")
    assert (told.exit_code, told.stdout) == (1, (
        f"--- {path}\n+++ {path}\n@@ -1,2 +1,2 @@\n y = 1\n-x=1\n\\ No newline at end of file\n+x = 1\n"
    ))  # fmt: skip
    assert path.read_text() == "y = 1\nx=1"


def test_standard_input_goes_to_standard_output():
    assert fmt("-", given=BEFORE).stdout == AFTER


@pytest.mark.parametrize("codec", ["latin-1", "utf-16"])
def test_a_file_keeps_its_encoding_and_row_ends(tmp_path, codec):
    path = tmp_path / "a.src"
    path.write_bytes("x=1 -- café\r\n".encode(codec))
    assert fmt(path).exit_code == 0
    assert path.read_bytes() == "x = 1 -- café\r\n".encode(codec)


def test_what_cannot_be_read_or_written_is_told_and_the_rest_is_done(tmp_path):
    path = tmp_path / "a.src"
    path.write_text(BEFORE)
    told = fmt(tmp_path / "none.src", path)
    assert told.exit_code == 1
    assert "error 38" in told.stderr
    assert path.read_text() == AFTER
    if os.geteuid():  # nothing is refused to root
        path.write_text(BEFORE)
        tmp_path.chmod(0o500)
        told = fmt(path)
        tmp_path.chmod(0o700)
        assert (told.exit_code, "error 106" in told.stderr) == (1, True)
