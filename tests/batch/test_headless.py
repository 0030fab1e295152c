"""`desire run`: streams, files, exit statuses (headless.md 1, 2 and 3)."""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys
from contextlib import contextmanager
from io import StringIO
from pathlib import Path
from time import monotonic

import numpy as np
import pytest

from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from tests.batch.command_line import ROOT, desire, desire_process

FILE_KINDS = ("png", "svg", "pdf", "csv", "json", "npz")

DECAY = """TMAX = 1 | DT = 0.1 | NN = 11 | x = 1 | a = 1
drun
write "done, x = "; x
DYNAMIC
d/dt x = -a*x
dispt x
"""


@pytest.fixture
def decay(tmp_path):
    path = tmp_path / "decay.src"
    path.write_text(DECAY)
    return path


def test_console_text_to_stdout_and_nothing_else(decay):
    status, out, err = desire_process("run", decay)
    assert (status, err) == (0, "")
    assert out.startswith("done, x = 0.3685")


def test_quiet(decay):
    assert desire("run", decay, "--quiet") == (0, "", "")


def test_problems_to_stderr_and_status_1(tmp_path):
    path = tmp_path / "wrong.src"
    path.write_text("TMAX = 1\nwrite 'before'\ndrun\nDYNAMIC\nd/dt x = -aa*x\ndispt x\n")
    status, out, err = desire_process("run", path)
    assert status == 1
    assert out == "before\n"
    assert err.startswith(f"{path}:5:11: error 200: ")
    assert "^^" in err


def test_each_csv_column_stands_once():
    import desire_tui
    from desire_tui.engine.outputs.csv_file import write_csv

    text = "NN = 2\ndrun\ndrun b\nDYNAMIC\ny = 2*t\ndispxy t, y, y\nlabel b\nz = 3*t\nDISPXY z, t, y, z\n"
    file = StringIO()
    write_csv(desire_tui.run(text).runs, file)
    rows = file.getvalue().split("\n")
    assert rows[:4] == ["run,t,y,z,segment", "1,1.0,2.0,,", "1,2.0,4.0,,", "2,2.0,4.0,6.0,b"]


