"""What all tests share: folders of their own, rare garbage collections, and hypothesis without deadlines or chance.

`HYPOTHESIS_PROFILE=search pytest …` looks for new examples, and more of them where a test names no number.
"""

from __future__ import annotations

import gc
import os
import signal
import tempfile
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings
from hypothesis.internal.conjecture import providers

from .one_report import OneReport

if TYPE_CHECKING:
    from collections.abc import Generator

TAKEN_BY_DESKTOPS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

os.environ["XDG_STATE_HOME"] = tempfile.mkdtemp(
    prefix="desire-tests-"
)  # the user's own record is not for tests
# else a second thread of each process that imports NumPy waits busily: a quarter of what short processes took
os.environ["OPENBLAS_NUM_THREADS"] = "1"
if "PYTEST_XDIST_WORKER" not in os.environ:  # parse tables and native code are made once for all processes
    os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(prefix="desire-tests-cache-")


def pytest_configure(config: pytest.Config) -> None:
    """Make the parse tables before there are processes that would all make them at the same time."""
    # what is collected stays, and a desktop is 50,000 objects that stay until its test ends: looked through while
    # they are there, they are for nothing
    gc.set_threshold(200_000, 5, 5)
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # started in the background: programs inherit that
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if config.getoption("numprocesses", None) and "PYTEST_XDIST_WORKER" not in os.environ:
        from desire_tui.engine.source import Source
        from desire_tui.engine.syntax.parse import parse

        parse(Source("x = 1"))
    if "PYTEST_XDIST_WORKER" in os.environ and config.getoption("durations", None) is None:
        config.pluginmanager.register(OneReport())


def pytest_sessionstart(session: pytest.Session) -> None:
    """Import the test modules in another order in each worker, before all workers collect all of them in the same.

    To rewrite a module's assertions takes longer than all else that is done with it, and its result is stored: in a
    fresh clone each worker would do it for every module. Who is through with a share of his own helps the slower.
    """
    config = session.config
    if config.args_source is not pytest.Config.ArgsSource.TESTPATHS or not hasattr(config, "workerinput"):
        return
    worker, workers = (
        int(config.workerinput["workerid"].removeprefix("gw")),
        config.workerinput["workercount"],
    )
    modules = sorted((config.rootpath / "tests").rglob("test_*.py"))
    own = modules[worker::workers]
    for path in own + [path for path in reversed(modules) if path not in own]:
        with suppress(Exception, pytest.skip.Exception):  # the collection tells of it
            import_module(".".join(path.relative_to(config.rootpath).with_suffix("").parts))


def pytest_collection_finish() -> None:
    """Leave all imports and 7,500 tests out of garbage collections, as the desktop does with its own imports."""
    gc.collect()
    gc.freeze()


def pytest_sessionfinish() -> None:
    """Look for unreachable objects once; pytest does so five times more among all that this process ever made.

    On a busy machine that took longer than the 5 s after which xdist interrupts a worker.
    """
    gc.collect()
    gc.freeze()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol() -> Generator[None, object, object]:
    """Put back what a test leaves changed in the process, so that no other test depends on its having run.

    Textual's pictures set COLUMNS and LINES; a desktop in this process takes signals and keeps them.
    """
    environment, folder = dict(os.environb), Path.cwd()  # as bytes: nothing is decoded 10,000 times
    handlers = {number: signal.getsignal(number) for number in TAKEN_BY_DESKTOPS}
    result = yield
    if dict(os.environb) != environment:
        os.environb.clear()
        os.environb.update(environment)
    os.chdir(folder)
    for number, handler in handlers.items():
        signal.signal(number, handler)
    return result


@pytest.fixture
def quick_code_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """For runs that are over before fast code comes: none is made that nobody runs."""
    from desire_tui.engine.codegen.jit.background import Improver

    monkeypatch.setattr(Improver, "add", lambda _self, _work: None)


settings.register_profile("repeatable", deadline=None, derandomize=True, database=None)
settings.register_profile("search", deadline=None, max_examples=1000)
_PROFILE = os.environ.get("HYPOTHESIS_PROFILE", "repeatable")
settings.load_profile(_PROFILE)
if _PROFILE == "repeatable":
    # else the examples depend on the modules that happen to be imported, whose numbers and strings are drawn now and
    # then; to read them takes each worker 2 s in a fresh clone. There is no public switch for it.
    providers._get_local_constants = lambda: providers._local_constants
