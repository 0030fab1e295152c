"""The tour points at panes; keys that change what the screen does say so."""

from __future__ import annotations

from desire_tui.desktop.tour import STEPS
from desire_tui.desktop.tour_note import TourNote

from .conftest import OSCILLATOR, Desktop, desktop


def note(desk: Desktop) -> TourNote | None:
    found = desk.app.main_screen.query(TourNote)
    return found.first() if found else None


def said(desk: Desktop) -> str:
    shown = note(desk)
    return str(shown.content) if shown is not None else ""


async def test_the_tour_points_at_each_pane_and_runs_lead_on():
    async with desktop(size=(80, 24)) as desk:
        await desk.until(lambda: "F5" in said(desk))
        first = note(desk)
        assert first is not None
        assert first.target is desk.app.editor
        assert desk.app.editor.has_class("-pointed")
        assert desk.app.editor.region.contains_region(first.region)
        await desk.press("f5")
        await desk.until(lambda: said(desk) == STEPS[1].sentence)
        assert not desk.app.editor.has_class("-pointed")
        assert desk.app.graph.has_class("-pointed")
        shown = note(desk)
        assert shown is not None
        await desk.until(lambda: desk.app.graph.region.contains_region(shown.region))
        for step in STEPS[2:]:
            await desk.press("alt+n")
            await desk.until(lambda step=step: said(desk) == step.sentence)
        await desk.press("alt+n")
        await desk.until(lambda: note(desk) is None)
        assert not desk.app.main_screen.query(".-pointed")


async def test_the_note_follows_the_size_and_a_small_terminal_has_sentences_instead():
    async with desktop(size=(120, 36)) as desk:
        await desk.until(lambda: note(desk))
        await desk.pilot.resize_terminal(80, 24)
        shown = note(desk)
        assert shown is not None
        await desk.until(lambda: desk.app.editor.region.contains_region(shown.region))
    async with desktop(size=(60, 16)) as desk:
        await desk.line("tour")
        await desk.press("alt+n")
        assert STEPS[1].sentence in desk.output
        assert note(desk) is None


async def test_trace_and_readout_say_what_they_do(program):
    async with desktop(program(OSCILLATOR)) as desk:
        told: list[str] = []
        desk.app.notify = lambda message, **_: told.append(message)  # type: ignore[method-assign, assignment]
        await desk.press("f5")
        await desk.idle()
        await desk.press("alt+r", "alt+r", "f12")
        assert told[0].startswith("Read-out on")
        assert told[1] == "Read-out off."
        assert told[2].startswith("Trace: the script stops before each statement. F10")
