"""Pasted lines, names of new tabs, what the status row says."""

from __future__ import annotations

import math
import threading
from time import sleep

import pytest
from textual.events import Paste
from textual.widgets import OptionList

from desire_tui.app import DesireApp
from desire_tui.desktop.engine_thread import EngineThread
from desire_tui.desktop.screen_listener import ScreenListener
from desire_tui.editor.buffer import free_label
from desire_tui.engine.runtime.run_record import RunRecord
from desire_tui.engine.session.status import State, Status
from desire_tui.panes.history_list import HistoryList
from desire_tui.panes.pending_lines import PendingLines
from desire_tui.panes.run_summary import bar, run_text
from desire_tui.panes.status_bar import StatusBar

from .conftest import LONG, OSCILLATOR, Desktop, desktop, until


async def paste(desk: Desktop, text: str) -> None:
    desk.app.command.prompt.focus()
    await desk.pilot.pause()
    desk.app.command.prompt.post_message(Paste(text))
    await desk.pilot.pause()
    await desk.idle()


def value(desk: Desktop, name: str) -> float:
    return float(desk.app.session.values.cells[desk.app.session.values.find(name).slot])


async def test_pasted_lines_stop_at_the_one_that_fails_and_can_be_corrected(program):
    async with desktop(program("")) as desk:
        held = desk.app.command.query_one(PendingLines)
        prompt = desk.app.command.prompt
        await paste(desk, "a = 2\nb = a*\nc = b + 1\nwrite c\nunfinished")
        await desk.until(lambda: held.display)
        assert value(desk, "a") == 2
        assert desk.app.session.values.find("c") is None
        assert prompt.value == "b = a*"
        assert "those after it wait" in desk.output
        assert "> c = b + 1" not in desk.output
        assert [held.render_line(y).text.strip() for y in range(held.size.height)] == [
            "▸ b = a*", "c = b + 1", "write c", "unfinished",
        ]  # fmt: skip
        await desk.press("down", "down", "down")
        assert prompt.value == "unfinished"
        prompt.value = ""
        await desk.press("up", "up")
        assert prompt.value == "c = b + 1"
        await desk.press("backspace", "5", "up")
        assert prompt.value == "b = a*"
        await desk.press("2", "1", "enter")
        await desk.idle()
        assert not held.display
        assert value(desk, "c") == 47
        assert desk.output.rstrip().endswith("47")


async def test_lines_held_back_can_be_given_up(program):
    async with desktop(program("")) as desk:
        await paste(desk, "a = \nb = 2\n")
        await desk.until(lambda: desk.app.command.query_one(PendingLines).display)
        await desk.press("escape")
        assert not desk.app.command.query_one(PendingLines).display
        assert desk.app.command.prompt.value == ""
        await desk.line("c = 3")
        await desk.idle()
        assert desk.app.session.values.find("b") is None
        assert value(desk, "c") == 3


async def test_a_single_line_that_fails_holds_nothing_back(program):
    async with desktop(program("")) as desk:
        await desk.line("a = ")
        await desk.idle()
        assert desk.app.command.prompt.value == ""
        assert not desk.app.command.query_one(PendingLines).display


async def test_pasted_lines_stop_at_a_program_that_fails(program):
    async with desktop(program(OSCILLATOR.replace("-x", "-xx"))) as desk:
        await paste(desk, "zz\nwrite 'not yet'\n")
        await desk.until(lambda: desk.app.command.query_one(PendingLines).display)
        assert "> write" not in desk.output
        assert desk.app.command.prompt.value == "zz"


async def test_pasted_lines_wait_for_files_to_open_and_stop_where_one_cannot(program):
    program("write 6*7\n", "second.src")
    async with desktop(program(OSCILLATOR)) as desk:
        await paste(desk, "load 'second.src'\nzz\n")
        await desk.until(lambda: desk.output.rstrip().endswith("42"))
        await paste(desk, "load 'missing.src'\nwrite 'not yet'\n")
        await desk.until(lambda: desk.app.command.query_one(PendingLines).display)
        assert "> write" not in desk.output