def test_all_files_at_once(decay, tmp_path):
    status, _, _ = desire(
        "run", decay, "--png", tmp_path / "g.png", "--svg", tmp_path / "g.svg", "--pdf", tmp_path / "g.pdf",
        "--csv", tmp_path / "g.csv", "--json", tmp_path / "g.json", "--npz", tmp_path / "g.npz",
    )  # fmt: skip
    assert status == 0
    assert (tmp_path / "g.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert (tmp_path / "g.pdf").read_bytes()[:5] == b"%PDF-"
    assert "<svg" in (tmp_path / "g.svg").read_text()
    rows = (tmp_path / "g.csv").read_text().split("\n")
    assert rows[0] == "run,t,x"
    assert rows[1] == "1,0.0,1.0"
    assert len(rows) == 13  # header, eleven samples, the end of the last line
    last = rows[11].split(",")
    assert float(last[1]) == pytest.approx(1.0)
    assert float(last[2]) == pytest.approx(0.3685409848, abs=1e-9)  # rule 1, ten steps: models.md 1.2.5
    with np.load(tmp_path / "g.npz") as archive:
        assert set(archive) >= {"1/t", "1/x", "final/x", "final/a", "final/DT"}
        assert archive["1/x"][-1] == float(last[2]) == archive["final/x"]
        assert archive["1/t"].tolist() == [float(row.split(",")[1]) for row in rows[1:12]]


def test_json_layout(decay, tmp_path):
    desire("run", decay, "--json", tmp_path / "g.json")
    data = json.loads((tmp_path / "g.json").read_text())
    assert list(data) == [
        "desire",
        "program",
        "status",
        "problems",
        "console",
        "runs",
        "plots",
        "quantities",
        "timings",
    ]
    assert (data["status"], data["problems"], data["plots"]) == ("done", [], [])
    assert data["program"] == str(decay)
    (run,) = data["runs"]
    assert list(run) == [
        "segment", "line", "request", "overlay", "rule", "scale", "t0", "tmax", "nn", "dt", "t", "curves", "ended",
        "end_time", "steps", "rejected", "derivative_calls", "jacobian_calls", "dt_least", "dt_most", "order", "seconds",
        "parameters", "initial", "continues",
    ]  # fmt: skip
    assert (run["segment"], run["line"], run["request"], run["overlay"]) == (None, 2, "dispt", False)
    assert (run["rule"], run["nn"], run["dt"], run["ended"], run["steps"]) == (1, 11, 0.1, "tmax", 10)
    assert (run["jacobian_calls"], run["dt_least"], run["dt_most"], run["order"]) == (0, 0.1, 0.1, 0)
    (curve,) = run["curves"]
    assert (curve["name"], curve["x"], len(curve["values"])) == ("x", None, 11)
    assert data["quantities"]["a"] == 1.0
    assert set(data["timings"]) == {"parse_s", "compile_s", "run_s"}
    assert data["console"].startswith("done, x = 0.3685")


def test_json_of_everything_odd(tmp_path):
    path = tmp_path / "odd.src"
    path.write_text(
        "COMPLEX z | z = [3, 4]\nARRAY A[2,2] | A[1,2] = 7\nNN = 3 | y = 1.0E+200 | big = 1/1.0E-300*1.0E-5\n"
        "drun\nDYNAMIC\nx = t | w = 2*t | v = 1.0E+300*10\ndispxy x, w, v\n"
    )
    status, _, err = desire("run", path, "--json", "-")
    assert (status, err) == (0, "")
    _, out, _ = desire("run", path, "--json", "-")
    data = json.loads(out)
    assert data["quantities"]["z"] == [3.0, 4.0]
    assert data["quantities"]["A"] == [[0.0, 7.0], [0.0, 0.0]]
    assert [(c["name"], c["x"]) for c in data["runs"][0]["curves"]] == [("x", None), ("w", "x"), ("v", "x")]


def test_json_of_problems_has_places(tmp_path):
    path = tmp_path / "wrong.src"
    path.write_text("TMAX = 1\ny = 1 + xdto\n")
    status, out, _ = desire("run", path, "--json", "-")
    assert status == 1
    data = json.loads(out)
    assert data["status"] == "failed"
    (problem,) = data["problems"]
    assert list(problem) == [
        "code",
        "severity",
        "message",
        "file",
        "line",
        "column",
        "end_line",
        "end_column",
        "hint",
    ]
    assert (problem["code"], problem["line"], problem["column"], problem["end_column"]) == (200, 2, 9, 13)


def test_inf_in_a_curve_is_a_string():
    from desire_tui.engine.outputs.json_file import as_json
    from desire_tui.engine.outputs.results import Result

    result = Result("0", "p", quantities={"a": float("inf"), "b": float("nan"), "c": -float("inf")})
    assert json.loads(as_json(result))["quantities"] == {"a": "inf", "b": "nan", "c": "-inf"}


def test_several_graphs_are_numbered(tmp_path):
    path = tmp_path / "two.src"
    path.write_text("TMAX = 1 | drunr | drunr\nDYNAMIC\nd/dt x = 1\ndispt x\n")
    assert desire("run", path, "--svg", tmp_path / "g.svg")[0] == 0
    assert sorted(p.name for p in tmp_path.glob("*.svg")) == ["g-1.svg", "g-2.svg"]


def test_without_a_graph_data_are_written_and_pictures_are_a_warning(tmp_path):
    path = tmp_path / "none.src"
    path.write_text("x = 1\n")
    files = {kind: tmp_path / f"g.{kind}" for kind in ("png", "svg", "json", "csv")}
    status, _, err = desire("run", path, *(word for kind, f in files.items() for word in (f"--{kind}", f)))
    assert status == 0
    assert "warning 471: there is no graph for --png, --svg" in err
    assert json.loads(files["json"].read_text())["quantities"]["x"] == 1.0
    assert [kind for kind, f in files.items() if f.exists()] == ["json", "csv"]


def test_an_output_that_fails_keeps_none_of_the_others_back(decay, tmp_path):
    status, _, err = desire(
        "run", decay, "--csv", tmp_path / "nowhere" / "x.csv", "--json", tmp_path / "x.json",
        "--png", tmp_path / "x.png",
    )  # fmt: skip
    assert status == 1
    assert "error 106" in err
    assert (tmp_path / "x.json").exists()
    assert (tmp_path / "x.png").exists()


def test_plot_is_text_with_frame_and_caption(decay):
    status, out, _ = desire("run", decay, "--plot", "--quiet")
    assert status == 0
    assert "scale = 1" in out
    assert "x vs. t" in out
    assert any(0x2800 < ord(c) <= 0x28FF for c in out)
    assert max(len(line) for line in out.split("\n")) <= 80
    assert "\x1b" not in out  # no colours into a file


def test_set_overrides_the_script(decay):
    _, out, _ = desire("run", decay, "--set", "a=0", "--set", "x = 2.5E0")
    assert out == "done, x = 2.5\n"


@pytest.mark.parametrize(
    "setting", ["a", "a=b", "=3", "3=4", "a[x]=2", "a[]=1", "a[1]=2,3", "a=1,,2", "a=1,2;"]
)
def test_wrong_settings_are_wrong_usage(decay, setting):
    status, out, err = desire("run", decay, "--set", setting)
    assert (status, out) == (2, "")
    assert "NAME=NUMBER" in err


ARRAYS = """n = 3
ARRAY v[n], A[2,n], p[2] + q[2] = pq
STATE x[n]
INTEGER k
k = 5 | c = 2
data 1, 2, 3 | read v
MATRIX A = 1
for i = 1 to n | x[i] = 10*i | next
data 4, 5, 6, 7 | read pq
PROCEDURE double(a; b) | b = 2*a | end
call double(c; d)
write k, c, d
write v[1], v[2], v[3]
write A[1,2], A[2,3]
write x[1], x[2], x[3]
write p[1], p[2], q[1], q[2]
"""


@pytest.mark.parametrize(
    ("settings", "line", "expected"),
    [
        ([], 0, "5 2 4"),
        (["k=7.6"], 0, "8 2 4"),
        (["c=3"], 0, "5 3 6"),
        (["d=9"], 0, "5 2 9"),
        (["v[2]=-1e-3"], 1, "1 -0.001 3"),
        (["v=7, 8, 9"], 1, "7 8 9"),
        (["v=7,8,9", "v[1]=0"], 1, "0 8 9"),
        (["v=7,8"], 1, "7 8 3"),
        (["n=4", "v[3]=0"], 1, "1 2 0"),
        (["A[2,3]=0.5"], 2, "0 0.5"),
        (["A=1,2,3;4,5,6"], 2, "2 6"),
        (["x[3]=5"], 3, "10 20 5"),
        (["x=4,5,6"], 3, "4 5 6"),
        (["q[1]=0"], 4, "4 5 0 7"),
        (["pq=9,8"], 4, "9 8 6 7"),
    ],
)
def test_set_reaches_whatever_the_script_assigns(tmp_path, settings, line, expected):
    """By assignment, declaration, data, MATRIX, a loop, a PROCEDURE's result; overlays share memory."""
    import desire_tui
    from desire_tui.batch.set_option import from_texts

    text = ARRAYS.replace("data 1, 2, 3 |", "data 1, 2, 3, 0 |") if "n=4" in settings else ARRAYS
    if "n=4" in settings:
        text = text.replace("MATRIX A = 1\n", "")
    result = desire_tui.run(text, set=from_texts(settings))
    assert result.problems == ()
    assert result.console.split("\n")[line].split() == expected.split()


def test_set_arrays_from_the_command_line_and_from_python(tmp_path):
    import desire_tui

    path = tmp_path / "p.src"
    path.write_text("ARRAY A[2,2], v[2]\nMATRIX A = 0\nwrite A[1,1], A[1,2], A[2,2], v[2]\n")
    assert desire("run", path, "--set", "A=1,2;3,4", "--set", "v[2]=6") == (0, "1\t2\t4\t6\n", "")
    result = desire_tui.run(path, set={"A": np.array([[1, 2], [3, 4]]), "v": [5, 6], "v[1]": 0})
    assert result.console == "1\t2\t4\t6\n"
    assert result["v"].tolist() == [0, 6]
    for wrong in ({"3": 1}, {"a b": 1}, {"v[1]": [1, 2]}, {"v": "many"}, {"v[1]": np.inf}):
        with pytest.raises(ValueError):
            desire_tui.run(path, set=wrong)


def test_set_does_not_reach_dummies_and_submodels(tmp_path):
    """A PROCEDURE's dummy and a SUBMODEL's own line bear the name of what is set; they mean something else."""
    path = tmp_path / "p.src"
    path.write_text(
        "PROCEDURE p(a; b)\na = a + 1\nb = a\nend\nSUBMODEL s(q$)\ng = 2*q$\nend\na = 5 | g = 0\n"
        "call p(10; r)\nq = 1 | NN = 2\ndrun\nwrite a, r, g\nDYNAMIC\ninvoke s(q)\ntype g\n"
    )
    status, out, _ = desire("run", path, "--set", "a=7", "--set", "g=9")
    assert (status, out.split("\n")[-2]) == (0, "7\t11\t2")


def test_what_is_set_is_not_asked_for(tmp_path):
    path = tmp_path / "p.src"
    path.write_text("input x\ninput y, z\nwrite x, y, z\n")
    status, out, _ = desire("run", path, "--set", "x=1", "--set", "y=2", text_in="8\n9\n")
    assert status == 0
    assert out == "y ? 8\nz ? 9\n1\t2\t9\n"


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("alpa=1", ["no 'alpa'", "did you mean 'alpha'?"]),
        ("v=1", ["'v'", "is an array"]),
        ("alpha[1]=1", ["'alpha' is no array"]),
    ],
)
def test_a_setting_the_program_has_no_use_for(tmp_path, setting, words):
    path = tmp_path / "p.src"
    path.write_text("alpha = 1\nARRAY v[2]\nwrite alpha\n")
    status, out, err = desire("run", path, "--set", setting)
    assert (status, out) == (1, "")
    assert "error 409" in err
    assert all(word in err for word in words)
    assert desire("run", path, "--set", "DT=0.1")[0] == 0  # the system's own names are always known


