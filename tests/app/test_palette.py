"""The command palette finds an action by what it does, in the words of other programs too."""

from __future__ import annotations

from textual.widgets import OptionList

from desire_tui.commands import BY_ID
from desire_tui.common.command_search import SYNONYMS

from .conftest import Desktop, desktop


async def found(desk: Desktop, query: str) -> list[str]:
    await desk.press("ctrl+p", *query)
    screen = desk.app.screen
    hits = screen.query_one(OptionList)
    await desk.until(
        lambda: hits.option_count and "No matches" not in str(hits.get_option_at_index(0).prompt)
    )
    await desk.pilot.pause(0.3)
    shown = [str(hits.get_option_at_index(n).prompt) for n in range(hits.option_count)]
    await desk.press("escape")
    return shown


async def test_synonyms_lead_to_actions(program):
    titles = {
        "csv": "Export samples", "slider": "Live mode", "autoscale": "Fit", "png": "Snapshot", "shortcuts": "Keys",
        "typo": "Take the suggestion",
    }  # fmt: skip
    async with desktop(program("x = 1\n")) as desk:
        for query, title in titles.items():
            assert any(title in hit for hit in (await found(desk, query))[:2]), query
            await desk.until(lambda: desk.app.screen is desk.app.main_screen)


async def test_titles_stand_above_descriptions(program):
    async with desktop(program("x = 1\n")) as desk:
        assert "Save" in (await found(desk, "save"))[0]


def test_every_synonym_belongs_to_an_action():
    assert set(SYNONYMS) <= set(BY_ID)