async def test_pasted_lines_answer_an_input(program):
    async with desktop(program("input a\ninput b\nwrite a*b\n")) as desk:
        await paste(desk, "zz\n6\n7\nwrite 'done'\n")
        await desk.until(lambda: desk.output.rstrip().endswith("done"))
        assert "42" in desk.output.splitlines()


@pytest.mark.parametrize(
    ("wanted", "taken", "label"),
    [
        ("", (), "untitled-1"),
        ("", ("untitled-1", "a.src"), "untitled-2"),
        ("", ("untitled-2",), "untitled-1"),
        ("untitled-1", ("untitled-1",), "untitled-2"),
        ("step-copy", (), "step-copy"),
        ("step-copy", ("step-copy",), "step-copy-2"),
        ("step-copy", ("step-copy", "step-copy-2"), "step-copy-3"),
    ],
)
def test_names_of_tabs_without_a_file(wanted: str, taken: tuple[str, ...], label: str):
    assert free_label(wanted, taken) == label


async def test_new_tabs_count_from_one(program):
    async with desktop(program("x = 1\n")) as desk:
        names = [area.buffer.name for area in desk.app.editor.areas]
        for _ in range(2):
            await desk.do("file.new")
            await desk.pilot.pause()
            await desk.press("a")
        assert [area.buffer.name for area in desk.app.editor.areas] == [*names, "untitled-1", "untitled-2"]
        await desk.do("file.edit_copy")
        await desk.do("file.edit_copy")
        assert len({area.buffer.name for area in desk.app.editor.areas}) == 5


# ------------------------------------------------------------------------------------------------ status row


def a_run(**changed: object) -> RunRecord:
    facts: dict[str, object] = {
        "number": 5, "segment": None, "line": 3, "requests": (), "columns": (), "overlay": False, "rule": 15,
        "scale": 1.0, "t0": 0.0, "t_max": 0.5, "nn": 11, "dt": 1e-4, "ended": "tmax", "end_time": 0.5, "steps": 5234,
        "rejected": 17, "derivative_calls": 7012, "jacobian_calls": 90, "dt_least": 1e-7, "dt_most": 0.0125, "order": 4,
    }  # fmt: skip
    return RunRecord(**{**facts, **changed})  # type: ignore[arg-type]


def status(state: State, record: RunRecord | None, t: float = 0.0) -> Status:
    return Status(
        state=state, run=5, segment=None, t=t, t0=0.0, t_max=0.5, steps=5234, steps_per_second=2.1e6, rule=15, dt=2e-5,
        program="a.src", record=record,
    )  # fmt: skip


def test_after_a_run_the_status_row_says_why_and_when_it_ended_and_what_it_cost():
    assert run_text(status(State.IDLE, a_run()), 999) == (
        "run 5: TMAX reached at t = 0.5 · 5.23 k steps · 17 rejected · 7.01 k derivatives · 90 Jacobians · "
        "DT 1e-07 … 0.0125 · order 4 · rule 15 · 2.1 M steps/s"
    )
    assert run_text(status(State.IDLE, a_run()), 48) == "run 5: TMAX reached at t = 0.5 · 5.23 k steps"
    assert run_text(status(State.IDLE, a_run()), 12) == "run 5: TMAX "


@pytest.mark.parametrize(
    ("ended", "words"),
    [("term", "ended by term"), ("stopped", "ended by you"), ("failed", "failed"), ("tmax", "TMAX reached")],
)
def test_reasons_for_the_end(ended: str, words: str):
    assert run_text(status(State.IDLE, a_run(ended=ended, end_time=0.25)), 999).startswith(
        f"run 5: {words} at t = 0.25 ·"
    )


def test_a_rule_with_a_constant_step_tells_no_rejected_steps():
    text = run_text(
        status(State.IDLE, a_run(rejected=0, dt_least=1e-4, dt_most=1e-4, jacobian_calls=0, order=0)), 999
    )
    assert "rejected" not in text
    assert "Jacobian" not in text
    assert "order" not in text
    assert "DT 0.0001 ·" in text


