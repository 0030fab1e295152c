"""Stash files, notebook, permissions, snapshot."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.permissions import Permissions
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.runtime import running
from tests.runtime.running import Kept

STASH = "TMAX = 2 | NN = 5 | DT = 0.25\n{drun}\nDYNAMIC\nd/dt x = 1\ny = 2*x\nstash x, y\ndispt x\n"
RECOVER = "NN = 5\ndrun\nDYNAMIC\nrecover p, q\nz = p + q\ndispt z\n"


def run_in(folder, name, text):
    path = folder / name
    path.write_text(text)
    session = Session(Kept(), backend=running.BACKEND)
    session.erun(Source(text, str(path), path))
    return session


def test_stashed_histories_come_back(tmp_path):
    run_in(tmp_path, "model.src", STASH.format(drun="drun"))
    saved = np.load(tmp_path / "model.stash.npy")
    assert saved == pytest.approx(np.array([[0, 0], [0.5, 1], [1, 2], [1.5, 3], [2, 4]]), abs=1e-12)
    session = run_in(tmp_path, "model.src", RECOVER)
    assert session.runs[0].values("z") == pytest.approx([0, 1.5, 3, 4.5, 6], abs=1e-12)
    assert not [q.name for q in session.values if "recover" in q.name]


def test_drun_star_writes_no_stash_file(tmp_path):
    run_in(tmp_path, "model.src", STASH.format(drun="drun *"))
    assert not (tmp_path / "model.stash.npy").exists()


@pytest.mark.parametrize("content", [None, b"no array", b""])
def test_a_missing_or_broken_stash_file_is_error_92(tmp_path, content):
    if content is not None:
        (tmp_path / "model.stash.npy").write_bytes(content)
    with pytest.raises(DesireError) as caught:
        run_in(tmp_path, "model.src", RECOVER)
    assert caught.value.diagnostics[0].code == 92


def test_the_shell_is_refused_unless_allowed(tmp_path):
    with pytest.raises(DesireError) as caught:
        running.session_for("sh echo hello > made\n", folder=tmp_path)
    assert caught.value.diagnostics[0].code == 450
    assert not (tmp_path / "made").exists()
    kept = Kept()
    session = Session(kept, folder=tmp_path, permissions=Permissions(shell=True))
    session.erun(Source("sh echo hello\n", "test.src"))
    assert kept.text == "hello\n"


@pytest.mark.parametrize("name", ["../out.txt", "/tmp/desire-out.txt", "sub/../../out.txt"])
def test_files_outside_the_folder_are_refused(tmp_path, name):
    folder = tmp_path / "home"
    folder.mkdir()
    with pytest.raises(DesireError) as caught:
        running.session_for(f"connect '{name}' as output 3\n", folder=folder)
    assert caught.value.diagnostics[0].code == 451


def test_a_link_does_not_lead_out_of_the_folder(tmp_path):
    folder = tmp_path / "home"
    folder.mkdir()
    (folder / "link").symlink_to(tmp_path)
    with pytest.raises(DesireError) as caught:
        running.session_for("connect 'link/out.txt' as output 3\n", folder=folder)
    assert caught.value.diagnostics[0].code == 451


def test_what_the_user_grants_is_remembered(tmp_path):
    class Asked(Kept):
        asked = 0

        def permit(self, request):
            self.asked += 1
            return "out.txt" in request.sentence

    folder = tmp_path / "home"
    folder.mkdir()
    kept = Asked()
    session = Session(kept, folder=folder)
    for _ in range(2):
        session.erun(Source("connect '../out.txt' as output 3\nwrite #3, 1\ndisconnect 3\n", "t"))
    assert kept.asked == 1
    assert (tmp_path / "out.txt").read_text().strip() == "1"


def test_the_notebook_keeps_commands_programs_runs_and_notes(tmp_path):
    path = tmp_path / "model.src"
    text = "TMAX = 1 | drun\nDYNAMIC\nd/dt x = 1\ndispt x\n"
    session = Session(Kept(), backend=running.BACKEND, folder=tmp_path)
    session.accept(Source(text, str(path), path))
    session.execute("notebook 'journal.md'")
    session.execute("run")
    session.execute("note 'x is '; x")
    session.execute("snapshot 'graph.svg'")
    session.execute("notebook off")
    session.execute("note 'not this'")
    journal = (tmp_path / "journal.md").read_text()
    for part in ("```desire\nTMAX = 1", "Run 1: rule 1", "> run", "x is 1", "graph.svg"):
        assert part in journal
    assert "not this" not in journal
    assert (tmp_path / "graph.svg").read_text().lstrip().startswith("<?xml")


def test_snapshot_without_a_graph_or_of_an_unknown_kind(tmp_path):
    session = running.session_for("x = 1\n", folder=tmp_path)
    for command, code in (("snapshot 'a.png'", 471), ("snapshot 'a.bmp'", 471)):
        with pytest.raises(DesireError) as caught:
            session.execute(command)
        assert caught.value.diagnostics[0].code == code
    session = running.session_for("display A | plot 0, 0\n", folder=tmp_path)
    with pytest.raises(DesireError) as caught:
        session.execute("snapshot 'a.bmp'")
    assert caught.value.diagnostics[0].code == 34


def test_compare_rules_leaves_everything_as_it_was():
    program = "TMAX = 1 | DT = 0.1 | NN = 11 | x = 1\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"
    session, kept = running.ran(program)
    before = running.value(session, "x")
    session.execute("compare rule 3")
    table = kept.text.split("\n")
    assert table[0] == "rule 1: 10 steps, rule 3: 10 steps"
    # rule 1 and rule 3 after ten steps of 0.1: models.md 1.2.5
    assert float(table[2].split()[1]) == pytest.approx(0.3685409848 - 0.3678797744, abs=1e-9)
    assert running.value(session, "x") == before
    assert running.value(session, "t") == 1.0
    assert len(session.runs) == 1


def test_dump_run_and_list():
    session, kept = running.ran("TMAX = 1 | drun\nDYNAMIC\nd/dt x = 1\n")
    session.execute("dump run")
    assert "rule 1, TMAX reached" in kept.text
    kept.text = ""
    session.execute("list")
    assert kept.text == "TMAX = 1 | drun\nDYNAMIC\nd/dt x = 1\n"


def test_desktop_commands_say_where_they_work():
    session, _ = running.ran("x = 1\n")
    with pytest.raises(DesireError) as caught:
        session.execute("ed")
    assert caught.value.diagnostics[0].code == 402
    assert "'ed'" in caught.value.diagnostics[0].message


def test_help_finds_statements_and_error_numbers():
    session, kept = running.ran("x = 1\n")
    session.execute("help 'drun'")
    assert "drun" in kept.text
    assert "87" in session.help("87")
    with pytest.raises(DesireError) as caught:
        session.help("no such topic at all")
    assert caught.value.diagnostics[0].code == 403


def test_overrides_win_over_the_script():
    session = Session(Kept(), backend=running.BACKEND)
    session.override({"a": 5.0, "NN": 11.0})
    session.erun(Source("a = 1 | NN = 21 | TMAX = 1 | b = 2*a\ndrun\nDYNAMIC\nd/dt x = a\n", "t"))
    assert running.value(session, "b") == 10
    assert session.runs[0].nn == 11


def test_check_is_pure():
    session, _ = running.ran("x = 1\n")
    problems = session.check(Source("TMAX = 1 | drun\nDYNAMIC\nd/dt y = nope\n", "other"))
    assert [p.code for p in problems] == [200]
    assert session.program.source.name == "test.src"
    assert session.values.find("y") is None