@pytest.mark.parametrize(("name", "code"), [("PI", 55), ("f", 73), ("p", 73)])
def test_constants_functions_and_procedures_cannot_be_set(name, code):
    import desire_tui

    text = "FUNCTION f(x) = x\nPROCEDURE p(x)\ny = x\nend\nwrite PI, f(1)\ncall p(1)\n"
    result = desire_tui.run(text, set={name: 3})
    assert [problem.code for problem in result.problems] == [code]
    assert result.console == ""


@pytest.mark.parametrize("value", ["inf", "nan", "1e999", "1,nan", "1,2;3,-inf"])
def test_only_numbers_can_be_set(value):
    from desire_tui.batch.set_option import from_texts

    with pytest.raises(ValueError, match="a="):
        from_texts([f"a={value}"])


def test_a_subscript_beyond_the_array_is_told_at_its_declaration(tmp_path):
    path = tmp_path / "p.src"
    path.write_text("ARRAY v[2]\n")
    status, _, err = desire("run", path, "--set", "v[3]=1")
    assert status == 1
    assert f"{path}:1:1: error 2" in err


def test_stop_ends_unless_go(tmp_path):
    path = tmp_path / "stop.src"
    path.write_text("write 1\nSTOP\nwrite 2\nSTOP\nwrite 3\n")
    status, out, err = desire("run", path)
    assert (status, out) == (0, "1\n")
    assert "stopped at STOP" in err
    assert desire("run", path, "--go") == (0, "1\n2\n3\n", "")


