"""The compiled run loop: leaving and coming back, quick and fast code, ends and faults."""

import numpy as np
import pytest

from desire_tui.engine.codegen.backend import NativeBackend
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.integration.rules import rules_of
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.runtime.run_memory import Ended
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import ERRMAX, T, Values
from tests.codegen.conftest import advance_to_end, improve, memory_for, run

LORENZ = "DYNAMIC\nd/dt x = a*(y - x)\nd/dt y = x*(r - z) - y\nd/dt z = x*y - b*z\nn = x + y\ndispt x, n, z\n"
RULES = rules_of("fixed", "variable")


def made_of(text, rule, storage="quick", backend=None, **numbers):
    """Compile a segment, its scalars set; return model, segment and values."""
    values = Values()
    for name, number in numbers.items():
        values.assign(values.scalar(name).slot, number)
    values.assign(T, 0.0)
    segment = lower(parse(Source(text)), None, values)
    model = (backend or NativeBackend()).model(segment, rule, values)
    if storage != "quick":
        improve(model)
    return model, segment, values


def lorenz(rule, storage="quick"):
    return made_of(LORENZ, rule, storage, a=10.0, b=8 / 3, r=28.0, x=1.0, y=1.0, z=1.0)


@pytest.mark.parametrize("rule", RULES)
def test_fast_code_gives_the_same_bits_whenever_it_comes(rule, storage):
    """In register storage the run even goes over from one storage to another."""
    found = []
    for when in ("never", "at once", "later"):
        model, segment, values = lorenz(rule)
        memory, rows = memory_for(values, segment, t_max=4.0, dt=0.01, nn=9)
        if when == "at once":
            improve(model)
        if when == "later":
            memory.row_limit = 3
            assert model.advance(memory) is Ended.RUNNING
            improve(model)
            memory.row_limit = 100
        assert advance_to_end(model, memory) is Ended.TMAX
        found.append(rows[: memory.row].tolist())
    assert found[0] == found[1] == found[2]
    assert len(found[0]) == 9


@pytest.mark.parametrize("rule", RULES)
def test_registers_and_arrays_give_the_same_bits(rule, monkeypatch):
    from desire_tui.engine.codegen import native_model as module

    found = []
    for small in (200, -1):
        monkeypatch.setattr(module, "SMALL", small)
        model, segment, values = lorenz(rule, "improved")
        memory, rows = memory_for(values, segment, t_max=4.0, dt=0.01, nn=9)
        assert model.advance(memory) is Ended.TMAX
        found.append((rows.tolist(), memory.steps, memory.rejected, memory.derivative_calls))
    assert found[0] == found[1]


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("how", ["rows", "stop"])
def test_leaving_and_coming_back_changes_nothing(rule, how, storage):
    model, segment, values = lorenz(rule, storage)
    memory, whole = memory_for(values, segment, t_max=2.0, dt=0.01, nn=11)
    assert model.advance(memory) is Ended.TMAX
    steps = memory.steps

    model, segment, values = lorenz(rule, storage)
    memory, parts = memory_for(values, segment, t_max=2.0, dt=0.01, nn=11)
    returns = 0
    while True:
        if how == "rows":
            memory.row_limit = memory.row + 1
        else:
            memory.stop = 1  # comes back after one step
        ended = model.advance(memory)
        returns += 1
        if ended not in (Ended.RUNNING, Ended.STOPPED):
            break
    assert ended is Ended.TMAX
    assert returns > 10
    assert memory.steps == steps
    assert parts.tolist() == whole.tolist()


def test_times_do_not_drift(storage):
    model, segment, values = made_of("DYNAMIC\nd/dt x = 1\ndispt x\n", 1, storage, x=0.0)
    memory, rows = memory_for(values, segment, t_max=1000.0, dt=0.1, nn=1001)
    assert model.advance(memory) is Ended.TMAX
    assert memory.steps == 10_000
    assert rows[:1001, 0].tolist() == [k * 10 * 0.1 for k in range(1001)]


def test_samples_come_at_the_first_step_end_behind_the_point(storage):
    model, segment, values = made_of("DYNAMIC\nd/dt x = 1\ndispt x\n", 2, storage, x=0.0)
    memory, rows = memory_for(values, segment, t_max=1.0, dt=0.15, nn=5)
    assert model.advance(memory) is Ended.TMAX
    np.testing.assert_allclose(rows[:5, 0], [0, 0.3, 0.6, 0.75, 1.05], rtol=1e-15)


def test_term_between_points_takes_a_last_sample(storage):
    text = "DYNAMIC\nd/dt x = 1\ny = 2*x\nterm x - 0.335\nterm x - 0.315\nOUT\nz = 3*x\ndispt x, y, z\n"
    model, segment, values = made_of(text, 1, storage, x=0.0)
    memory, rows = memory_for(values, segment, t_max=1.0, dt=0.01, nn=5)
    assert model.advance(memory) is Ended.TERM
    assert memory.which == 1
    assert memory.row == 3
    np.testing.assert_allclose(rows[2], [0.32, 0.32, 0.64, 0.96], rtol=1e-14)


def test_every_mm_th_point_and_the_last(storage):
    model, segment, values = made_of("DYNAMIC\nd/dt x = 1\ndispt x\n", 1, storage, x=0.0)
    memory, rows = memory_for(values, segment, t_max=1.0, dt=0.01, nn=11, every=4)
    assert model.advance(memory) is Ended.TMAX
    np.testing.assert_allclose(rows[: memory.row, 0], [0, 0.4, 0.8, 1.0], rtol=1e-14)


