"""Large models on several threads: the same bits as on one thread, and as before loops were shared."""

from __future__ import annotations

import os
import threading
import time

import numpy as np
import pytest

from desire_tui.engine import thread_count
from desire_tui.engine.codegen.ir import shared_loops
from desire_tui.engine.codegen.jit.background import Improver
from desire_tui.engine.codegen.loop.state_blocks import state_blocks
from desire_tui.engine.codegen.threads.pool import ThreadPool, thread_pool
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.codegen.conftest import improve

N = 2 * shared_loops.BLOCK + 77
HEAD = (
    "n = {n} | m = 67 | l = 131 | STATE x[n], v[n] | ARRAY w[n], g[n], p[l], q[m] | ARRAY A[m,l]\n"
    "for i = 1 to n | x[i] = sin(i) | w[i] = 0.3 + 0.0002*i | next\n"
    "for i = 1 to m | for j = 1 to l | A[i,j] = cos(i*j) | next | next\n"
    "irule {rule} | DT = 0.01 | TMAX = 0.04 | NN = 3 | SEED 3\ndrun\nDYNAMIC\n"
)
MODELS = {
    "neighbours": "Vectr d/dt x = x{1} - 2*x + x{-3}\nVectr d/dt v = -w*v\n",
    "replicas": "Vector g = sin(x)\nVectr d/dt x = v*g\nVectr d/dt v = -w*g - 0.1*v\n",
    "in place": "Vectr d/dt x = v\nVectr d/dt v = -w*x\nOUT\nVector w = w{-2} + 0.1*w\nVectr delta g = x*w - x{-1}\n",
    "products": "Vector q = tanh(A*p)\nVector p = A%*q + 1\nDELTA A = 0.01*(q*p); -1, 1\nVectr d/dt x = v\nVectr d/dt v = -w*x\n",
    "delays": "q1 = x[5]*v[7] + t\nVectr d/dt x = v + delay(q1, 0.01)*w\nVectr d/dt v = -w*x\n",
    "draws": "Vectr d/dt x = v + ran()\nVectr d/dt v = -w*x\n",
}


@pytest.fixture
def pool():
    """Give the process's pool, and put its size back."""
    found = thread_pool()
    yield found
    found.resize(thread_count.thread_count())


def arrays(text: str) -> list[bytes]:
    """Return the bits of all arrays behind a run."""
    session = Session()
    session.erun(Source(text))
    return [np.array(session.values.view(q)).tobytes() for q in session.values if q.shape]


@pytest.mark.parametrize(
    ("name", "rule"), [*((name, 3) for name in MODELS), ("neighbours", 4), ("neighbours", 8)]
)
def test_bits_do_not_depend_on_threads(name, rule, pool, monkeypatch):
    monkeypatch.setattr(Improver, "add", lambda _, model: improve(model))
    text = HEAD.format(n=N, rule=rule) + MODELS[name]
    if rule != 3:
        text = text.replace("DT = 0.01 | TMAX = 0.04", "DT = 0.1 | TMAX = 0.3 | ERMAX = 1E-6")
    alone = arrays(text)
    monkeypatch.setattr(shared_loops, "LEAST", 1)
    for members in (1, 3):
        pool.resize(members)
        assert arrays(text) == alone


def test_sums_do_not_depend_on_threads(pool, monkeypatch):
    monkeypatch.setattr(shared_loops, "LEAST", 1)
    text = (
        HEAD.format(n=N, rule=1)
        + "Vectr d/dt x = v\nVectr d/dt v = -w*x\nDOT s = x*w\nAVG a = v*1\ndispt s, a\n"
    )
    found = []
    for members in (1, 3):
        pool.resize(members)
        session = Session()
        session.erun(Source(text))
        x, w, v = (session.values.view(session.values.find(name)) for name in "xwv")
        assert session.values.cells[session.values.find("s").slot] == pytest.approx(float(x @ w), rel=1e-12)
        assert session.values.cells[session.values.find("a").slot] == pytest.approx(
            float(v.mean()), rel=1e-10
        )
        found.append(session.runs[-1].rows[: session.runs[-1].count].tobytes())
    assert found[0] == found[1]


