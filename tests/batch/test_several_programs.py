"""`desire run A.src B.src … -j N`: processes, the order of what they say, names of files, exit status."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from time import sleep

import pytest

from desire_tui.batch import several_programs
from desire_tui.batch.output_files import OutputFiles
from desire_tui.batch.runner import RunOptions
from desire_tui.engine import thread_count
from tests.batch.command_line import ROOT, desire, desire_process

RUN = "TMAX = 1 | DT = 0.1 | NN = 3 | x = {n}\ndrun\nwrite 'final '; x\nDYNAMIC\nd/dt x = 1\ndispt x\n"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}


def no_process_is_left(group):
    """Whether the fork server, which ends when it notices that nobody needs it, ends too."""
    for _ in range(600):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        sleep(0.1)
    return False


@pytest.fixture
def programs(tmp_path):
    for n in (1, 2, 3):
        (tmp_path / f"p{n}.src").write_text(RUN.format(n=n))
    (tmp_path / "slow.src").write_text("sh sleep 1\nwrite 'slow'\nwrite $7\n")
    (tmp_path / "wrong.src").write_text("write 'before'\nwrite zork\n")
    (tmp_path / "endless.src").write_text("write 'on'\nlabel a\nx = x + 1\ngo to a\n")
    return tmp_path


def test_output_comes_in_the_order_of_the_files_with_their_names_and_files_are_named_after_them(programs):
    words = ("run", "slow.src", "p2.src", "wrong.src", "p1.src", "-j", "4", "--allow-shell", "--csv", "out/")
    status, out, err = desire_process(*words, "--json", "{}-all.json", cwd=programs)
    assert status == 1
    assert out == (
        "==> slow.src <==\nslow\n\x07\n==> p2.src <==\nfinal 3\n==> wrong.src <==\nbefore\n==> p1.src <==\nfinal 2\n"
    )
    assert err.startswith("wrong.src:2:7: error 200: ")
    assert err.endswith("\n4 programs: 1 failed (wrong.src)\n")
    assert (programs / "out/p2.csv").read_text().splitlines()[-1].startswith("1,1.0,3.0")
    assert sorted(path.name for path in (programs / "out").iterdir()) == [
        "p1.csv", "p2.csv", "slow.csv", "wrong.csv",
    ]  # fmt: skip
    assert {path.name for path in programs.glob("*.json")} == {
        "p1-all.json", "p2-all.json", "slow-all.json", "wrong-all.json",
    }  # fmt: skip


def test_settings_reach_every_program(programs):
    words = ("run", "p1.src", "p2.src", "--set", "x=5", "-j", "0", "--quiet", "--csv", "{}.csv")
    assert desire_process(*words, cwd=programs) == (0, "", "")
    for name in ("p1", "p2"):
        assert (programs / f"{name}.csv").read_text().splitlines()[1] == "1,0.0,5.0"


def test_a_limit_is_status_3(programs):
    (programs / "other.src").write_text("label a\nx = x + 1\ngo to a\n")
    status, out, err = desire_process(
        "run", "endless.src", "other.src", "--timeout", "0.2", "-j", "2", "--quiet", cwd=programs
    )
    assert (status, out) == (3, "")
    assert "endless.src: error 490" in err
    assert err.endswith("2 programs: 2 stopped by a limit or Ctrl-C (endless.src, other.src)\n")


def test_nobody_reads_standard_input_and_a_module_beside_the_programs_is_not_ours(programs):
    (programs / "ask.src").write_text("input x\nwrite x\n")
    for name in ("selectors", "numpy", "multiprocessing"):
        (programs / f"{name}.py").write_text(f"print('{name} of a stranger')\n")
    status, out, err = desire_process("run", "ask.src", "p1.src", text_in="7\n", cwd=programs)
    assert (status, out) == (1, "==> ask.src <==\nx ? \n==> p1.src <==\nfinal 2\n")
    assert "stranger" not in err
    assert "ask.src:1:1: error" in err


def test_ctrl_c_ends_all_of_them(programs):
    words = [sys.executable, "-m", "desire_tui", "run", "endless.src", "endless.src", "p1.src", "-j", "2"]
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=programs, env=ENVIRONMENT,
        start_new_session=True,
    ) as process:  # fmt: skip
        assert process.stdout.readline() == "==> endless.src <==\n"
        assert process.stdout.readline() == "on\n"
        os.killpg(process.pid, signal.SIGINT)
        _, err = process.communicate(timeout=300)
    assert process.returncode == 3
    assert "Traceback" not in err
    assert "stopped by the user" in err
    assert no_process_is_left(process.pid)


def test_a_process_that_dies_is_a_failed_program(programs):
    (programs / "dies.src").write_text("sh kill -9 $PPID\nwrite 'never'\n")
    status, out, err = desire_process("run", "dies.src", "p1.src", "--allow-shell", cwd=programs)
    assert (status, out) == (1, "==> p1.src <==\nfinal 2\n")
    assert "signal 9" in err
    assert "1 failed (dies.src)" in err


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("p1.src", "p2.src", "--png", "g.png"), "--png 'results/{}.png'"),
        (("p1.src", "p2.src", "--csv", "-"), "--csv - is for one program"),
        (("p1.src", "-"), "standard input"),
        (("p1.src", "old/p1.src", "--csv", "out/"), "p1.src and old/p1.src would both write out/p1.csv"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_runs(programs, words, sentence):
    status, out, err = desire("run", *words, cwd=programs)
    assert (status, out) == (2, "")
    assert sentence in err
    assert not (programs / "out").exists()


def test_one_program_writes_into_a_folder_too(programs):
    (programs / "there").mkdir()
    assert (
        desire(
            "run", "p1.src", "--quiet", "--csv", "there", "--npz", "new/", "--png", "{}-a.png", cwd=programs
        )[0]
        == 0
    )
    for name in ("there/p1.csv", "new/p1.npz", "p1-a.png"):
        assert (programs / name).is_file()


def test_several_graphs_are_pages_of_one_pdf(tmp_path):
    (tmp_path / "p.src").write_text(RUN.format(n=1).replace("drun\n", "drun\ndrun\nnote\ndrun\n", 1))
    assert desire("run", "p.src", "--pdf", "g.pdf", "--png", "g.png", cwd=tmp_path)[0] == 0
    pictures = len(list(tmp_path.glob("g*.png")))
    assert pictures > 1
    assert [path.name for path in tmp_path.glob("*.pdf")] == ["g.pdf"]
    assert (tmp_path / "g.pdf").read_bytes().count(b"/Type /Page ") == pictures


def test_programs_side_by_side_share_the_threads_of_large_models(monkeypatch):
    given = []

    class Context:
        def set_forkserver_preload(self, names):
            pass

        def Pipe(self, *, duplex):
            return None, None

        def Process(self, *, target, args, daemon):
            given.append(args)
            raise InterruptedError

    monkeypatch.setattr(several_programs.multiprocessing, "get_context", lambda _: Context())
    how = several_programs.HowToRun(RunOptions(), OutputFiles(), None, quiet=True, raw=False)
    for names, jobs, at_once in ((["a", "b", "c"], 2, 2), (["a", "b"], 5, 2)):
        with pytest.raises(InterruptedError):
            several_programs.run_files(names, how, jobs)
        assert given.pop()[1].at_once == at_once
    monkeypatch.setattr(thread_count, "_configured", lambda: 6)
    monkeypatch.setattr(several_programs, "run_file", lambda *_, **__: thread_count.thread_count())
    out, err = (Path(os.devnull).open() for _ in range(2))  # noqa: SIM115 - it closes them
    with monkeypatch.context() as here:
        here.setattr(os, "dup2", lambda *_: None)
        with pytest.raises(SystemExit) as ended:
            several_programs._run_here("a", replace(how, at_once=2), out, err, None)
    assert ended.value.code == 3