@pytest.mark.parametrize("rule", RULES)
def test_infinity_ends_the_run_near_its_birth(rule, storage):
    model, segment, values = made_of(
        "DYNAMIC\nd/dt u = 1\nd/dt x = x^2\ndispt u\n", rule, storage, x=1.0, u=0.0
    )
    memory, rows = memory_for(values, segment, t_max=1e6, dt=0.01, nn=3, dt_min=1e-300, error_max=1e300)
    assert model.advance(memory) is Ended.NOT_FINITE
    assert memory.which == 1
    assert memory.row == 1
    assert memory.steps <= 2048
    assert np.isfinite(rows[0]).all()


def test_an_infinite_column_is_named(storage):
    model, segment, values = made_of(
        "DYNAMIC\ny = ln(x - 0.5)\nd/dt x = 1 + 0*y\nz = 1\ndispt z, y\n", 1, storage, x=1.0
    )
    values.assign(values.find("x").slot, 0.0)
    memory, _ = memory_for(values, segment, t_max=1.0, dt=0.01, nn=5)
    assert model.advance(memory) is Ended.NOT_FINITE
    assert memory.which == -2


def test_a_column_that_no_state_depends_on_has_a_gap(storage):
    model, segment, values = made_of(
        "DYNAMIC\nd/dt x = 1\ny = sqrt(0.6 - x)\nz = 1\ndispt z, y\n", 1, storage, x=0.0
    )
    memory, rows = memory_for(values, segment, t_max=1.0, dt=0.01, nn=5)
    assert model.advance(memory) is Ended.TMAX
    assert memory.gap == 4
    assert np.isfinite(rows[:5]).tolist() == [[True, True, True]] * 3 + [[True, True, False]] * 2


@pytest.mark.parametrize("rule", [4, 7, 8])
def test_deadlock_restores_the_step(rule, storage):
    model, segment, values = made_of(
        "DYNAMIC\nd/dt u = 1\nd/dt x = 1000*sigmoid(1E+6*(t - 0.31))\ndispt x\n", rule, storage, x=0.0
    )
    memory, _ = memory_for(values, segment, t_max=1.0, dt=0.02, nn=3, dt_min=0.004, error_max=1e-3)
    assert model.advance(memory) is Ended.DEADLOCK
    assert memory.which == 1
    assert values.cells[T] == pytest.approx(values.cells[values.find("u").slot], rel=1e-12)
    assert values.cells[values.find("x").slot] == 0.0
    assert values.cells[ERRMAX] > 1e-3


def test_one_line_edited_compiles_one_piece(monkeypatch):
    from desire_tui.engine.codegen.jit import cache as module

    compiled = []
    kept = module.compile_text

    def compile_text(text, *, level, **how):
        if level == 0:  # others may still be compiling fast code
            compiled.append(text)
        return kept(text, level=level, **how)

    monkeypatch.setattr(module, "compile_text", compile_text)
    lines = [f"d/dt x{k} = sin({k}*x{k}) - x{k - 1 if k else 399}*{k}.5" for k in range(400)]
    numbers = {f"x{k}": 0.1 for k in range(400)}
    backend = NativeBackend()
    made_of("DYNAMIC\n" + "\n".join(lines) + "\ndispt x1\n", 1, backend=backend, **numbers)
    before = sum(text.count("define void") for text in compiled)
    compiled.clear()
    lines[150] = "d/dt x150 = cos(x149)"
    made_of("DYNAMIC\n" + "\n".join(lines) + "\ndispt x1\n", 1, backend=backend, **numbers)
    assert before > 4
    assert sum(text.count("define void") for text in compiled) == 1


@pytest.mark.parametrize("lengths", [(16, 1_600), (160_000, 16_000_000)], ids=["alone", "shared by threads"])
def test_vector_code_does_not_grow_with_the_vectors(lengths):
    from desire_tui.engine.codegen.pieces.pass_pieces import write
    from desire_tui.engine.passes.slices import full_pass

    sizes = []
    for n in lengths:
        values = Values()
        for name in ("x", "y"):
            values.array(name, (n,), is_state=name == "x")
        text = "DYNAMIC\nVector y = sin(x) + x{1}\nVectr d/dt x = y - x\nDOT s = x*y\ndispt s\n"
        segment = lower(parse(Source(text)), None, values)
        piece = write(list(full_pass(segment)))
        sizes.append(len(piece.text) + sum(map(len, piece.needs)))
    assert abs(sizes[0] - sizes[1]) < 200


def test_a_million_states_run():
    made = run(
        "n = 1000000 | STATE x[n]\nVector x = 1\nTMAX = 0.1 | DT = 0.01 | NN = 2 | irule 3\ndrun\nDYNAMIC\n"
        "Vectr d/dt x = -x\nAVG m = x*1\ndispt m\n"
    )
    growth = (1 - 0.01 + 0.01**2 / 2 - 0.01**3 / 6 + 0.01**4 / 24) ** 10
    assert made.rows[-1, 1] == pytest.approx(growth, rel=1e-11)  # a sum of a million numbers


def test_faults_name_variable_and_line():
    with pytest.raises(DesireError) as caught:
        run("x = 1 | TMAX = 10 | DT = 0.01\ndrun\nDYNAMIC\nd/dt x = x^2\ndispt x\n")
    assert caught.value.diagnostics[0].facts["name"] == "x"
