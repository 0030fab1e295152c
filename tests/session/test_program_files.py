"""What a program may open without being asked for: data in its own folder, no links out, ordinary files only."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import numpy as np
import pytest

import desire_tui
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.program_files import open_for_program
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

WRITE = "connect '{}' as output 2\nwrite #2, 1\ndisconnect 2\n"
READ = "connect '{}' as input 2\ninput #2, a\ndisconnect 2\n"
STASH = "TMAX = 1 | NN = 3 | DT = 0.5\ndrun\nDYNAMIC\nd/dt x = 1\nstash x\n"


class User(Listener):
    """Answers all questions alike."""

    def __init__(self, answer):
        self._answer = answer
        self.asked: list[str] = []

    def permit(self, request):
        self.asked.append(request.sentence)
        return self._answer


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    """Home folder and state folder of this test."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / ".state"))
    (tmp_path / "models").mkdir()
    return tmp_path


@pytest.fixture
def folder(home):
    """A program's folder."""
    return home / "models"


def run(folder, text, *, answer=False, name="p.src"):
    """Run a program and return the questions and the numbers of the errors."""
    user = User(answer)
    session = Session(user, backend="reference", folder=folder)
    outcome: list[int] = []

    def work():
        try:
            session.erun(Source(text, name, folder / name))
        except DesireError as error:
            outcome.extend(d.code for d in error.diagnostics)

    thread = threading.Thread(target=work, daemon=True)  # a file that holds the engine fails, and no more
    thread.start()
    thread.join(120)  # on a machine with much to do the first picture takes 10 s
    assert not thread.is_alive(), "the program waits for a file for ever"
    return user.asked, outcome


@pytest.mark.parametrize(
    "name", ["out", "out.DAT", "t.csv", "notes.txt", "a.npy", "picture.svg", "journal.md"]
)
def test_new_data_and_texts_are_free(folder, name):
    for _ in range(2):  # and may be written again
        assert run(folder, WRITE.format(name)) == ([], [])


@pytest.mark.parametrize("name", ["old.dat", "old.csv"])
def test_data_of_others_may_be_written_over(folder, name):
    (folder / name).write_text("7\n")
    assert run(folder, WRITE.format(name)) == ([], [])


@pytest.mark.parametrize(
    "name",
    [".bashrc.x", ".x.dat", ".git/hooks.dat", "sub/.y/z.dat", "run.sh", "a.py", "Make.file", "x.dat.tex"],
)
def test_hidden_files_and_other_endings_are_asked_for(folder, name):
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    asked, codes = run(folder, WRITE.format(name))
    assert len(asked) == 1
    assert codes == [451]
    assert not path.exists()
    assert run(folder, WRITE.format(name), answer=True)[1] == []
    assert path.read_text().strip() == "1"
    assert len(run(folder, WRITE.format(name))[0]) == 1, "another day it is asked for again"


@pytest.mark.parametrize("channel", [0, 2])
def test_files_of_others_are_asked_for(folder, channel):
    (folder / "thesis.txt").write_text("years of work\n")
    text = WRITE.format("thesis.txt").replace("2", str(channel))
    asked, codes = run(folder, text)
    assert (len(asked), codes) == (1, [451])
    assert (folder / "thesis.txt").read_text() == "years of work\n"
    assert run(folder, text, answer=True)[1] == []
    assert run(folder, text) == ([], []), "once allowed, it is the program's own"
    assert run(folder, text, name="another.src")[1] == [451]


@pytest.mark.parametrize("text", ["notebook '{}'\n", "display A | plot 0, 0\nsnapshot '{}'\n"])
def test_notebooks_and_pictures_too(folder, text):
    (folder / "mine.png").write_bytes(b"picture")
    assert run(folder, text.format("mine.png"))[1] == [451]
    assert run(folder, text.format(".profile.png"))[1] == [451]
    assert (folder / "mine.png").read_bytes() == b"picture"
    for _ in range(2):
        assert run(folder, text.format("own.png")) == ([], [])


def test_everything_is_asked_for_in_the_home_folder(home):
    (home / "data.dat").write_text("1\n")
    assert run(home, READ.format("data"))[1] == [451]
    assert run(home, READ.format(".ssh/id"))[1] == [451]
    assert run(home, WRITE.format("data"))[1] == [451]
    assert run(home, STASH)[1] == [451]
    assert run(home, WRITE.format("data"), answer=True)[1] == []
    assert run(home, WRITE.format("data")) == ([], []), "its own data again"
    assert run(home.parent, WRITE.format("data"))[1] == [451], "a folder above is no better"


def test_hidden_files_are_asked_for_to_be_read(folder):
    (folder / ".secret.dat").write_text("1\n")
    assert run(folder, READ.format(".secret"))[1] == [451]
    (folder / "plain.tex").write_text("1\n")
    assert run(folder, READ.format("plain.tex")) == ([], [])


