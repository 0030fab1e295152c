"""A program from standard input has no folder of its own: every file is asked for, so refused."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest


@pytest.mark.parametrize(("flags", "status"), [([], 1), (["--allow-write"], 0)])
def test_files_of_a_program_from_a_pipe(tmp_path, flags, status):
    done = subprocess.run(
        [sys.executable, "-m", "desire_tui", "run", *flags, "-"], cwd=tmp_path, check=False, capture_output=True,
        input="connect 'out' as output 2\nwrite #2, 1\n", text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )  # fmt: skip
    assert done.returncode == status
    assert (tmp_path / "out.dat").exists() == (not status)
    assert ("error 451" in done.stderr) == bool(status)