def test_while_a_run_goes_on_the_step_is_seen():
    text = run_text(status(State.RUNNING, a_run(ended="running"), t=0.25), 999)
    assert text.startswith(
        "running 5 · █████····· t 0.25/0.5 · 2.1 M steps/s · DT 2e-05 · rule 15 · 17 rejected"
    )


def test_before_anything_ran_it_says_nothing():
    assert run_text(None, 80) == ""


def test_bars():
    assert (bar(0.0), bar(1.0), bar(0.5)) == ("··········", "██████████", "█████·····")
    assert {len(bar(n / 97)) for n in range(98)} == {10}


async def test_the_status_row_keeps_the_end_after_the_script_reset_the_time(program):
    async with desktop(program(OSCILLATOR.replace("drun\n", "drunr\n")), size=(160, 50)) as desk:
        await desk.press("f5")
        await desk.idle()
        assert value(desk, "t") == 0.0
        assert (
            "run 1: TMAX reached at t = 6 · 6 k steps · 24 k derivatives"
            in desk.app.main_screen.query_one(StatusBar).text
        )


async def test_a_run_ended_by_term_says_so(program):
    text = OSCILLATOR.replace("dispt x, v", "term -x\ndispt x, v")
    async with desktop(program(text), size=(160, 50)) as desk:
        await desk.press("f5")
        await desk.idle()
        shown = desk.app.main_screen.query_one(StatusBar).text
        assert "ended by term at t = " in shown
        assert float(shown.split("t = ")[1].split(" ")[0]) == pytest.approx(math.pi / 2, abs=0.02)


async def test_the_run_report_at_any_time(program):
    async with desktop(program(LONG), size=(160, 50)) as desk:
        await desk.do("run.report")
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.runs and desk.app.session.runs[0].steps)
        await desk.press("alt+d")
        assert "still going on" in desk.output
        await desk.press("shift+f10")
        await desk.idle()
        await desk.pilot.click(StatusBar, offset=(155, 0))
        assert "ended by the user" in desk.output


async def test_keys_of_the_status_row_can_be_clicked(program):
    async with desktop(program(OSCILLATOR), size=(160, 50)) as desk:
        row = desk.app.main_screen.query_one(StatusBar)
        text = row.render_line(0).text
        await desk.pilot.click(StatusBar, offset=(text.index("F5") + 1, 0))
        await desk.idle()
        assert "x = " in desk.output
        text = row.render_line(0).text
        await desk.pilot.click(StatusBar, offset=(text.index("F1") + 4, 0))
        assert desk.app.main_screen.side == "help"


async def test_after_load_the_keys_stay_in_the_command_line(program):
    """`load 'f'` and then `zz`: the second word must not land in the program."""
    program("write 6*7\n", "second.src")
    async with desktop(program(OSCILLATOR)) as desk:
        await desk.line("load 'second.src'")
        await desk.until(lambda: desk.app.editor.front.buffer.name == "second.src")
        await desk.press("z", "z", "enter")
        await desk.idle()
        assert desk.output.rstrip().endswith("42")
        assert not desk.app.editor.front.is_dirty


async def test_what_is_typed_before_the_engine_is_there_is_carried_out_then(program):
    """Lines and F5 came before the first frame: nothing may wait for an engine that was never started."""
    app = DesireApp([program(OSCILLATOR)])
    async with app.run_test(size=(100, 30)) as pilot:
        app.command_line.enter(["a = 6"])
        app.command_line.enter(["write 7*a"])
        await until(pilot, lambda: "42" in app.command.console.text.splitlines())
        app.session.end()


def test_the_session_is_made_by_whoever_asks_first():
    engine = EngineThread(ScreenListener(lambda message: None), lambda message: None)
    assert engine.session is engine.session
    engine.start()
    assert engine.is_ready


