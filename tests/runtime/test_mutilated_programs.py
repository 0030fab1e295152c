"""Programs with tokens and lines lost, doubled, exchanged run or fail with a message: never a Python error."""

from __future__ import annotations

import re
from pathlib import Path
from random import Random
from threading import Timer

import pytest

from desire_tui.engine.diagnostics import DesireError, Diagnostic, render_all
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

TEXTS = [path.read_text("utf-8") for path in sorted((Path(__file__).parents[1] / "programs").glob("*/*.src"))]
TOKENS = re.compile(r"[A-Za-z_$]\w*|[0-9.]+(?:[eE][+-]?\d+)?|\s+|.", re.DOTALL)
ODD = """1e308 -1e308 1e-320 0 -1 99999999999 &&FFFF é – 𝒳 \u2028 ' " [ ] ( ) { } | -- _ \r $ % # then else proceed end
STOP DYNAMIC OUT step drun reset clear exit NN=1e9 NN=-5 TMAX=-1 TMAX=1e308 DT=0 DT=1e-300 irule=9 ERMAX=0 scale=0 MM=-3
CHECKN=9 ran() ARRAY invoke JACOBIAN repeat next""".split(" ")  # noqa: SIM905
SAFETY_SECONDS = 3.0
"""What loops for ever is ended; the test does not ask how."""


def mutilated(text: str, random: Random) -> str:
    """Change one to four things."""
    for _ in range(random.randint(1, 4)):
        pieces = TOKENS.findall(text) if random.random() < 0.5 else text.splitlines(keepends=True)
        place = random.randrange(len(pieces)) if pieces else 0
        match random.randrange(4):
            case 0:
                del pieces[place : place + 1]
            case 1:
                pieces.insert(place, random.choice(pieces or ODD))
            case 2:
                pieces[place : place + 1] = [random.choice(ODD)]
            case _:
                pieces.insert(place, f"{random.choice(ODD)}{random.choice(['', ' ', chr(10)])}")
        text = "".join(pieces)
    return text


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("seed", range(12))
def test_mutilated_programs_fail_with_messages(seed: int, backend, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    random = Random(seed)
    for _ in range(5):
        text = mutilated(random.choice(TEXTS), random)
        session = Session(backend=backend)
        net = Timer(SAFETY_SECONDS, session.end)
        net.start()
        problems: tuple[Diagnostic, ...] = ()
        try:
            session.erun(Source(text, "mutilated.src"))
        except DesireError as error:
            problems = error.diagnostics
        except EOFError:
            pass  # it asked for input, and nobody answers
        finally:
            net.cancel()
        assert all(problem.code > 0 for problem in problems), text
        assert "Traceback" not in render_all(problems)
