"""A process that is told to end while it writes a file leaves no part of it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
WRITER = """
import os, sys
from desire_tui.batch.ending import giving_up_files
from desire_tui.engine.atomic_file import replacing
with giving_up_files(), replacing("r.csv") as file:
    file.write("half")
    file.flush()
    os.kill(os.getpid(), int(sys.argv[1]))
"""


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_file_that_is_being_written_is_given_up(tmp_path, number):
    (tmp_path / "r.csv").write_text("old")
    command = [sys.executable, "-c", WRITER, str(int(number))]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    ended = subprocess.run(command, cwd=tmp_path, stderr=subprocess.PIPE, check=False, env=environment)
    assert (ended.returncode, ended.stderr) == (-number, b"")
    assert [path.name for path in tmp_path.iterdir()] == ["r.csv"]
    assert (tmp_path / "r.csv").read_text() == "old"
