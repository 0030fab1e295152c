"""What the command line shows while a run goes on: expressions from the numbers of that moment."""

from __future__ import annotations

import math

import pytest

from desire_tui.desktop.command_line import DURING_A_RUN

from .conftest import LONG, Desktop, desktop

PROGRAM = LONG.replace("x = 1\n", "FUNCTION twice(a) = 2*a\nARRAY A[3] | A[2] = 5 | k = 3\nx = 1\n").replace(
    "dispt", "square = x*x\ndispt"
)


async def running(desk: Desktop) -> None:
    await desk.press("f5")
    await desk.until(lambda: desk.app.session.status.t > 1)


async def answer(desk: Desktop, line: str) -> str:
    await desk.line(line)
    return desk.output.rpartition(f"> {line}\n")[2].strip()


async def test_expressions_are_written_while_the_run_goes_on(program):
    async with desktop(program(PROGRAM)) as desk:
        await running(desk)
        assert float(await answer(desk, "write twice(k) + sqrt(A[2]*5)")) == 11
        x, v, square = (float(w) for w in (await answer(desk, "write x; ' '; v; ' '; square")).split())
        assert x * x + v * v == pytest.approx(1, abs=0.01)
        assert 0 <= square <= 1.01  # of the last sample: a run computes it only there
        assert float(await answer(desk, "write t")) > 1
        assert " k = 3 " in (await answer(desk, "dump")).replace("\n", " ") + " "
        assert desk.app.session.status.state.value == "running"
        cells, find = desk.app.session.values.cells, desk.app.session.values.find
        assert cells[find("k").slot] == 3


async def test_what_does_more_has_to_wait(program):
    lines = ("k = 4", "write k | k = 4", "drun", "write #1, k", "write k, '", "clear", "input k")
    async with desktop(program(PROGRAM)) as desk:
        await running(desk)
        for line in lines:
            assert await answer(desk, line) == DURING_A_RUN, line
            assert desk.app.session.values.cells[desk.app.session.values.find("k").slot] == 3


async def test_mistakes_are_told_and_the_run_goes_on(program):
    async with desktop(program(PROGRAM)) as desk:
        await running(desk)
        assert "nobody" in await answer(desk, "write 2*nobody")
        assert desk.app.session.values.find("nobody") is None
        t = desk.app.session.status.t
        await desk.until(lambda: desk.app.session.status.t > t)


async def test_looking_does_not_draw_random_numbers_of_the_program(program):
    async with desktop(program("SEED 5\n" + PROGRAM)) as desk:
        await running(desk)
        before = desk.app.session.values.random.copy()
        first = await answer(desk, "write ran()")
        assert -1 <= float(first) <= 1
        assert await answer(desk, "write ran()") == first
        assert list(desk.app.session.values.random) == list(before)


async def test_a_paused_run_is_looked_at_exactly(program):
    async with desktop(program(PROGRAM)) as desk:
        await running(desk)
        await desk.press("ctrl+c")
        await desk.until(lambda: desk.app.session.status.state.value == "paused")
        x, v = (float(w) for w in (await answer(desk, "write x; ' '; v")).split())
        turned = float(await answer(desk, "write atan2(v, x) + t - 2*PI*round((atan2(v, x) + t)/(2*PI))"))
        assert math.hypot(x, v) == pytest.approx(1, abs=1e-3)
        assert turned == pytest.approx(0, abs=1e-2)  # v = -sin(t), x = cos(t)
