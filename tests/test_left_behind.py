"""What a test changes in the process does not reach the next one (the hook in conftest.py)."""

from __future__ import annotations

import os
import signal
from contextlib import suppress
from pathlib import Path

from tests.conftest import pytest_runtest_protocol


def test_environment_folder_and_signals_are_put_back(tmp_path):
    before, folder, handler = dict(os.environ), Path.cwd(), signal.getsignal(signal.SIGTERM)
    around = pytest_runtest_protocol()
    next(around)
    os.environ["COLUMNS"] = "33"
    del os.environ["PATH"]
    os.chdir(tmp_path)
    signal.signal(signal.SIGTERM, lambda *_: None)
    with suppress(StopIteration):
        around.send(None)
    assert dict(os.environ) == before
    assert Path.cwd() == folder
    assert signal.getsignal(signal.SIGTERM) is handler
