"""Models of other programs, opened as the Desire programs that they become."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from desire_tui.common.dialogs import Choice
from desire_tui.editor.buffer import Buffer

if TYPE_CHECKING:
    from pathlib import Path

    from desire_tui.app import DesireApp


async def converted(app: DesireApp, path: Path) -> bool:
    """Offer to convert a file; True: a tab with the program was opened, or the user was told why not."""
    sentence = f"{path.name} is a model of another program. Convert it?"
    answer = await app.push_screen_wait(Choice("Open", sentence, ("Convert", "Open as text")))
    if answer != "Convert":
        return answer is None
    from desire_tui.convert.conversion import convert
    from desire_tui.engine.diagnostics import DesireError
    from desire_tui.engine.files import read_source

    try:
        conversion = await asyncio.to_thread(lambda: convert(read_source(path)))
    except DesireError as error:
        hint = f" ({error.hint})" if error.hint else ""
        app.report_error(f"{error.message}{hint}", code=error.number)
        return True
    area = await app.editor.add(Buffer(label=f"{path.stem}.src"), conversion.text)
    app.move_focus(area)
    if not conversion.complete:
        app.report_error(
            "parts of the model are missing: they are named at the head of the program", code=560
        )
    return True
