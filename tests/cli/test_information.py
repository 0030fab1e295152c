"""`desire help`, `desire examples`, `desire --version`: what comes along, in a shell."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from importlib import metadata

from desire_tui.common.paths import examples_folder
from tests.batch.command_line import ROOT, desire


def test_help_on_a_word_of_the_language_is_its_page():
    status, out, _ = desire("help", "dispt")
    assert status == 0
    assert out.startswith("# dispt\n")
    assert desire("help", "error", "200")[1] == desire("help", "200")[1]


def test_help_on_other_words_lists_what_a_search_finds():
    status, out, _ = desire("help", "delay", "line")
    assert status == 0
    assert "tdelay" in out
    status, out, err = desire("help", "xyzzyq\x1b[2J")
    assert (status, out) == (1, "")
    assert "no help on" in err
    assert "\x1b" not in err


def test_help_without_a_topic_names_all_pages():
    out = desire("help")[1]
    for word in ("drun", "DYNAMIC", "irule", "system variable", "TMAX", "sin"):
        assert word in out


def test_help_is_drawn_on_a_terminal():
    master, slave = pty.openpty()
    with subprocess.Popen(
        [sys.executable, "-m", "desire_tui", "help", "dispt"], stdout=slave, stdin=slave,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TERM": "xterm-256color"},
    ) as process:  # fmt: skip
        os.close(slave)
        shown = b""
        while True:
            try:
                piece = os.read(master, 4096)
            except OSError:  # Linux's end of a pseudo-terminal
                break
            if not piece:
                break
            shown += piece
    os.close(master)
    assert process.returncode == 0
    assert b"\x1b[" in shown
    assert b"# dispt" not in shown


def test_examples_are_listed_found_shown_and_copied(tmp_path):
    every = desire("examples")[1].splitlines()
    assert len(every) == len(list(examples_folder().glob("*/*.src")))
    status, out, _ = desire("examples", "lorenz")
    assert status == 0
    assert out.startswith("ch2/lorenz  ")
    assert desire("examples", "lorenz", "--show")[1] == (examples_folder() / "ch2/lorenz.src").read_text()
    assert desire("examples", "xyzzyq")[0] == 1
    status, out, err = desire("examples", "--copy", tmp_path / "mine")
    assert (status, err) == (0, "")
    assert len(list((tmp_path / "mine").glob("*/*.src"))) == len(every)


def test_copying_again_keeps_what_one_has_changed(tmp_path):
    desire("examples", "lorenz", "--copy", tmp_path)
    own = tmp_path / "ch2" / "lorenz.src"
    own.write_text("-- mine\n")
    status, out, err = desire("examples", "lorenz", "--copy", tmp_path)
    assert (status, out) == (0, f"0 programs copied to {tmp_path}\n")
    assert str(own) in err
    assert own.read_text() == "-- mine\n"


def test_version_names_what_it_stands_on():
    out = desire("--version")[1]
    assert out.splitlines()[0] == f"desire, version {metadata.version('desire-tui')}"
    for name in ("numpy", "textual", "llvmlite", "click"):
        assert f"{name} {metadata.version(name)}" in out
    assert sys.version.split()[0] in out
    assert "pytest" not in out
