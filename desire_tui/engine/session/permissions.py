"""What a program may do to the machine (language.md 15): data in its own folder; all else is asked for."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.program_files import exists, irregular_kind, is_folder
from desire_tui.engine.session.made_files import MadeFiles
from desire_tui.engine.visible_text import visible_whole

if TYPE_CHECKING:
    from collections.abc import Callable

    Ask = Callable[["PermissionRequest"], bool]

Wish = Literal["shell", "read", "write"]

DATA_ENDINGS = frozenset({".dat", ".csv", ".npy", ".npz"})
"""Files that programs write again at each run: nobody asks before."""
OTHER_ENDINGS = frozenset(
    {".txt", ".tsv", ".json", ".log", ".out", ".md", ".markdown", ".png", ".svg", ".pdf"}
)
"""What else programs write: text, pictures, notebooks."""


@dataclass(frozen=True, slots=True)
class PermissionRequest:
    """Something a program wants to do: run `what` in a shell, read or write the file `what`."""

    wish: Wish
    what: str
    reason: str = field(default="", compare=False)
    """Why a file is asked for: "outside its folder /home/me/models"."""

    @property
    def sentence(self) -> str:
        """Plain words for a dialog."""
        verbs = {"shell": "run the shell command", "read": "read the file", "write": "write the file"}
        why = f", {visible_whole(self.reason)}" if self.reason else ""
        return f"{verbs[self.wish]}{why}\n\n{visible_whole(self.what)}"


@dataclass(frozen=True, slots=True)
class Asker:
    """The program that wants something."""

    folder: Path
    program: Path | None
    """Its file; None: it has none."""


@dataclass
class Permissions:
    """Flags of the command line; what is not allowed by a flag is asked of the front end and remembered."""

    shell: bool = False
    files: bool = False
    asks: bool = True
    """Whether there is somebody who may allow more: not a visitor of a served desktop."""
    has_folder: bool = True
    """Whether the program has a folder of its own; one that came through a pipe has not."""
    granted: set[tuple[Asker, PermissionRequest]] = field(default_factory=set)
    made: MadeFiles = field(default_factory=MadeFiles)

    def shell_command(self, command: str, asker: Asker, ask: Ask) -> None:
        """Return if the command may run; DesireError 450 if not."""
        if not (self.shell or self._granted(asker, PermissionRequest("shell", command), ask)):
            raise DesireError(Diagnostic("shell-refused", facts={"command": command}))

    def file(self, path: Path, mode: Literal["read", "write"], asker: Asker, ask: Ask) -> Path:
        """Return the absolute path of a file the program may open; DesireError 451 if it may not.

        Relative paths start at the program's folder; links are followed before the path is judged.
        """
        folder = asker.folder
        try:
            target = Path(os.path.realpath(folder / os.path.expanduser(path)))  # noqa: PTH111 - ~nobody is no error
        except ValueError:  # a NUL or half a character
            raise _refusal(mode, repr(str(path)), "which cannot be a file's name") from None
        if (kind := irregular_kind(target)) is not None:
            raise _refusal(mode, target, f"which is {kind}, not a file")
        reason = None if self.files else self._objection(target, mode, asker)
        if reason is not None:
            request = PermissionRequest(mode, str(target), reason)
            if not self._granted(asker, request, ask):
                raise _refusal(mode, target, reason)
        if mode == "write" and (reason is not None or not exists(target)):
            self.made.add(asker.program, target)
        return target

    def _objection(self, target: Path, mode: Literal["read", "write"], asker: Asker) -> str | None:
        """Return why a file is asked for; None: the program may open it."""
        folder, ending = asker.folder, target.suffix.lower()
        if not target.is_relative_to(folder):
            return f"outside its folder {folder}"
        if any(part.startswith(".") for part in target.relative_to(folder).parts):
            return "which is hidden"
        if is_folder(target):
            return None  # opening it fails, with a better reason
        if mode == "write" and ending not in DATA_ENDINGS | OTHER_ENDINGS:
            return "which is neither data nor text nor a picture"
        if self.made.has(asker.program, target):
            return None
        if not self.has_folder:
            return "although it has no folder of its own"
        if _home().is_relative_to(folder):
            return f"in {folder}, where more than its own files are"
        if mode == "write" and ending not in DATA_ENDINGS and exists(target):
            return "which it did not make"
        return None

    def _granted(self, asker: Asker, request: PermissionRequest, ask: Ask) -> bool:
        key = (asker, request)
        if key not in self.granted and self.asks and ask(request):
            self.granted.add(key)
        return key in self.granted


def _home() -> Path:
    return Path(os.path.realpath(os.path.expanduser("~")))  # noqa: PTH111 - never fails, unlike pathlib's


def _refusal(mode: str, path: object, reason: str) -> DesireError:
    return DesireError(Diagnostic("file-refused", facts={"path": path, "mode": mode, "reason": reason}))
