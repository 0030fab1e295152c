"""The user's own editor for a while."""

from __future__ import annotations

import os
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
from contextlib import contextmanager, suppress
from pathlib import Path
from select import POLLHUP, poll
from typing import TYPE_CHECKING

from textual.app import App, SuspendNotSupported

from desire_tui.editor import line_ends

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.editor.code_area import CodeArea


_LOOK_S = 1.0
"""So often it is looked whether the terminal is still there."""
_END_S = 2.0
"""So long an editor without a terminal may take to end."""


class _Refused(Exception):  # noqa: N818 - a statement to the user
    """Why there is no text from the editor."""


def edit_outside(app: App[None], area: CodeArea) -> None:
    """Stop the screen, start $VISUAL or $EDITOR on a copy of the text, take the text back as one change.

    The text as it stands in the tab is edited, saved or not. Whatever goes wrong leaves it unchanged.
    """
    try:
        text = _edited(app, _command(), area)
    except _Refused as reason:
        app.notify(f"{reason}; the text is unchanged.", severity="error", markup=False, timeout=6)
        return
    if not area.text.endswith("\n"):
        text = text.removesuffix("\n")  # most editors add one
    if text == area.text:
        return
    row, column = area.cursor_location
    document, lines = area.document, text.split("\n")
    ends = line_ends.following(document.lines, document.ends, lines, document.usual_end)
    area.rewrite_rows(0, document.line_count - 1, lines, ends)
    area.go_to(row, column)


def _command() -> list[str]:
    wanted = os.environ.get("VISUAL") or os.environ.get("EDITOR") or "vi"
    try:
        words = shlex.split(wanted)
    except ValueError:
        words = []
    if not words or shutil.which(words[0]) is None:
        raise _Refused(f"No editor '{wanted}': set $EDITOR")
    return words


def _edited(app: App[None], words: list[str], area: CodeArea) -> str:
    with tempfile.TemporaryDirectory(prefix="desire-") as folder:
        copy = Path(folder) / (area.buffer.path.name if area.buffer.path else "program.src")
        fault: OSError | None = None
        status = 0
        try:
            copy.write_text(area.text, encoding="utf-8", errors="surrogatepass")
            with app.suspend(), _interrupts_left_to_the_editor():
                try:
                    editor = subprocess.Popen([*words, str(copy)])  # noqa: S603 - the user's own choice
                    status = _waited_for(editor, sys.__stdin__.fileno() if sys.__stdin__ else 0)
                except OSError as error:  # leaving `suspend` by an exception would leave the screen stopped
                    fault = error
            text = copy.read_text(encoding="utf-8", errors="replace")
        except SuspendNotSupported:
            raise _Refused("This terminal cannot be handed to another program") from None
        except OSError as error:
            fault = fault or error
        if fault is not None:
            raise _Refused(f"{words[0]}: {fault.strerror}") from None
        if status:
            end = f"was ended by signal {-status}" if status < 0 else f"ended with status {status}"
            raise _Refused(f"{words[0]} {end}")
        return text


def _waited_for(editor: subprocess.Popen[bytes], terminal: int) -> int:
    """Wait for the editor, and end it if its terminal has gone; return its status.

    Most editors end by themselves then; one that does not would keep the desktop waiting for ever.
    """
    watched = poll()
    watched.register(terminal, 0)
    while True:
        with suppress(subprocess.TimeoutExpired):
            return editor.wait(_LOOK_S)
        if any(happened & POLLHUP for _, happened in watched.poll(0)):
            break
    editor.send_signal(signal.SIGHUP)  # vi keeps its work at this one
    with suppress(subprocess.TimeoutExpired):
        return editor.wait(_END_S)
    editor.kill()
    return editor.wait()


@contextmanager
def _interrupts_left_to_the_editor() -> Iterator[None]:
    """Ctrl+C in the editor reaches this process too and must not end it."""
    before = signal.signal(signal.SIGINT, lambda *_: None)  # a handler, unlike SIG_IGN, is not inherited
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
