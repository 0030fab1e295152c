"""`compare rule n`, `compare DT x`: the last run once more, from exactly where it began."""

from __future__ import annotations

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.session import Session
from desire_tui.engine.session.status import State
from desire_tui.engine.source import Source
from tests.runtime import running
from tests.runtime.running import Kept, ran, value
from tests.runtime.test_run_control import Worker

LORENZ = """s = 10 | r = 28 | b = 8/3 | x = 1 | y = 1 | z = 1
TMAX = 2 | DT = 0.01 | NN = 101 | scale = 50
irule 1
drun
DYNAMIC
d/dt x = s*(y - x)
d/dt y = x*(r - z) - y
d/dt z = x*y - b*z
dispt x, y, z
"""
DECAY = "TMAX = {tmax} | DT = {dt} | NN = {nn} | x = 1\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\n"


def compare(text, command, **options):
    """Run a program and the command; return the session and the table's lines."""
    session, kept = ran(text, **options)
    kept.text = ""
    session.execute(command)
    return session, kept.text.splitlines()


def rows(table):
    """The table's numbers by variable: largest difference, its time, both final values."""
    numbers = {}
    for line in table[2:]:
        words = line.split()
        if len(words) == 5:
            numbers[words[0]] = [float(word) for word in words[1:]]
    return numbers


def refusal(session, command):
    with pytest.raises(DesireError) as caught:
        session.execute(command)
    return caught.value.diagnostics[0]


def lorenz_by(step):
    """Every second of 200 steps of 0.01 by a formula written down here."""

    def f(v):
        x, y, z = v
        return np.array([10 * (y - x), x * (28 - z) - y, x * y - 8 / 3 * z])

    v, h = np.ones(3), 0.01
    found = [v]
    for number in range(1, 201):
        v = step(f, v, h)
        if number % 2 == 0:
            found.append(v)
    return np.array(found)


def heun(f, v, h):
    k1 = f(v)
    return v + h / 2 * (k1 + f(v + h * k1))


def classical(f, v, h):
    k1 = f(v)
    k2 = f(v + h / 2 * k1)
    k3 = f(v + h / 2 * k2)
    return v + h / 6 * (k1 + 2 * k2 + 2 * k3 + f(v + h * k3))


def test_the_numbers_are_those_of_an_independent_computation():
    _, table = compare(LORENZ, "compare rule 3")
    assert table[0] == "rule 1: 200 steps, rule 3: 200 steps"
    one, three = lorenz_by(heun), lorenz_by(classical)
    for number, name in enumerate("xyz"):
        difference = np.abs(one[:, number] - three[:, number])
        largest, at, end_one, end_three = rows(table)[name]
        assert largest == pytest.approx(difference.max(), rel=1e-5)
        assert at == pytest.approx(0.02 * difference.argmax())
        assert (end_one, end_three) == pytest.approx((one[-1, number], three[-1, number]), rel=1e-7)


def test_a_smaller_step_and_a_smaller_tolerance():
    session, table = compare(DECAY.format(tmax=1, dt=0.1, nn=11), "compare DT 0.05")
    assert table[0] == "DT 0.1: 10 steps, DT 0.05: 20 steps"
    ten, twenty = (1 - 0.1 + 0.005) ** 10, (1 - 0.05 + 0.00125) ** 20
    assert rows(table)["x"][2:] == pytest.approx([ten, twenty], rel=1e-7)
    session.execute("compare rule 14 ERMAX 1E-10 DT 0.001")
    session.execute("compare rule 3 DT 0.01")
    assert value(session, "DT") == 0.1
    assert value(session, "x") == pytest.approx(ten, rel=1e-14)
    assert session.rule == 1


