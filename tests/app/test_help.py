"""The help pane: search, pages, links by digit and by mouse, the way back."""

from __future__ import annotations

from textual.widgets import Input, Markdown, OptionList

from desire_tui.panes.help_pane import LinkRow

from .conftest import OSCILLATOR, desktop


def page(desk) -> str:
    found = desk.app.help_pane.query(Markdown)
    return found.first().source if found else ""


def links(desk) -> str:
    return str(desk.app.help_pane.query_one(LinkRow).render())


async def search(desk, text: str) -> list[str]:
    await desk.do("help.word")
    field = desk.app.help_pane.query_one("#help-search", Input)
    field.focus()
    field.value = ""
    await desk.pilot.pause()
    await desk.press(*text)
    hits = desk.app.help_pane.query_one(OptionList)
    await desk.until(lambda: hits.display and hits.option_count)
    await desk.pilot.pause()
    return [hits.get_option_at_index(n).id for n in range(hits.option_count)]


async def test_f1_explains_the_word_at_the_cursor(program):
    async with desktop(program(OSCILLATOR)) as desk:
        area = desk.app.editor.front
        area.focus()
        area.move_cursor((2, 2))  # irule
        await desk.press("f1")
        await desk.until(lambda: page(desk).startswith("# irule"))


async def test_a_search_lists_the_likeliest_first_and_enter_opens_it(program):
    async with desktop(program(OSCILLATOR), size=(140, 44)) as desk:
        assert (await search(desk, "phase plane"))[0] == "phase"
        await desk.press("enter")
        await desk.until(lambda: page(desk).startswith("# phase"))
        found = await search(desk, "TMXA")
        assert found[0] == "TMAX"
        await desk.press("down", "down", "enter")
        await desk.until(lambda: page(desk).startswith(f"# {found[1]}"))


async def test_links_are_followed_by_digits_and_backspace_leads_back(program):
    async with desktop(program(OSCILLATOR), size=(140, 44)) as desk:
        await desk.do("help.word", "DT")
        await desk.until(lambda: page(desk).startswith("# DT"))
        assert "1 ERMAX" in links(desk)
        assert "back" not in links(desk)
        assert "See also" not in page(desk)
        await desk.press("2")
        await desk.until(lambda: page(desk).startswith("# irule"))
        assert "back" in links(desk)
        await desk.press("9")  # there may be no such link: nothing happens
        await desk.press("backspace")
        await desk.until(lambda: page(desk).startswith("# DT"))
        await desk.press("backspace")  # the first page stays
        assert page(desk).startswith("# DT")


async def test_links_are_followed_by_the_mouse(program):
    async with desktop(program(OSCILLATOR), size=(140, 44)) as desk:
        await desk.do("help.word", "DT")
        await desk.until(lambda: "1 ERMAX" in links(desk))
        await desk.pilot.click(LinkRow, offset=(4, 0))
        await desk.until(lambda: page(desk).startswith("# ERMAX"))


async def test_a_page_of_the_desktop_tells_its_keys(program):
    async with desktop(program(OSCILLATOR), size=(140, 44)) as desk:
        await desk.do("help.word", "live")
        await desk.until(lambda: page(desk).startswith("# live mode"))
        assert "| Alt+L | Live mode | `live` |" in page(desk)


async def test_the_first_page_leads_on_and_digits_typed_in_the_search_stay_there(program):
    async with desktop(program(OSCILLATOR), size=(140, 44)) as desk:
        found = await search(desk, "94")
        assert found[0] == "error 94"
        await desk.do("help.word", "")
        desk.app.help_pane.show_topic("")
        await desk.until(lambda: "1 first steps" in links(desk))
        await desk.press("down", "1")
        await desk.until(lambda: page(desk).startswith("# first steps"))


async def test_every_page_is_shown(program):
    from desire_tui.help.page_catalogue import topics

    async with desktop(program(OSCILLATOR), size=(140, 44)) as desk:
        await desk.do("help.word", "DT")
        for name in list(topics())[::25]:
            desk.app.help_pane.show_topic(name)
            await desk.until(lambda name=name: page(desk).startswith(f"# {name}\n"))
