"""Command lines to a session with a program in it: each is carried out or answered with a message."""

from __future__ import annotations

from pathlib import Path
from threading import Timer
from typing import TYPE_CHECKING

from desire_tui.engine.diagnostics import DesireError, render_all
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.permissions import Permissions
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.fuzz.corpus import PIECES, programs
from tests.fuzz.mutations import mutated

if TYPE_CHECKING:
    from random import Random

SECONDS = 1.0
COMMANDS = (
    """write x|write 2*x, y; 'a'|x = 3|x = x + 1|drun|drunr|run|go|zz|list|list+|dump run|dump|dump all|help drun
help 27|help|snapshot g.png|snapshot g|notebook on|notebook off|notebook n.md|compare a 1, 2, 3|compare irule 1, 3|compare
keep k.src|keep|load k.src|load|new|NEW|reset|clear|irule 3|irule 99|DT = 0|TMAX = 1|NN = 5|NN = 1e9|t = 1e15|reload|ed|bye
sh echo a|trace|time|SEED 1|write #7, x|connect 'd.dat' as output 2|write #2, 1|disconnect 2|connect 'd.dat' as input 2
input #2, x|input x|read x|restore|STATE q[3]|ARRAY A[2,2]|A[1,1] = 5|write A[3,3]|for i = 1 to 3 / write i / next|go to L
label L|call p|plot x, y|SHOW A|display N 12|FFT F, 4, a, b|MATRIX B = A*A|Vector v = v*2|irule|STOP|exit|next|end
scale = 2|if x > 1 then write 'big' else proceed|while x < 5 / x = x + 1 / end while|write 1/0|PI = 3""".replace(
        " / ", "\1"
    )
    .replace("|", "\n")
    .replace("\1", " | ")
    .splitlines()
)


def generate(rng: Random) -> list[str]:
    """Return a program and the command lines that follow it."""
    text = rng.choice(programs())
    lines = [text if rng.random() < 0.7 else mutated(text, rng)]
    for _ in range(rng.randint(1, 9)):
        kind = rng.random()
        line = rng.choice(COMMANDS)
        if kind < 0.3:
            line = mutated(line, rng, 2)
        elif kind < 0.4:
            line = " ".join(rng.choices(PIECES, k=rng.randint(1, 5)))
        elif kind < 0.55:
            line = rng.choice(text.splitlines() or [""])
        lines.append(line)
    return lines


class _Silent(Listener):
    def ask(self, prompt: str) -> str:
        del prompt
        raise EOFError


def check(lines: list[str]) -> None:
    """Accept the program, run it, carry out the lines one by one."""
    session = Session(_Silent(), folder=Path.cwd(), permissions=Permissions(shell=False, files=False))
    for number, line in enumerate(lines):
        net = Timer(SECONDS, session.end)
        net.start()
        try:
            if number == 0:
                session.erun(Source(line, "program.src"))
            else:
                session.evaluate_while_running(line)
                session.execute(line)
        except DesireError as error:
            _well_formed(error)
        except EOFError:
            pass  # it asked, and nobody answers
        finally:
            net.cancel()


def _well_formed(error: DesireError) -> None:
    assert all(problem.code > 0 for problem in error.diagnostics)
    assert "Traceback" not in render_all(error.diagnostics)
