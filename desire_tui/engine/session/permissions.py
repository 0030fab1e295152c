"""What a program may do to the machine (language.md 15): its own folder is free, all else is asked for."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.visible_text import visible_whole

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Ask = Callable[["PermissionRequest"], bool]

Wish = Literal["shell", "read", "write"]


@dataclass(frozen=True, slots=True)
class PermissionRequest:
    """Something a program wants to do: run `what` in a shell, read or write the file `what`."""

    wish: Wish
    what: str

    @property
    def sentence(self) -> str:
        """Plain words for a dialog."""
        verbs = {"shell": "run the shell command", "read": "read the file", "write": "write the file"}
        return f"{verbs[self.wish]}\n\n{visible_whole(self.what)}"


@dataclass
class Permissions:
    """Flags of the command line; what is not allowed by a flag is asked of the front end and remembered."""

    shell: bool = False
    files: bool = False
    asks: bool = True
    """Whether there is somebody who may allow more: not a visitor of a served desktop."""
    granted: set[PermissionRequest] = field(default_factory=set)

    def shell_command(self, command: str, ask: Ask) -> None:
        """Return if the command may run; DesireError 450 if not."""
        request = PermissionRequest("shell", command)
        if not (self.shell or self._granted(request, ask)):
            raise DesireError(Diagnostic("shell-refused", facts={"command": command}))

    def file(self, path: Path, mode: Literal["read", "write"], folder: Path, ask: Ask) -> Path:
        """Return the absolute path of a file the program may open; DesireError 451 if it may not.

        Relative paths start at the program's folder; links are followed before the path is judged.
        """
        home = folder.expanduser().resolve()
        target = (home / path.expanduser()).resolve()
        request = PermissionRequest(mode, str(target))
        if target.is_relative_to(home) or self.files or self._granted(request, ask):
            return target
        raise DesireError(Diagnostic("file-refused", facts={"path": target, "folder": home, "mode": mode}))

    def _granted(self, request: PermissionRequest, ask: Ask) -> bool:
        if request not in self.granted and self.asks and ask(request):
            self.granted.add(request)
        return request in self.granted
