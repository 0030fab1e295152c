"""A model of another program is offered as the Desire program that it becomes."""

from __future__ import annotations

from desire_tui.common.dialogs import Choice
from tests.app.conftest import desktop

SWING = "# a swing\nx'=v\nv'=-sin(x)\ninit x=1\n@ total=5\ndone\n"


async def asked(desk, path) -> None:
    await desk.line(f"load '{path}'")
    await desk.until(lambda: isinstance(desk.app.screen, Choice))


async def test_it_opens_as_a_program_that_runs(program, tmp_path):
    (tmp_path / "swing.ode").write_text(SWING)
    async with desktop(program("y = 1\n")) as desk:
        await asked(desk, tmp_path / "swing.ode")
        await desk.press("c")
        await desk.until(lambda: desk.app.editor.front.buffer.name == "swing.src")
        text = desk.app.editor.front.text
        assert text.startswith("-- swing -- converted from swing.ode (XPPAUT)\n-- a swing\n")
        assert "d/dt v = -sin(x)" in text
        assert desk.app.editor.front.buffer.path is None  # the model's file is not written over


async def test_it_opens_as_text_or_not_at_all(program, tmp_path):
    (tmp_path / "swing.ode").write_text(SWING)
    async with desktop(program("y = 1\n")) as desk:
        await asked(desk, tmp_path / "swing.ode")
        await desk.press("escape")
        await desk.until(lambda: desk.app.screen is desk.app.main_screen)
        assert len(desk.app.editor.areas) == 1
        await asked(desk, tmp_path / "swing.ode")
        await desk.press("o")
        await desk.until(lambda: desk.app.editor.front.buffer.name == "swing.ode")
        assert desk.app.editor.front.text == SWING


async def test_what_is_missing_or_unreadable_is_said(program, tmp_path):
    (tmp_path / "half.ode").write_text("x'=-x\nspecial k=fconv(even,5,1,w,x,x,f)\n")
    (tmp_path / "no.xml").write_text("<sbml>")
    async with desktop(program("y = 1\n")) as desk:
        await asked(desk, tmp_path / "half.ode")
        await desk.press("c")
        await desk.until(lambda: desk.app.errors_reported == 1)
        assert (
            "-- ! line 2: 'special k=fconv(even,5,1,w,x,x,f)' is not converted" in desk.app.editor.front.text
        )
        await asked(desk, tmp_path / "no.xml")
        await desk.press("c")
        await desk.until(lambda: desk.app.errors_reported == 2)
        assert len(desk.app.editor.areas) == 2