def test_it_begins_where_the_run_began_and_leaves_everything_as_it_was():
    """Noise, difference equations, histories and a relay: the same rule must give the same once more."""
    text = """ARRAY X[21], D[50] | n = 0 | p = 0 | on = 1
TMAX = 2 | DT = 0.05 | NN = 21 | SEED 4
drun
DYNAMIC
d/dt x = on*p - x
tdelay y = D(x, 0.3
store X = x
dispt x, n, p, y, on
SAMPLE 2
n = n + 1
p = ran()
on = on*sgn(0.2 - x)
"""
    session, _ = ran(text + "\n")
    names = ("x", "n", "p", "y", "on", "t", "DT")
    before = [value(session, name) for name in names] + list(session.values.view(session.values.find("X")))
    random = session.values.random[0]
    kept = session._listener
    kept.text = ""
    session.execute("compare rule 1")
    assert all(row[0] == 0 for row in rows(kept.text.splitlines()).values())
    assert len(rows(kept.text.splitlines())) == 5
    session.execute("compare rule 3")
    after = [value(session, name) for name in names] + list(session.values.view(session.values.find("X")))
    assert after == before
    assert session.values.random[0] == random
    session.execute("drun")  # goes on as if nothing had been compared
    again, _ = ran(text.replace("drun\n", "drun\ndrun\n"))
    assert list(session.runs[-1].values("x")) == list(again.runs[-1].values("x"))


def test_after_drunr_and_after_a_changed_parameter():
    """The run is repeated with what it had, not with what the script made of it afterwards."""
    text = "a = 1 | x = 1 | TMAX = 1 | DT = 0.1 | NN = 11\ndrunr\na = 50 | DT = 0.001\nDYNAMIC\nd/dt x = -a*x\ndispt x\n"
    session, table = compare(text, "compare rule 1")
    assert table[0] == "rule 1: 10 steps, rule 1: 10 steps"
    assert rows(table)["x"][0] == 0
    assert value(session, "a") == 50


@pytest.mark.parametrize("order", ["rule 1 first", "rule 4 first"])
def test_samples_that_stand_at_different_times(order):
    """DT = 0.3: samples of rule 1 stand at 0, 1.2, 2.1, 3, 4.2 …, those of rule 4 at whole times.

    Rule 4 is compared at the times of rule 1: x = 0.745^k after k steps against exp(-0.3*k).
    """
    text = "ERMAX = 1E-8 | " + DECAY.format(tmax=10, dt=0.3, nn=11).replace(
        "DT = 0.3", "DT = 0.3 | DTMIN = 1E-9"
    )
    if order == "rule 4 first":
        session, first = compare("irule 4\n" + text, "compare rule 1")
    else:
        session, first = compare(text, "compare rule 4")
    largest, at, *ends = rows(first)["x"]
    steps = np.array([0, 4, 7, 10, 14, 17, 20, 24, 27, 30, 34])
    differences = np.abs(0.745**steps - np.exp(-0.3 * steps))
    assert largest == pytest.approx(differences.max(), rel=1e-5)
    assert at == pytest.approx(0.3 * steps[differences.argmax()])
    assert sorted(ends) == pytest.approx(sorted([0.745**34, np.exp(-10)]), rel=1e-4)
    assert "the last samples stand at t = 10" in first[-1]
    assert len(session.runs) == 1


def test_a_finer_step_is_compared_at_the_coarser_ones_samples():
    _, table = compare(DECAY.format(tmax=10, dt=0.3, nn=11), "compare DT 0.1")
    steps = np.array([0, 4, 7, 10, 14, 17, 20, 24, 27, 30, 34])
    differences = np.abs(0.745**steps - 0.905 ** (3 * steps))
    assert rows(table)["x"][0] == pytest.approx(differences.max(), rel=1e-5)


def test_only_samples_at_one_time_are_compared_where_code_runs_at_samples():
    """A count in OUT must not be repeated at other times: 0, 3, 6, 9 are common."""
    text = DECAY.format(tmax=10, dt=0.3, nn=11).replace("x = 1\n", "x = 1 | n = 0\n") + "OUT\nn = n + 1\n"
    _, table = compare(text, "compare rule 4")
    largest, at, *_ = rows(table)["x"]
    assert at in (3, 6, 9)
    assert largest == pytest.approx(abs(0.745**10 - np.exp(-3)), rel=0.05)
    assert table[-2:] == [
        "the last samples stand at t = 10.2 and t = 10",
        "7 of 11 samples stand at different times and are not compared: let TMAX/(NN - 1) be a multiple of DT",
    ]