def test_each_thread_meets_the_same_elements_of_all_vectors():
    n = 10 * shared_loops.BLOCK + 5
    blocks = state_blocks([(100, 0, n), (100_000, n, n)])
    assert sorted(blocks[:, 3]) == list(range(22))
    halves = [set(blocks[:11, 3] % 11), set(blocks[11:, 3] % 11)]
    assert halves[0] & halves[1] == {5}
    numbers = np.concatenate([np.arange(first, end) for first, end, _, _ in blocks[np.argsort(blocks[:, 3])]])
    assert (numbers == np.arange(2 * n)).all()
    assert state_blocks([(100, 0, 1000), (2000, 1000, 70_000)])[0, 1] == 1000
    assert state_blocks([(i * 8, i, 1) for i in range(70_000)]) is None
    assert len(state_blocks([(i, i, 1) for i in range(70_000)])) == shared_loops.blocks(70_000)
    assert state_blocks([(0, 0, 1000)] * 65 + [(0, 0, 2000)] * 3) is None


def test_two_runs_at_once(pool, monkeypatch):
    monkeypatch.setattr(shared_loops, "LEAST", 1)
    pool.resize(3)
    text = HEAD.format(n=N, rule=3).replace("TMAX = 0.04", "TMAX = 0.5") + MODELS["neighbours"]
    found: list[list[bytes]] = []
    runs = [threading.Thread(target=lambda: found.append(arrays(text))) for _ in range(2)]
    for run in runs:
        run.start()
    for run in runs:
        run.join()
    assert found[0] == found[1]


def test_threads_sleep_between_loops(pool):
    if not hasattr(time, "pthread_getcpuclockid"):
        pytest.skip("the processor time of a thread cannot be asked for here")
    pool.resize(3)
    clocks = [time.pthread_getcpuclockid(thread.ident) for thread in pool._threads]
    for _ in range(300):  # on a busy machine they come to it later
        before = [time.clock_gettime(clock) for clock in clocks]
        time.sleep(0.1)
        if [time.clock_gettime(clock) for clock in clocks] == before:
            return
    pytest.fail("threads without work take processor time")


def test_a_child_process_goes_on_alone(pool, monkeypatch):
    monkeypatch.setattr(shared_loops, "LEAST", 1)
    pool.resize(2)
    wanted = arrays(HEAD.format(n=N, rule=3) + MODELS["neighbours"])
    child = os.fork()
    if child == 0:
        os._exit(0 if arrays(HEAD.format(n=N, rule=3) + MODELS["neighbours"]) == wanted else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_runs_at_once_share_the_threads(pool, monkeypatch):
    monkeypatch.setattr(thread_count, "_configured", lambda: 6)
    with thread_count.runs_at_once(2):
        assert thread_count.thread_count() == pool.members == 3
        with thread_count.runs_at_once(4):
            assert thread_count.thread_count() == pool.members == 1
        assert pool.members == 3
    assert thread_count.thread_count() == pool.members == 6


def test_the_pool_changes_between_loops(pool, monkeypatch):
    monkeypatch.setattr(shared_loops, "LEAST", 1)
    text = HEAD.format(n=N, rule=3).replace("TMAX = 0.04", "TMAX = 1") + MODELS["neighbours"]
    alone = arrays(text)
    found: list[list[bytes]] = []
    run = threading.Thread(target=lambda: found.append(arrays(text)))
    run.start()
    members = 1
    while run.is_alive():
        members = 4 - members
        pool.resize(members)
    assert found[0] == alone


def test_threads_end_with_the_pool():
    pool = ThreadPool(4)
    names = {f"desire loop {member}" for member in range(1, 4)}
    assert names <= {thread.name for thread in threading.enumerate()}
    mine = list(pool._threads)
    pool.close()
    assert not any(thread.is_alive() for thread in mine)


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("threads = 3", 3),
        ("threads = 0", None),
        ("threads = -1", None),
        ("threads = true", None),
        ("[", None),
    ],
)
def test_the_configuration_sets_their_number(text, count, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.setattr(thread_count.user_folders, "folder", lambda _kind: str(tmp_path))
    (tmp_path / "config.toml").write_text(text)
    assert thread_count.thread_count() == (count or thread_count.cores())