def test_threads_that_ask_at_the_same_time_start_one_engine(monkeypatch):
    """Python starts a thread again until it has begun, and then takes it for dead when either ends."""
    started = []
    start = threading._start_new_thread

    def start_slowly(work, args):
        started.append(work.__self__)
        sleep(0.05)
        return start(work, args)

    engine = EngineThread(ScreenListener(lambda message: None), lambda message: None)
    monkeypatch.setattr(engine._thread, "_target", lambda: None)
    together = threading.Barrier(2)
    asking = [threading.Thread(target=lambda: (together.wait(60), engine.start())) for _ in range(2)]
    monkeypatch.setattr(threading, "_start_new_thread", start_slowly)
    for thread in asking:
        thread.start()
    for thread in [*asking, engine._thread]:
        thread.join(60)
    assert started.count(engine._thread) == 1


async def test_while_a_run_goes_on_its_step_is_seen_at_80_columns_and_the_key_that_pauses_it(program):
    async with desktop(program(LONG), size=(80, 24)) as desk:
        await desk.press("f5")
        await desk.until(lambda: desk.app.session.runs and desk.app.session.runs[0].steps)
        desk.app.show_status()
        row = desk.app.main_screen.query_one(StatusBar).render_line(0).text
        assert row.startswith(" ^C pause")
        assert "steps/s · DT 0.001" in row
        assert len(row) == 80


async def test_a_pasted_block_is_carried_out_as_a_whole_and_each_line_as_if_typed(program):
    async with desktop(program("")) as desk:
        await paste(
            desk,
            "total = 0\nfor i = 1 to 4\n  if i > 2 then\n    total = total + i\n  proceed\nnext\ntotal\n",
        )
        await desk.idle()
        assert value(desk, "total") == 7
        assert sum(line.startswith("> ") for line in desk.output.splitlines()) == 7
        assert desk.output.rstrip().endswith("7")
        assert "error" not in desk.output


async def test_a_block_that_fails_goes_back_line_by_line(program):
    async with desktop(program("")) as desk:
        held = desk.app.command.query_one(PendingLines)
        await paste(desk, "for i = 1 to 2\n  b = a*\nnext\nc = 5\n")
        await desk.until(lambda: held.display)
        assert desk.app.command.prompt.value == "for i = 1 to 2"
        await desk.press("down", "backspace", "backspace", "2", "enter")
        await desk.idle()
        assert value(desk, "b") == 2
        assert value(desk, "c") == 5


async def test_a_block_that_is_never_closed_is_reported_like_a_typed_line(program):
    async with desktop(program("")) as desk:
        await paste(desk, "for i = 1 to 2\n  a = 1\n")
        await desk.idle()
        assert "error" in desk.output


async def test_what_a_typed_command_answers_stays_in_the_output(program):
    async with desktop(program("")) as desk:
        await desk.line("theme light")
        await desk.line("snapshot")
        assert "Theme: light" in desk.output
        assert "No graph yet: press F5." in desk.output
        await desk.press("alt+t")
        assert desk.output.count("Theme:") == 1
        await desk.line("load 'nowhere.src'")
        assert desk.output.count("nowhere.src: No such file") <= 1


async def test_former_commands_are_listed_and_one_is_taken(program):
    async with desktop(program("x = 1\n")) as desk:
        prompt = desk.app.command.prompt
        for line in ("write 1 + 1", "a = 7", "write a"):
            await desk.line(line)
            await desk.idle()
        await desk.line("history")
        await desk.until(lambda: isinstance(desk.app.screen, HistoryList) and desk.app.screen.focused)
        lines = desk.app.screen.query_one(OptionList)
        assert [str(option.prompt) for option in lines.options][:4] == [
            "history",
            "write a",
            "a = 7",
            "write 1 + 1",
        ]
        await desk.press(*"wri")
        await desk.until(lambda: lines.option_count == 2)
        await desk.press("down", "enter")
        await desk.until(lambda: desk.app.screen is desk.app.main_screen)
        assert desk.app.focused is prompt
        assert prompt.value == "write 1 + 1"
        await desk.do("view.history")
        await desk.press("escape")
        assert prompt.value == "write 1 + 1"
