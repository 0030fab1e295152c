"""Questions to the user."""

from __future__ import annotations

from desire_tui.common.dialogs import Choice, LineDialog

from .conftest import Desktop, desktop


async def ask(desk: Desktop, dialog: Choice | LineDialog) -> list[str | None]:
    answers: list[str | None] = []
    desk.app.push_screen(dialog, answers.append)  # type: ignore[arg-type]
    await desk.until(lambda: desk.app.screen is dialog)
    return answers


async def test_two_keys_at_once_are_one_answer(program):
    async with desktop(program("x = 1\n")) as desk:
        answers = await ask(desk, Choice("Q", "?", ("Restore", "Discard")))
        choice = desk.app.screen
        assert isinstance(choice, Choice)
        choice.dismiss("Restore")
        choice.dismiss("Discard")
        await desk.pilot.pause()
        assert answers == ["Restore"]
        answers = await ask(desk, LineDialog("Name", "a"))
        line = desk.app.screen
        assert isinstance(line, LineDialog)
        line.dismiss("a")
        line.dismiss("")
        await desk.pilot.pause()
        assert answers == ["a"]
        assert desk.app.screen is desk.app.main_screen


async def test_what_is_typed_while_a_question_comes_up_is_no_answer(program, monkeypatch):
    async with desktop(program("x = 1\n")) as desk:
        monkeypatch.setattr("desire_tui.common.dialogs.GRACE_SECONDS", 1e6)
        answers = await ask(desk, Choice("Unsaved work", "?", ("Restore", "Discard"), unasked=True))
        await desk.press("d", "enter", "escape")
        assert answers == []
        monkeypatch.setattr("desire_tui.common.dialogs.GRACE_SECONDS", 0.0)
        await desk.press("d")
        assert answers == ["Discard"]
        answers = await ask(desk, Choice("Asked for", "?", ("Yes", "No")))
        monkeypatch.setattr("desire_tui.common.dialogs.GRACE_SECONDS", 1e6)
        await desk.press("y")
        assert answers == ["Yes"]