def test_runs_that_end_by_term_at_different_times():
    text = DECAY.format(tmax=2, dt=0.05, nn=5) + "term 0.6 - x\n"
    _, table = compare(text, "compare rule 2")
    heun_end, euler_end = (int(np.ceil(np.log(0.6) / np.log(q))) * 0.05 for q in (1 - 0.05 + 0.00125, 0.95))
    assert euler_end < heun_end
    assert table[-1] == f"the last samples stand at t = {heun_end:g} and t = {euler_end:g}"


def test_both_runs_are_drawn_on_a_page_of_their_own_with_keys_that_tell_them_apart():
    session, _ = compare(LORENZ, "compare rule 3")
    assert len(session.graphs) == 2
    assert [key.name for key in session.graphs.pages[0].keys] == ["x", "y", "z"]
    page = session.graph
    assert [key.name for key in page.keys] == [f"{n}, rule {k}" for k in (1, 3) for n in "xyz"]
    assert len({key.color for key in page.keys}) == 6
    assert session._listener.events[-1] == ("graph", page.number)
    for number, curves in enumerate((lorenz_by(heun), lorenz_by(classical))):
        assert page.curves[3 * number].samples()[1] == pytest.approx(curves[:, 0], rel=1e-9)
    session.execute("drun")
    assert len(session.graphs) == 3


def test_overlaid_runs_are_told_apart_by_what_differs():
    script = "display 2 | drunr | {change} | display N12 | drunr"
    text = DECAY.format(tmax=1, dt=0.1, nn=11).replace("drun", script)
    for change, expected in (
        ("irule 3", ["rule 1", "rule 3"]),
        ("DT = 0.05", ["DT 0.1", "DT 0.05"]),
        ("x = 0.5", ["x(0) = 1", "x(0) = 0.5"]),
    ):
        session, _ = ran(text.format(change=change))
        assert [key.name for key in session.graph.keys] == expected
    session, _ = ran("irule 14 | ERMAX = 1E-4\n" + text.format(change="ERMAX = 1E-6"))
    assert [key.name for key in session.graph.keys] == ["ERMAX 0.0001", "ERMAX 1e-06"]


def test_stiff_rules_agree_with_each_other():
    text = """irule 14 | ERMAX = 1E-9 | DT = 1E-6 | y1 = 1 | TMAX = 40 | NN = 41
drun
DYNAMIC
d/dt y1 = 1E+04*y2*y3 - 0.04*y1
d/dt y2 = 0.04*y1 - 1E+04*y2*y3 - 3E+07*y2*y2
d/dt y3 = 3E+07*y2*y2
dispt y1, y2, y3
"""
    session, table = compare(text, "compare rule 15")
    assert all(row[0] < 1e-6 for row in rows(table).values())
    # y at 40 from the published test set (see tests/integration/eight_problems.py)
    assert rows(table)["y1"][2:] == pytest.approx([0.7158270687] * 2, rel=1e-6)
    session.execute("compare ERMAX 1E-4")
    assert session.graph.keys[0].name == "y1, ERMAX 1e-09"


@pytest.mark.parametrize(
    ("command", "code"),
    [
        ("compare", 404),
        ("compare 5", 404),
        ("compare rule", 404),
        ("compare rule x", 404),
        ("compare rule 4 5", 404),
        ("compare rule 4 rule 5", 404),
        ("compare TMAX 4", 404),
        ("compare rule 6", 86),
        ("compare rule 18", 86),
        ("compare rule -1", 86),
        ("compare rule 1.5", 86),
        ("compare rule nan", 86),
        ("compare rule 0", 407),
        ("compare rule 14", 87),
        ("compare rule 14 ERMAX 0", 87),
        ("compare DT 0", 87),
        ("compare DT -1", 87),
        ("compare DT nan", 87),
        ("compare DT 0.5", 110),
    ],
)
def test_what_cannot_be_compared(command, code):
    session, _ = ran(DECAY.format(tmax=1, dt=0.1, nn=11))
    before = value(session, "x"), value(session, "DT"), len(session.graphs)
    assert refusal(session, command).code == code
    assert (value(session, "x"), value(session, "DT"), len(session.graphs)) == before


