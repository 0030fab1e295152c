"""Files connected to channels 0 … 10 (book, sections 5.4.1.2 to 5.4.2.2)."""

from __future__ import annotations

from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import IO, TYPE_CHECKING, Literal

from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.program_files import open_for_program

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from desire_tui.engine.data_files.data_table import DataTable
    from desire_tui.engine.interpreter.host import Host

MOST_CHANNELS = 10
_APPENDING = {0, 1}
_DEFAULT_ENDING = ".dat"
_TABLE_ENDINGS = {".csv", ".tsv"}
_BYTE_ORDER_MARK = "\ufeff"
_COMMENT = "#"


@dataclass(slots=True)
class Channel:
    """An open file."""

    path: Path
    mode: Literal["input", "output"]
    file: IO[str]
    line: int = 0
    """Number of the line read last."""
    table: DataTable | None = None
    waiting: list[tuple[int, str]] = field(default_factory=list)
    """Lines that were looked at and hold values, with their numbers, the next one last."""

    def next_line(self) -> str | None:
        """Return the next line without its end and without comments (`#`); None at the end of the file."""
        if self.waiting:
            self.line, text = self.waiting.pop()
            return text
        while line := self.file.readline():
            self.line += 1
            if self.line == 1:
                line = line.removeprefix(_BYTE_ORDER_MARK)
            text, comment, _ = line.rstrip("\r\n").partition(_COMMENT)
            if text.strip() or not comment:
                return text
        return None

    def lines(self) -> Iterator[tuple[int, str]]:
        """Yield the lines that hold anything, with their numbers."""
        while (line := self.next_line()) is not None:
            if line.strip():
                yield self.line, line

    def look_for_names(self, is_value: Callable[[str], bool]) -> None:
        """If nothing was read yet, see whether the first line that holds anything names columns."""
        if self.line or self.waiting:
            return
        # few programs read files: 1 ms
        from desire_tui.engine.data_files.data_table import (
            DataTable,
            begins_with_number,
            column_names,
            separator_of,
        )

        is_table = self.path.suffix.lower() in _TABLE_ENDINGS
        looked_at = list(islice(self.lines(), 1 if is_table else 2))
        self.waiting = looked_at[::-1]
        if not looked_at or not (is_table or begins_with_number(looked_at[-1][1])):
            return
        first = looked_at[0][1]
        names = column_names(first, None if is_table else is_value)
        if names is not None:
            self.table = DataTable(names, separator_of(first))
            self.waiting.pop()


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
        with _reading(channel):
            line = channel.next_line()
        if line is None:
            raise _problem("file-ended", file=channel.path.name, channel=number)
        return line

    def table(self, number: int, is_value: Callable[[str], bool]) -> DataTable | None:
        """Return the names of an input channel's columns; None for a file of values alone.

        `is_value`: whether a name has a value, so that a line of such names is one of values.
        """
        channel = self._channel(number, "input")
        with _reading(channel):
            channel.look_for_names(is_value)
        return channel.table

    def name_of(self, number: int) -> str:
        """Return the name of an input channel's file."""
        return self._channel(number, "input").path.name

    def columns(
        self, number: int, wanted: Sequence[int], rows: int, check: Callable[[], object]
    ) -> list[list[float]]:
        """Return some columns of a table's next rows, calling `check` now and then.

        Error 18: there are fewer rows, or no number.
        """
        channel = self._channel(number, "input")
        table, name = channel.table, channel.path.name
        assert table is not None
        with _reading(channel):
            columns = table.columns(islice(channel.lines(), rows), wanted, name, check)
        if (left := len(columns[0])) < rows:
            key = "rows-missing" if left or rows > 1 else "file-ended"
            raise _problem(key, file=name, channel=number, rows=left, needed=rows)
        return columns

    def _channel(self, number: int, mode: Literal["input", "output"]) -> Channel:
        _check_number(number)
        channel = self._open.get(number)
        if channel is None:
            raise _problem("channel-not-connected", channel=number)
        if channel.mode != mode:
            raise _problem("channel-wrong-way", channel=number, mode=channel.mode, wanted=mode)
        return channel


@contextmanager
def _reading(channel: Channel) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise _problem("cannot-read", file=channel.path, reason=error.strerror) from None


def _check_number(number: int) -> None:
    if not 0 <= number <= MOST_CHANNELS:
        raise _problem("channel-number", channel=number)


def _problem(key: str, **facts: object) -> DesireError:
    return DesireError(Diagnostic(key, facts=facts))