def test_input_from_standard_input_and_from_a_file(tmp_path):
    path = tmp_path / "ask.src"
    path.write_text("input x, y\nwrite x + y\n")
    status, out, _ = desire("run", path, text_in="2\n3*4\n")
    assert status == 0
    assert out == "x ? 2\ny ? 3*4\n14\n"
    (tmp_path / "answers").write_text("1, 2\n")
    assert desire("run", path, "--input", tmp_path / "answers")[1].endswith("3\n")


def test_no_more_input_is_a_message(tmp_path):
    path = tmp_path / "ask.src"
    path.write_text("input x\n")
    status, _, err = desire("run", path)
    assert status == 1
    assert f"{path}:1:1: error 18: there is no more input" in err


def test_timeout_is_status_3(tmp_path):
    path = tmp_path / "long.src"
    path.write_text("TMAX = 1.0E+09 | DT = 0.001 | drun\nDYNAMIC\nd/dt x = cos(t)\ndispt x\n")
    began = monotonic()
    status, _, err = desire_process("run", path, "--timeout", "2", "--json", tmp_path / "g.json")
    assert status == 3
    assert monotonic() - began < 250
    assert "stopped after 2 seconds" in err
    data = json.loads((tmp_path / "g.json").read_text())
    assert data["status"] == "limit"
    assert [run["ended"] for run in data["runs"]] == ["stopped"]


