"""Long single statements can be broken off: nothing here waits for a clock."""

from __future__ import annotations

import subprocess
import sys
from threading import Event

import numpy as np
import pytest

from desire_tui.engine.interpreter import array_expressions, interruptible
from desire_tui.engine.interpreter.host import Interrupted
from desire_tui.engine.interpreter.interruptible import LONG_WORK, run_interruptibly
from tests.interpreter.stand_in import RecordingHost, run


class Enough(Exception):
    pass


def stop() -> None:
    raise Enough


def go_on() -> None:
    return


def test_what_is_broken_off_is_waited_for_by_the_next() -> None:
    release, order = Event(), []

    def endless() -> None:
        release.wait()
        order.append("first")

    with pytest.raises(Enough):
        run_interruptibly(LONG_WORK, endless, stop)
    looks: list[None] = []

    def look() -> None:
        looks.append(None)
        if len(looks) == 2:  # it is waiting for its turn
            assert order == []
            release.set()

    def second() -> int:
        order.append("second")
        return 7

    assert run_interruptibly(LONG_WORK, second, look) == 7
    assert order == ["first", "second"]
    assert len(looks) >= 2


def test_errors_come_back_to_the_statement() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        run_interruptibly(LONG_WORK, lambda: np.linalg.inv(np.zeros((2, 2))), go_on)
    assert run_interruptibly(LONG_WORK, lambda: 1, go_on) == 1, "the next one gets its turn"


def test_short_work_is_done_on_the_spot() -> None:
    assert run_interruptibly(LONG_WORK - 1, lambda: 3, stop) == 3


SCRIPTS = [
    "ARRAY A[400,400]\nMATRIX A = 1\nMATRIX A = $In(A)",
    "ARRAY A[400,400]\nMATRIX A = 1\nMATRIX A = A*A",
    "ARRAY x[1048576], y[1048576]\nFFT F, 1048576, x, y",
]


@pytest.mark.parametrize("script", SCRIPTS, ids=["inverse", "product", "fft"])
def test_one_long_operation_can_be_broken_off(script, monkeypatch) -> None:
    """The operation itself never ends here, as a larger one would not for minutes."""
    never = Event()
    for module, name in ((np.linalg, "inv"), (np.fft, "fft")):
        monkeypatch.setattr(module, name, lambda *_: never.wait())
    if "A*A" in script:
        real = interruptible.run_interruptibly
        monkeypatch.setattr(
            array_expressions, "run_interruptibly", lambda work, _, check: real(work, never.wait, check)
        )
    host = RecordingHost()
    host.looks_allowed = 3
    try:
        with pytest.raises(Interrupted):
            host.run(script)
    finally:
        never.set()


@pytest.mark.parametrize(
    "statement",
    [
        "Vector v = sin(v)",
        "Vector v = v^0.5",
        "Vector v = f(v)",
        "MATRIX A = exp(A)",
        "Vector v = v" + "+2*v" * 50,
    ],
)
def test_functions_of_many_elements_look_around(statement) -> None:
    host = RecordingHost()
    host.looks_allowed = 2
    with pytest.raises(Interrupted):
        host.run(f"FUNCTION f(a) = a + 1\nARRAY v[100000], A[1000,100]\n{statement}")


def test_large_results_are_those_of_small_pieces() -> None:
    values = run(
        "FUNCTION f(a) = a^2 + 1\nARRAY v[25000], s[25000], g[25000], p[25000]\nfor i = 1 to 25000 | v[i] = i/1000 | next\n"
        "Vector s = sin(v) | Vector g = f(v) | Vector p = v^1.5"
    ).values
    v = np.arange(1, 25001) / 1000
    for name, exact in (("s", np.sin(v)), ("g", v * v + 1), ("p", v**1.5)):
        np.testing.assert_allclose(values.view(values.names[name]), exact, rtol=1e-14)


def test_a_large_inverse_is_one() -> None:
    """Of the second difference matrix: the inverse has the elements min(i, k) (n + 1 - max(i, k)) / (n + 1)."""
    n = 400
    values = run(
        f"n = {n}\nARRAY A[n,n], B[n,n], C[n,n]\nfor i = 1 to n | A[i,i] = 2 | next\n"
        "for i = 2 to n | A[i,i-1] = -1 | A[i-1,i] = -1 | next\nMATRIX B = $In(A) | MATRIX C = A*B"
    ).values
    i = np.arange(1, n + 1)
    exact = np.minimum.outer(i, i) * (n + 1 - np.maximum.outer(i, i)) / (n + 1)
    np.testing.assert_allclose(values.view(values.names["B"]), exact, rtol=1e-9)
    np.testing.assert_allclose(values.view(values.names["C"]), np.eye(n), atol=1e-9)


def test_a_process_is_left_while_something_goes_on() -> None:
    """Its exit status and its output get out, though the operation would never end."""
    code = (
        "import sys; from threading import Event\n"
        "from desire_tui.engine.exclusive_work import leave_at_once\n"
        "from desire_tui.engine.interpreter.interruptible import LONG_WORK, run_interruptibly\n"
        "def stop(): raise ValueError\n"
        "leave_at_once(3)\n"  # nothing goes on yet
        "try: run_interruptibly(LONG_WORK, Event().wait, stop)\n"
        "except ValueError: print('broken off')\n"
        "leave_at_once(7)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (7, "broken off\n", "")


def test_functions_that_call_others_twice_can_be_broken_off() -> None:
    """2^60 calls in one expression."""
    text = "FUNCTION f0(x) = x\n" + "".join(
        f"FUNCTION f{i}(x) = f{i - 1}(x) + f{i - 1}(x)\n" for i in range(1, 61)
    )
    host = RecordingHost()
    host.looks_allowed = 100
    with pytest.raises(Interrupted):
        host.run(f"{text}y = f60(1)")
    assert run(f"{text}y = f8(1)")["y"] == 256
