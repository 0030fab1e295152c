"""Files connected to channels 0 … 10 (book, sections 5.4.1.2 to 5.4.2.2)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Literal

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.program_files import open_for_program

if TYPE_CHECKING:
    from desire_tui.engine.interpreter.host import Host

MOST_CHANNELS = 10
_APPENDING = {0, 1}
_DEFAULT_ENDING = ".dat"


@dataclass(slots=True)
class Channel:
    """An open file."""

    path: Path
    mode: Literal["input", "output"]
    file: IO[str]


class Channels:
    """The connected files by channel number."""

    def __init__(self, host: Host) -> None:
        self._host = host
        self._open: dict[int, Channel] = {}

    def connect(self, name: str, mode: Literal["input", "output"], number: int) -> None:
        """Connect a file; errors 11, 30, 34, 38, 50, and 451 where the host forbids it."""
        _check_number(number)
        if number in self._open:
            raise _problem("channel-connected", channel=number, file=self._open[number].path.name)
        if not name.strip():
            raise _problem("file-name-missing")
        path = Path(name.strip())
        if not path.name or path.name == ".." or "\0" in name:
            raise _problem("cannot-connect", file=name.strip(), reason="this is no file's name")
        if not path.suffix:
            path = path.with_name(path.name + _DEFAULT_ENDING)
        path = self._host.permit(path, "read" if mode == "input" else "write")
        how: Literal["r", "w", "a"] = "r" if mode == "input" else "a" if number in _APPENDING else "w"
        try:
            file = open_for_program(path, how)
        except FileNotFoundError:
            key = "data-file-not-found" if mode == "input" else "cannot-connect"
            raise _problem(key, file=path, reason="its folder does not exist") from None
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise _problem("cannot-connect", file=path, reason=reason) from None
        self._open[number] = Channel(path, mode, file)

    def disconnect(self, number: int) -> None:
        """Close a channel's file, if there is one; error 106 if its last text could not be written."""
        _check_number(number)
        channel = self._open.pop(number, None)
        if channel is None:
            return
        try:
            channel.file.close()
        except OSError as error:
            raise _problem("cannot-write", file=channel.path, reason=error.strerror) from None

    def close(self) -> None:
        """Close everything; error 106 for files whose last text could not be written."""
        problems: list[Diagnostic] = []
        for number in list(self._open):
            try:
                self.disconnect(number)
            except DesireError as error:
                problems.extend(error.diagnostics)
        if problems:
            raise DesireError(*problems)

    def flush(self) -> None:
        """Let other programs see what was written so far."""
        for channel in self._open.values():
            if channel.mode == "output":
                try:
                    channel.file.flush()
                except OSError as error:
                    raise _problem("cannot-write", file=channel.path, reason=error.strerror) from None

    def write(self, number: int, text: str) -> None:
        """Write to an output channel; errors 64 and 106."""
        channel = self._channel(number, "output")
        try:
            channel.file.write(text)
        except OSError as error:
            raise _problem("cannot-write", file=channel.path, reason=error.strerror) from None

    def read_line(self, number: int) -> str:
        """Return the next line of an input channel without its end; error 18 at the end of the file."""
        channel = self._channel(number, "input")
        try:
            line = channel.file.readline()
        except OSError as error:
            raise _problem("cannot-read", file=channel.path, reason=error.strerror) from None
        if not line:
            raise _problem("file-ended", file=channel.path.name, channel=number)
        return line.rstrip("\r\n")

    def _channel(self, number: int, mode: Literal["input", "output"]) -> Channel:
        _check_number(number)
        channel = self._open.get(number)
        if channel is None:
            raise _problem("channel-not-connected", channel=number)
        if channel.mode != mode:
            raise _problem("channel-wrong-way", channel=number, mode=channel.mode, wanted=mode)
        return channel


def _check_number(number: int) -> None:
    if not 0 <= number <= MOST_CHANNELS:
        raise _problem("channel-number", channel=number)


def _problem(key: str, **facts: object) -> DesireError:
    return DesireError(Diagnostic(key, facts=facts))
