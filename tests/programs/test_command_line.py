"""`python -m tests.programs FILE…`: its status says whether every program shows what its comments say."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
GOOD = "x = 1\n--? x = 1\n"


@pytest.mark.parametrize(
    ("text", "status"),
    [
        (GOOD, 0),
        ("x = 1\n--? x = 2\n", 1),
        ("x = nothing\n--? x = 1\n", 1),
        ("x = 1\n--? error 200 at 1\n", 1),
        ("write 1\n--? prints '2'\n", 1),
    ],
)
def test_status(text, status, tmp_path):
    (tmp_path / "good.src").write_text(GOOD, encoding="utf-8")
    (tmp_path / "other.src").write_text(text, encoding="utf-8")
    names = [str(tmp_path / "other.src"), str(tmp_path / "good.src")]
    done = subprocess.run(
        [sys.executable, "-m", "tests.programs", *names],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == status, done.stdout + done.stderr
