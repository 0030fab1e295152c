"""From the first start to a saved picture of a model of one's own, fitted, without the manual: docs/newcomer.md."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.common.dialogs import LineDialog
from desire_tui.desktop.tour_note import TourNote

from .conftest import desktop

if TYPE_CHECKING:
    from pathlib import Path

MODEL = """\
TMAX = 30 | DT = 0.01 | NN = 301
hares = 40 | foxes = 9
drun
DYNAMIC
d/dt hares = 0.5*hares - 0.02*hares*foxes
d/dt foxes = -0.8*foxes + 0.01*hares*foxes
dispt hares, foxes
"""
ACTIONS_MOST = 12


async def test_a_newcomer_saves_a_picture_of_his_own_model(tmp_path: Path):
    actions = 0
    async with desktop(size=(100, 30)) as desk:  # action 1 was to start
        app = desk.app

        async def act(*keys: str) -> None:
            nonlocal actions
            actions += 1
            await desk.press(*keys)
            await desk.pilot.pause()

        actions += 1
        await desk.until(lambda: app.main_screen.query(TourNote))  # "F5 runs it", it says at the program
        await act("f5")
        await desk.idle()
        assert app.graph.page is not None
        shown = {hint.key: hint.title for hint in app.main_screen.status_bar.keys}
        assert shown["^P"] == "palette"
        await act("ctrl+p")  # the row below names it: the palette has all actions
        await act(*"new tab")
        await desk.until(
            lambda: app.screen.query("OptionList") and app.screen.query_one("OptionList").option_count
        )
        await act("enter")
        await desk.until(lambda: app.editor.front.text == "" and app.screen is app.main_screen)
        actions += 1  # types the model
        app.editor.front.insert(MODEL)
        await act("f5")
        await desk.until(lambda: "hares" in str([graph.keys for graph in app.session.graphs]))
        await desk.idle()
        app.graph.tick()
        assert app.graph.fit.is_on  # nothing to be done for it: no curve lies outside
        assert "outside" not in app.graph.fit.notice
        await act("ctrl+p")
        await act(*"png")
        await desk.until(
            lambda: app.screen.query("OptionList") and app.screen.query_one("OptionList").option_count
        )
        await act("enter")
        await desk.until(lambda: isinstance(app.screen, LineDialog))
        await act("enter")  # the name proposed
        await desk.until(lambda: list(app.session.folder.glob("*.png")))
    (picture,) = app.session.folder.glob("*.png")
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert actions <= ACTIONS_MOST