def test_there_must_be_a_run_with_something_to_compare():
    session, _ = ran("x = 1\n")
    assert refusal(session, "compare rule 4").code == 472
    session, _ = ran("TMAX = 1 | DT = 0.1 | drun\nDYNAMIC\nd/dt x = -x\n")
    assert refusal(session, "compare rule 4").code == 405
    session, _ = ran("NN = 10 | drun\nDYNAMIC\nx = t\ndispt x\n")
    assert refusal(session, "compare rule 4").code == 407


def test_a_program_changed_since_is_not_compared():
    session, _ = ran(LORENZ)
    session.accept(Source(LORENZ.replace("dispt x, y, z", "dispt x"), "test.src"))
    assert refusal(session, "compare rule 3").code == 406
    session.accept(Source(LORENZ, "test.src"))
    session.execute("compare rule 3")
    session.execute("clear")
    assert refusal(session, "compare rule 3").code == 406


def test_a_run_that_fails_under_the_other_rule_says_why():
    text = "x = 1 | TMAX = 20 | DT = 0.1 | NN = 201\nirule 14 | ERMAX = 1E-6\ndrun\nDYNAMIC\nd/dt x = -4000*x\ndispt x\n"
    session, _ = ran(text)
    before = value(session, "x")
    problem = refusal(session, "compare rule 2 DT 0.1")
    assert problem.code == 408
    assert "rule 2, DT 0.1" in problem.message
    assert "'x'" in problem.message
    assert value(session, "x") == before
    assert session.runs[-1].ended == "tmax"
    assert len(session.graphs) == 1


def test_a_failed_run_can_be_compared_with_a_rule_that_gets_through():
    text = (
        "x = 1 | TMAX = 10 | DT = 0.1 | NN = 101 | ERMAX = 1E-6\ndrun\nDYNAMIC\nd/dt x = -4000*x\ndispt x\n"
    )
    kept = Kept()
    session = Session(kept, backend=running.BACKEND)
    with pytest.raises(DesireError):
        session.erun(Source(text, "test.src"))
    kept.text = ""
    session.execute("compare rule 14")
    table = kept.text.splitlines()
    assert rows(table)["x"][3] == pytest.approx(0, abs=1e-5)
    assert table[-1].startswith("the last samples stand at t = ")


@pytest.mark.parametrize("inside", ["command", "script"])
def test_ending_it_puts_everything_back(inside):
    """With the step of the comparison the run would take years."""
    text = "x = 1 | TMAX = 1 | DT = 0.001 | NN = 101\ndrun\nDYNAMIC\nd/dt x = -x\ndispt x\nterm t - 0.002\n"
    command = "compare DT 1E-15"
    worker = Worker(text if inside == "command" else text.replace("DYNAMIC", command + "\nDYNAMIC"))
    session = worker.session
    if inside == "command":
        worker.join()
        worker = Worker(command, session)
    worker.wait_for(lambda: session._runs.simulator.memory is not None and session._runs.start is not None)
    in_comparison = lambda: session.status.state is State.RUNNING and 0 < session.status.t < 0.001  # noqa: E731
    worker.wait_for(in_comparison)
    session.end()
    worker.join()
    assert worker.error.diagnostics[0].code == 301
    assert value(session, "x") == pytest.approx(np.exp(-0.003), abs=2e-3)
    assert len(session.runs) == len(session.graphs) == 1
    assert session.status.state is State.IDLE
