"""What is open when the desktop appears.

The files named, else the last session's, else an example with a tour.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.common.dialogs import Choice
from desire_tui.common.paths import examples_folder
from desire_tui.editor import recovery
from desire_tui.editor.buffer import Buffer
from desire_tui.engine.program_files import exists, is_folder
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from desire_tui.app import DesireApp

FIRST_EXAMPLES = ("ch1/step_response.src", "ch1/van_der_pol.src")


async def open_first(app: DesireApp) -> None:
    """Open the tabs; the command line gets the focus if there is something to run."""
    await app.editor.add(Buffer())
    if app.files:
        for number, path in enumerate(app.files):
            if not exists(path) and is_folder(path.parent):
                await app.editor.add(Buffer(path.resolve()), "", front=number == 0)
            else:
                await app.file_actions.open_path(path, focus=False)
        named = [a for a in app.editor.areas if a.buffer.path == app.files[0].expanduser().resolve()]
        if named:
            app.editor.show(named[0])
    elif not (app.settings.restore_session and await app.checkpoints.restore()):
        await _first_example(app)
    blank = next((a for a in app.editor.areas if a.buffer.path is None and not a.text), None)
    if blank is not None and len(app.editor.areas) > 1:
        await app.editor.close_tab(blank)
    (app.command.prompt if app.editor.front.text.strip() else app.editor.front).focus()
    app.run_worker(_offer_recovery(app), name="recovery")


async def _first_example(app: DesireApp) -> None:
    folder = examples_folder()
    found = next((folder / name for name in FIRST_EXAMPLES if (folder / name).exists()), None)
    found = found or next(iter(sorted(folder.rglob("*.src"))), None)
    if found is None:
        return
    try:
        await app.file_actions.open_example(found, found.read_text(encoding="utf-8"))
    except OSError:
        return
    if not app.tour.was_taken:
        app.tour.begin()


async def _offer_recovery(app: DesireApp) -> None:
    found, unreadable = recovery.leftovers()
    for file in unreadable:
        recovery.set_aside(file)
        app.report_error(
            f"{file} was left by another version or is damaged; "
            f"it is kept as {file.with_suffix('.unread').name}",
            code=None,
        )
    for leftover in found:
        names = ", ".join(visible_line(tab.label) for tab in leftover.tabs)
        choice = await app.push_screen_wait(
            Choice(
                "Unsaved work found",
                f"Desire ended without saving {names}.",
                ("Restore", "Later", "Discard"),
                unasked=True,
                safe="Later",
            )
        )
        if choice == "Restore":
            await app.checkpoints.adopt(leftover)
        elif choice == "Discard":
            leftover.file.unlink(missing_ok=True)
