"""What is prepared for a run (text, segment, machine code) never keeps `end` waiting. Nothing here waits for a clock."""

from __future__ import annotations

import subprocess
import sys
import threading

import pytest

from desire_tui.engine import exclusive_work
from desire_tui.engine.cancellation import cancellable
from desire_tui.engine.codegen.compiler_state import CompilerState
from desire_tui.engine.codegen.jit import compiler, llvm_turn
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

PATIENCE = 120.0
PROGRAM = "TMAX = 1 | DT = 0.1 | NN = 11 | x = 1\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"
EQUATIONS = "\n".join(f"d/dt y{k} = {k}*x - y{k}" for k in range(300))


class Held:
    """LLVM, at work until it is released."""

    def __init__(self, monkeypatch):
        self.begun, self.released, self.compiled = threading.Event(), threading.Event(), 0
        translate = compiler._object_file

        def held(*args, **how):
            self.begun.set()
            assert self.released.wait(PATIENCE)
            self.compiled += 1
            return translate(*args, **how)

        monkeypatch.setattr(compiler, "_object_file", held)


@pytest.fixture
def held(monkeypatch):
    monkeypatch.setattr(llvm_turn, "LONG_TEXT", 0)
    llvm_turn.wait(PATIENCE)
    made = Held(monkeypatch)
    yield made
    made.released.set()
    llvm_turn.wait(PATIENCE)


@pytest.fixture
def session():
    state = CompilerState()
    yield Session(compiler=state)
    state.close()


def in_a_thread(session, text):
    """Run a program in a thread; the list gets the numbers of its errors."""
    codes: list[list[int]] = []

    def work():
        try:
            session.erun(Source(text))
            codes.append([])
        except DesireError as error:
            codes.append([d.code for d in error.diagnostics])

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    return thread, codes


def test_a_run_ends_while_llvm_compiles_on(session, held):
    thread, codes = in_a_thread(session, PROGRAM)
    assert held.begun.wait(PATIENCE)
    session.end()
    thread.join(PATIENCE)
    assert codes == [[301]]
    assert not held.released.is_set()
    # another run waits for its turn, and can be ended too
    thread, codes = in_a_thread(session, PROGRAM.replace("-x", "-2*x"))
    while thread.is_alive() and not codes:
        session.end()
        thread.join(0.01)
    assert codes == [[301]]
    held.released.set()
    session.erun(Source(PROGRAM))
    assert session.runs[-1].count == 11


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("rule", [1, 3, 14])
def test_preparation_is_broken_off_anywhere_and_leaves_all_well(backend, rule, session, monkeypatch):
    """A program of 300 equations, left at one cancellation point after the other."""

    monkeypatch.setattr(
        exclusive_work, "LOOK_SECONDS", PATIENCE
    )  # waiting passes points, too, and is not counted

    class Left(Exception):
        pass

    session = Session(backend=backend, compiler=session._workspace.segments._compiler)
    text = f"irule {rule} | ERMAX = 0.001 | {PROGRAM}{EQUATIONS}\n"

    def prepare(points, changed):
        """Prepare a program of its own for a run; return how many more points it might have passed."""

        def leave():
            nonlocal points
            points -= 1
            if points < 0:
                raise Left

        with cancellable(leave):
            session.accept(Source(text.replace("*x - y", f"*x - {changed}*y")))
            workspace = session._workspace
            session.values.clear()
            segment = workspace.segments.lowered(workspace.program, workspace.structure, None, rule)
            workspace.segments.model(segment, rule)
        return points

    enough = 10**6
    prepare(enough, 1)  # makes what is made once
    points = enough - prepare(enough, 2)
    assert points > 80  # though lines that are alike are read and lowered by the hundred
    for number, after in enumerate(range(0, points * 9 // 10, points // 20), 3):
        with pytest.raises(Left):
            prepare(after, number)
    session.erun(Source(text))
    assert session.runs[-1].count == 11


def test_an_end_while_the_text_is_read_is_heard(session, monkeypatch):
    from desire_tui.engine.syntax import parsed_lines

    scan = parsed_lines.scan

    def ending(line):
        session.end()
        return scan(line)

    monkeypatch.setattr(parsed_lines, "scan", ending)
    with pytest.raises(DesireError) as caught:
        session.erun(Source("zz9 = 1\nwrite zz9\n"))
    assert [d.code for d in caught.value.diagnostics] == [301]


def test_a_process_ends_while_llvm_compiles(tmp_path):
    """At once, with its status: neither the background's work nor an abandoned compilation is waited for."""
    program = tmp_path / "p.src"
    program.write_text(PROGRAM)
    code = (
        "import threading\n"
        "from desire_tui.__main__ import main\n"
        "from desire_tui.engine.codegen.jit import compiler\n"
        "begun = threading.Event()\n"
        "def endless(*_, **__): begun.set(); threading.Event().wait()\n"
        "compiler._object_file = endless\n"
        "compiling = threading.Thread(target=compiler.compile_text, args=('',), kwargs={'level': 0}, daemon=True)\n"
        "compiling.start()\n"
        "begun.wait()\n"
        f"main(['check', {str(program)!r}])\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=PATIENCE
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