@pytest.mark.parametrize("text", [WRITE.format("link"), READ.format("link"), "notebook 'link.dat'\n"])
def test_links_out_are_asked_for(home, folder, text):
    (home / "victim").write_text("1\n")
    (folder / "link.dat").symlink_to(home / "victim")
    asked, codes = run(folder, text)
    assert codes == [451]
    assert str(home / "victim") in asked[0]
    assert (home / "victim").read_text() == "1\n"


def test_a_stash_behind_a_link_is_asked_for(home, folder):
    np.save(home / "victim.npy", np.ones((3, 1)))
    before = (home / "victim.npy").read_bytes()
    (folder / "p.stash.npy").symlink_to(home / "victim.npy")
    assert run(folder, STASH)[1] == [451]
    assert (home / "victim.npy").read_bytes() == before
    assert run(folder, STASH.replace("stash", "recover"))[1] == [451]


def test_pictures_of_a_notebook_follow_no_link(home, folder):
    (folder / "n-1.png").symlink_to(home / "victim.png")
    run(folder, "notebook 'n.md'\n" + STASH.replace("stash", "dispt"))
    assert not (home / "victim.png").exists()
    assert (folder / "n-2.png").exists()


@pytest.mark.parametrize(
    "text",
    [
        WRITE,
        READ,
        "notebook '{}.dat'\n",
        "display A | plot 0, 0\nsnapshot '{}.png'\n",
        WRITE.replace("2", "1"),
    ],
)
def test_a_pipe_holds_nobody_up(folder, text):
    os.mkfifo(folder / "pipe.dat")
    os.mkfifo(folder / "pipe.png")
    asked, codes = run(folder, text.format("pipe"), answer=True)
    assert codes == [451]
    assert asked == []


def test_stash_pipes_devices_and_circles(folder):
    os.mkfifo(folder / "p.stash.npy")
    assert run(folder, STASH, answer=True)[1] == [451]
    assert run(folder, STASH.replace("stash", "recover"), answer=True)[1] == [451]
    (folder / "zero.dat").symlink_to("/dev/zero")
    assert run(folder, READ.format("zero"), answer=True)[1] == [451]
    (folder / "round.dat").symlink_to("round.dat")
    assert run(folder, WRITE.format("round"), answer=True)[1] == [451]


def test_what_one_program_was_allowed_another_is_not(home, folder):
    user = User(answer=True)
    session = Session(user, backend="reference")
    for name in ("one.src", "two.src"):
        session.erun(Source(WRITE.format("../o.txt"), name, folder / name))
    assert len(user.asked) == 2


def test_a_folder_that_becomes_a_link_between_two_steps_is_not_entered(tmp_path, monkeypatch):
    """The check by names alone could be passed by a link that was swapped in for a moment."""
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    inside.mkdir()
    outside.mkdir()
    (inside / "data.dat").write_text("mine")
    (outside / "data.dat").write_text("secret")
    path, aside = inside / "data.dat", tmp_path / "aside"
    real_open = os.open

    def swapping(name, *args, **options):
        if str(name) in (str(path), "inside"):
            inside.rename(aside)
            inside.symlink_to(outside)
            try:
                return real_open(name, *args, **options)
            finally:
                inside.unlink()
                aside.rename(inside)
        return real_open(name, *args, **options)

    monkeypatch.setattr(os, "open", swapping)
    with pytest.raises(OSError, match="Not a directory"):  # the link is gone when it is looked at
        open_for_program(path, "w")
    assert (outside / "data.dat").read_text() == "secret"
    assert path.read_text() == "mine"


def test_a_link_for_a_folder_is_named_as_the_reason(tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to("real")
    with pytest.raises(OSError, match="a link stands in its way"):
        open_for_program(tmp_path / "link" / "data.dat", "w")
    assert not list((tmp_path / "real").iterdir())


OPEN_FILES = Path("/proc/self/fd")


def test_no_folder_stays_open(tmp_path):
    path = tmp_path / "a" / "b" / "data.dat"
    path.parent.mkdir(parents=True)
    before = len(list(OPEN_FILES.iterdir()))
    open_for_program(path, "w").close()
    for missing in (path.parent / "c" / "d", path / "e", path.parent / "f"):
        with pytest.raises(OSError, match=r"No such file|Not a directory"):
            open_for_program(missing, "r")
    assert len(list(OPEN_FILES.iterdir())) == before


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("connect '{}.dat' as output 2 | write #2, 1", 11),
        ("connect '{}.dat' as input 2", 11),
        ("notebook '{}.md'", 106),
    ],
)
def test_a_name_too_long_is_the_programs_error(tmp_path, monkeypatch, line, code):
    monkeypatch.chdir(tmp_path)
    result = desire_tui.run(line.format("n" * 300) + "\n", allow_write=True)
    assert [problem.code for problem in result.problems] == [code], result.problems