def test_ctrl_c_ends_with_status_3(tmp_path):
    path = tmp_path / "long.src"
    path.write_text(
        "write 'started'\nTMAX = 1.0E+09 | DT = 0.001 | drun\nDYNAMIC\nd/dt x = cos(t)\ndispt x\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-m", "desire_tui", "run", str(path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert process.stdout.readline() == "started\n"
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=300)
    assert process.returncode == 3
    assert "stopped by the user" in err
    assert "Traceback" not in err


@pytest.mark.parametrize(
    "module",
    ["click", "numpy", "desire_tui.batch.cli_commands", "desire_tui.engine.session"],
)
@pytest.mark.parametrize("command", ["run", "check"])
def test_ctrl_c_while_the_program_is_still_loading(decay, command, module):
    """The moment is made certain: loading a module of the way raises what Ctrl-C raises."""
    code = (
        "import sys\nclass Finder:\n  def find_spec(self, name, path=None, target=None):\n"
        f"    if name == {module!r}: raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Finder())\nfrom desire_tui.__main__ import main\n"
        f"main([{command!r}, {str(decay)!r}])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=300,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert (done.returncode, done.stdout, done.stderr) == (3, "", "stopped by the user\n")


def test_ctrl_c_while_waiting_for_input(tmp_path):
    path = tmp_path / "ask.src"
    path.write_text("write 'started'\ninput x\n")
    process = subprocess.Popen(
        [sys.executable, "-m", "desire_tui", "run", str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert process.stdout.readline() == "started\n"
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=300) == 3
    assert "Traceback" not in process.stderr.read()


@pytest.mark.parametrize("what", ["missing", "folder", "binary", "unreadable"])
def test_files_that_are_no_programs(tmp_path, what):
    path = tmp_path / "p.src"
    if what == "folder":
        path.mkdir()
    elif what == "binary":
        path.write_bytes(b"\x7fELF\x00\x01")
    elif what == "unreadable":
        path.symlink_to(path)  # a loop, so that root meets an error too
    for command in ("run",) if what == "folder" else ("run", "check"):  # `check` takes folders
        status, out, err = desire(command, path)
        assert (status, out) == (1, "")
        assert "error 38" in err
        assert str(path) in err


def test_output_that_cannot_be_written(decay, tmp_path):
    for option in ("--png", "--csv", "--json"):
        status, _, err = desire("run", decay, option, tmp_path / "no" / f"such.{option[2:]}")
        assert status == 1
        assert "error 106" in err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize("kind", FILE_KINDS)
def test_a_full_disk_is_a_message(decay, tmp_path, kind):
    (tmp_path / f"full.{kind}").symlink_to("/dev/full")
    status, _, err = desire("run", decay, f"--{kind}", tmp_path / f"full.{kind}")
    assert status == 1
    assert "error 106" in err
    assert "No space left" in err


@pytest.mark.skipif(sys.platform == "win32", reason="needs limits of the system")
@pytest.mark.parametrize("kind", FILE_KINDS)
def test_a_disk_that_becomes_full_leaves_the_old_file(decay, tmp_path, kind):
    folder = tmp_path / "out"
    folder.mkdir()
    path = folder / f"old.{kind}"
    path.write_text("old")
    with files_of_100_bytes():
        status, _, err = desire("run", decay, f"--{kind}", path)
    assert status == 1
    assert f"error 106: cannot write {path}: File too large" in err
    assert path.read_text() == "old"
    assert [p.name for p in folder.iterdir()] == [path.name]


@contextmanager
def files_of_100_bytes():
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_reader_that_leaves(tmp_path):
    path = tmp_path / "much.src"
    path.write_text("for k = 1 to 200000\nwrite k\nnext\n")
    done = subprocess.run(
        f"{sys.executable} -m desire_tui run {path} | head -n 1", shell=True, capture_output=True, text=True,
        timeout=300, check=False, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert (done.stdout, done.stderr) == ("1\n", "")


@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGINT])
def test_a_signal_that_the_one_who_started_it_ignores_is_ignored(tmp_path, number):
    path = tmp_path / "nohup.src"
    path.write_text("write 'started'\ninput x\nwrite x\n")
    with subprocess.Popen(
        ["sh", "-c", f"trap '' {number.name[3:]}; exec {sys.executable} -m desire_tui run {path}"],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": str(ROOT)},
    ) as child:  # fmt: skip
        assert child.stdout is not None
        assert child.stdout.readline() == "started\n"
        child.send_signal(number)
        assert child.communicate("3\n", timeout=60)[0].endswith("3\n")
    assert child.returncode == 0


def test_check(tmp_path):
    good, bad = tmp_path / "good.src", tmp_path / "bad.src"
    good.write_text(DECAY)
    bad.write_text("TMAX = 1\nfor k = 1 to\ndrun\nDYNAMIC\nd/dt x = nope\n")
    assert desire("check", good) == (0, "", "")
    status, out, err = desire("check", good, bad)
    assert (status, out) == (1, "")
    assert f"{bad}:2:" in err
    assert f"{bad}:5:" in err


def test_usage():
    assert desire("--version")[1].startswith("desire")
    status, out, _ = desire("--help")
    assert status == 0
    assert "run" in out
    assert desire("run")[0] == 2
    assert desire("run", "x", "--nonsense")[0] == 2
    status, _, err = desire_process()
    assert status == 2
    assert "terminal" in err


def test_a_program_from_standard_input():
    for command in (desire, desire_process):
        assert command("run", "-", text_in="write 6*7\n") == (0, "42\n", "")


def test_shell_and_files_need_flags(tmp_path):
    path = tmp_path / "home" / "p.src"
    path.parent.mkdir()
    path.write_text("sh echo hi\n")
    assert desire("run", path)[0] == 1
    assert desire("run", path, "--allow-shell") == (0, "hi\n", "")
    path.write_text("connect '../out.txt' as output 2\nwrite #2, 5\n")
    assert desire("run", path)[0] == 1
    assert not (tmp_path / "out.txt").exists()
    assert desire("run", path, "--allow-write")[0] == 0
    assert (tmp_path / "out.txt").read_text() == "5\n"


def test_headless_runs_load_neither_textual_nor_matplotlib(decay):
    parse(Source("x = 1"))  # makes the parse tables, for which lark is imported once
    code = (
        "import sys\nfrom desire_tui.__main__ import main\n"
        f"try: main(['run', {str(decay)!r}])\nexcept SystemExit: pass\n"
        "unwanted = 'textual', 'rich', 'matplotlib', 'plotext', 'scipy', 'dataclasses', 'desire_tui.engine.warm_start'\n"
        "bad = [m for m in unwanted if m in sys.modules]\n"
        "sys.exit(repr(bad) if bad else 0)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


def test_a_process_ends_with_its_status_and_is_not_taken_apart(tmp_path):
    """Who asked to be told of the end is told; Python's clearing up takes longer than a small program."""
    program = tmp_path / "p.src"
    program.write_text("x = = 1\n")
    code = (
        "import atexit, sys\n"
        "from desire_tui.__main__ import main\n"
        "class Kept:\n  def __del__(self): print('taken apart')\n"
        "kept = Kept()\n"
        f"sys.argv = ['desire', 'check', {str(program)!r}]\n"
        "start = sys.modules['desire_tui.__main__']._QuickEnd.__init__\n"
        "def then_tell(self): start(self); atexit.register(print, 'told')\n"
        "sys.modules['desire_tui.__main__']._QuickEnd.__init__ = then_tell\n"
        "main()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (1, "told\n")
    assert "p.src:1" in done.stderr


def test_the_quick_way_into_the_desktop_knows_all_commands():
    """`desire FILE` does without the command line's library; a file must not be taken for a command."""
    from desire_tui import __main__, cli

    assert set(cli.main.commands) == __main__.COMMANDS


def test_quantities_too_many_for_a_json_file_are_refused(tmp_path):
    """An array takes hardly any memory until it is used, its text does."""
    from desire_tui.engine.values import Values

    path = tmp_path / "p.src"
    path.write_text(f"ARRAY A[{Values().spare // 4}]\n")
    status, _, err = desire_process("run", path, "--json", tmp_path / "p.json")
    assert status == 1
    assert "error 40: no room for" in err
    assert not (tmp_path / "p.json").exists()


def on_terminal(*args, env=None):
    """Run the command with a terminal for its output; returns status and what the terminal gets."""
    master, slave = os.openpty()
    done = subprocess.Popen(
        [sys.executable, "-m", "desire_tui", *map(str, args)], stdout=slave, stderr=slave, stdin=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": str(ROOT), **(env or {})},
    )  # fmt: skip
    os.close(slave)
    shown = b""
    while True:
        try:
            piece = os.read(master, 65536)
        except OSError as error:
            if error.errno != errno.EIO:  # Linux: the other side is closed
                raise
            break
        if not piece:
            break
        shown += piece
    os.close(master)
    return done.wait(300), shown.decode()


@pytest.mark.parametrize("kind", ["png", "svg", "pdf", "npz"])
def test_what_no_terminal_shows_is_not_sent_to_one(decay, kind):
    status, shown = on_terminal("run", decay, f"--{kind}", "-")
    assert status == 2
    assert f"--{kind} - is nothing that a terminal shows" in shown
    assert "done" not in shown  # nothing ran


def test_wrong_words_of_the_command_line_are_shown_and_not_obeyed():
    hostile = "\x1b]52;c;aGk=\x07\x1b[2J\u202e"
    for words in (
        ("run", "x", f"--nonsense{hostile}"), ("run", "x", "--set", hostile), ("run", "x", "y", "--csv", hostile),
        ("run", "x", "--backend", hostile), ("config", hostile),
    ):  # fmt: skip
        status, shown = on_terminal(*words)
        assert status == 2, words
        assert "\x1b" not in shown
        assert "\u202e" not in shown
        assert "␛" in shown or r"\x1b" in shown  # of click itself


def test_a_relative_cache_path_is_told(decay, tmp_path):
    status, shown = on_terminal("run", decay, "--quiet", env={"XDG_CACHE_HOME": "cache\x1b[2J"})
    assert status == 0
    assert shown.startswith("warning: XDG_CACHE_HOME=cache␛[2J is no absolute path: ~/.cache is used")
