"""Rolled-up statements called with data: an edit finds their code, and the numbers stay the same."""

from __future__ import annotations

import pytest

from desire_tui.engine.codegen.backend import NativeBackend
from desire_tui.engine.codegen.compiler_state import CompilerState
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.pieces import kept_pieces, rolled_pieces
from desire_tui.engine.codegen.scalar import rerolling
from desire_tui.engine.lowering.lowering import lower
from desire_tui.engine.source import Source
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.values import T, Values
from tests.codegen.conftest import improve, memory_for
from tests.codegen.test_rerolling import chain, ladder, states_of

RULE = 3


@pytest.fixture
def backend():
    rolled_pieces.forget()
    kept_pieces.forget()
    state = CompilerState()
    state.improver.add = lambda work: None
    yield NativeBackend(state)
    state.close()


def rows_of(backend, lines, *, fast=False):
    """Samples of a short run, and the model."""
    states = states_of(lines)
    values = Values()
    for k, name in enumerate([*states, "a", "b", "c"]):
        values.assign(values.scalar(name, is_state=name in states).slot, 0.3 + 0.1 * (k % 7))
    values.assign(T, 0.0)
    text = "DYNAMIC\n" + "\n".join(lines) + f"\ndispt {', '.join(states[:: len(states) // 8])}\n"
    segment = lower(parse(Source(text)), None, values)
    model = backend.model(segment, RULE, values)
    if fast:
        improve(model)
    memory, rows = memory_for(values, segment, t_max=0.05, dt=0.01, nn=3)
    model.advance(memory)
    return rows[: memory.row].tolist()


def uncalled(lines, monkeypatch):
    """Samples with every statement written by itself."""
    with monkeypatch.context() as patch:
        patch.setattr(rerolling, "_RUN_LEAST", 10**9)
        state = CompilerState()
        state.improver.add = lambda work: None
        try:
            return rows_of(NativeBackend(state), lines)
        finally:
            state.close()


def calls_with_data(monkeypatch):
    """Count calls with data from now on."""
    made, call = [], rolled_pieces.FunctionsOfData.call

    def counted(self, action):
        made.append(action)
        return call(self, action)

    monkeypatch.setattr(rolled_pieces.FunctionsOfData, "call", counted)
    return made


def neighbours(n):
    """Parameters and numbers in turn, and a state that all share."""
    return [f"d/dt x{k} = {'ac'[k % 2]}*x{(k + 1) % n} - x0/{2 + k % 2}.5" for k in range(n)]


@pytest.mark.parametrize(
    ("make", "first", "other", "width", "fast"),
    [
        (ladder, 210, 211, 8, False),
        (ladder, 203, 207, 2, False),
        (chain, 216, 209, 4, False),
        (chain, 203, 230, 8, True),
        (neighbours, 64, 72, 8, False),
        (neighbours, 72, 75, 4, False),
    ],
)
def test_data_give_the_same_bits_as_text(make, first, other, width, fast, backend, monkeypatch):
    """Of other lengths, so that none, one or several are left behind the last full vector."""
    expected = uncalled(make(other), monkeypatch)
    monkeypatch.setattr(machine(), "width", width)
    made = calls_with_data(monkeypatch)
    rows_of(backend, make(first))
    assert not made
    assert rows_of(backend, make(other), fast=fast) == expected
    assert made


def test_an_edited_number_compiles_nothing(backend, monkeypatch, compiled):
    made = calls_with_data(monkeypatch)
    lines = ladder(300)
    rows_of(backend, lines)
    for number in (2, 3):  # the loops become functions of data; so does what the edited line came to
        lines[150] = f"d/dt i75 = {number}*b*(v75 - v76)"
        rows_of(backend, lines)
    compiled.clear()
    lines[150] = "d/dt i75 = 5*b*(v75 - v76)"
    edited = rows_of(backend, lines)
    lines[150] = "d/dt i75 = b*(v75 - v76)"
    lines[402] = "d/dt i201 = 1.5*b*(v201 - v77)"
    assert rows_of(backend, lines) != edited
    assert not compiled
    assert len(made) > 6
    assert rows_of(backend, lines) == uncalled(lines, monkeypatch)


def test_the_same_model_again_is_what_it_was(backend, monkeypatch):
    made = calls_with_data(monkeypatch)
    assert rows_of(backend, ladder(200)) == rows_of(backend, ladder(200))
    assert not made
