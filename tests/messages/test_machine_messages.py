"""Messages about the machine rather than the program: no memory, broken files, a shell, what CVODE gives up with."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import IO

import pytest

from desire_tui.engine.check.checker import check
from desire_tui.engine.diagnostics import DesireError, Diagnostic, render
from desire_tui.engine.interpreter import channels
from desire_tui.engine.interpreter.interpreter import Interpreter
from desire_tui.engine.lowering import submodels
from desire_tui.engine.runtime.run_faults import fault
from desire_tui.engine.runtime.run_memory import Ended
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.permissions import Permissions
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse


def problem_of(session: Session, *lines: str) -> Diagnostic:
    """Run a program of these lines; return the one problem that ends it."""
    with pytest.raises(DesireError) as caught:
        session.erun(Source("\n".join(lines), "program.src"))
    (problem,) = caught.value.diagnostics
    return problem


def test_no_room_for_an_array() -> None:
    """A COMPLEX number takes two cells: the array has fewer elements than there is room, and does not fit."""
    session = Session(Listener())
    problem = problem_of(session, "x = 1", f"COMPLEX z[{session.values.capacity - 1}]")
    assert problem.key == "out-of-memory"
    assert render(problem).startswith("program.src:2:1: error 40: no room for ")


def test_an_array_beyond_the_machine() -> None:
    problem = problem_of(Session(Listener()), "x = 1", "ARRAY A[1.0E+15]")
    assert problem.key == "array-too-large"
    assert "2:7: error 40: no room for 1000000000000000 elements of 'A'" in render(problem)


def test_memory_that_ends_in_the_middle(monkeypatch) -> None:
    def no_memory(_: Interpreter) -> None:
        raise MemoryError

    monkeypatch.setattr(Interpreter, "run", no_memory)
    problem = problem_of(Session(Listener()), "x = 1")
    assert problem.key == "memory-exhausted"
    assert render(problem) == (
        "program.src: error 40: the machine's memory is full\n"
        "hint: smaller arrays, fewer samples (NN, MM), or fewer runs"
    )


@pytest.mark.parametrize("last", ["disconnect 2", "TMAX = 1 | drun\nDYNAMIC\nd/dt x = 1"])
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_channel_whose_disk_is_full(tmp_path, last, monkeypatch) -> None:
    def full(*_: object) -> IO[str]:
        return Path("/dev/full").open("w", encoding="utf-8")

    monkeypatch.setattr(channels, "open_for_program", full)
    session = Session(Listener(), folder=tmp_path, permissions=Permissions(files=True))
    problem = problem_of(session, "connect 'full' as output 2", "write ##2, 1", last)
    assert problem.key == "cannot-write"
    assert problem.span is not None
    assert "full.dat': No space left on device" in render(problem)


@pytest.mark.skipif(not Path("/proc/self/mem").exists(), reason="needs a file that opens and cannot be read")
def test_a_channel_that_cannot_be_read(tmp_path) -> None:
    (tmp_path / "broken.dat").symlink_to("/proc/self/mem")
    session = Session(Listener(), folder=tmp_path, permissions=Permissions(files=True))
    problem = problem_of(session, "connect 'broken' as input 2", "input #2, x")
    assert problem.key == "cannot-read"
    assert render(problem).startswith("program.src:2:1: error 18: cannot read '/proc/")


def test_a_shell_command_that_fails_prints_its_status_and_the_program_goes_on(tmp_path, monkeypatch) -> None:
    shown: list[str] = []
    listener = Listener()
    monkeypatch.setattr(listener, "console_text", shown.append)
    session = Session(listener, folder=tmp_path, permissions=Permissions(shell=True))
    session.erun(Source("sh exit 3\nwrite 'on' | sh true", "program.src"))
    assert "".join(shown) == "the shell command `exit 3` ended with status 3\non\n"


def test_a_help_page_that_is_not_there() -> None:
    with pytest.raises(DesireError) as caught:
        Session(Listener()).help("nothing at all")
    assert caught.value.diagnostics[0].key == "no-help"
    assert caught.value.diagnostics[0].code == 403


@pytest.mark.parametrize("command", ["run", "zz", "list"])
def test_no_program(command) -> None:
    with pytest.raises(DesireError) as caught:
        Session(Listener()).execute(command)
    (problem,) = caught.value.diagnostics
    assert (problem.key, problem.code) == ("no-program", 215)


def test_submodels_that_become_too_many_lines(monkeypatch) -> None:
    """Each of 8 submodels invokes the one before twice: 256 lines."""
    monkeypatch.setattr(submodels, "LINES_MOST", 100)
    text = "SUBMODEL s0(x$)\nx$ = x$ + 1\nend\n" + "".join(
        f"SUBMODEL s{k}(x$)\ninvoke s{k - 1}(x$)\ninvoke s{k - 1}(x$)\nend\n" for k in range(1, 9)
    )
    text += "x = 0 | NN = 3\ndrun\nDYNAMIC\ninvoke s8(x)\ndispt x"
    (problem,) = check(parse(Source(text, "program.src")))
    assert (problem.key, problem.code) == ("too-many-lines", 411)
    assert problem.span == (text.index("invoke s8"), text.index("\ndispt"))


FLAGS = {
    -1: "solver-gave-up", -2: "solver-too-accurate", -3: "solver-error-test", -4: "solver-corrector",
    -5: "solver-linear", -6: "solver-singular", -7: "solver-linear", -8: "solver-derivative",
    -9: "solver-derivative", -10: "solver-derivative", -15: "solver-corrector", -27: "solver-too-close",
    -21: "solver-broken",
}  # fmt: skip
"""Return flags as CVODE's documentation lists them (cvode.h: CV_TOO_MUCH_WORK and so on)."""


@pytest.mark.parametrize(("flag", "key"), FLAGS.items())
def test_what_the_stiff_solver_gives_up_with(flag: int, key: str) -> None:
    session = Session(Listener())
    source = Source("TMAX = 1 | NN = 3 | DT = 0.25\ndrun\nDYNAMIC\nd/dt x = -x\nd/dt y = x", "program.src")
    session.erun(source)
    program = session.program
    assert program is not None
    from desire_tui.engine.lowering.lowering import lower

    segment = lower(program, None, session.values)
    plan, memory = SimpleNamespace(rule=15, error_max=1e-6), SimpleNamespace(which=flag, suspect=1)
    (problem,) = fault(Ended.SOLVER, segment, plan, memory, session.values).diagnostics
    assert problem.key == key
    assert problem.span == (source.text.index("d/dt y"), len(source.text))
    shown = render(problem)
    assert "t = 1 with DT = 0.25, state 'y'" in shown
    assert (f"flag {flag}" in shown) == (key == "solver-broken")
