"""`write`, `note`, `dump`: values as text for console, files and notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.number_text import (
    array_text,
    hexadecimal,
    octal,
    raw_array_text,
    raw_text,
    scalar_text,
)
from desire_tui.engine.interpreter.quantity_rows import value_text
from desire_tui.engine.nodes.expressions import Name, Text
from desire_tui.engine.values import Quantity

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.files import Dump, Note, Write, WriteItem
    from desire_tui.engine.values import Values

    Piece = Callable[[], Iterator[str]]

_SEPARATORS = {",": "\t", ";": "", "": ""}
_SETTINGS = (
    "t", "DT", "TMAX", "NN", "MM", "ERMAX", "ERMIN", "DTMAX", "DTMIN", "CHECKN", "iRow", "scale", "PI"
)  # fmt: skip
_COLUMNS, _COLUMN = 4, 24
"""Of `dump`: how many scalars a line, and their width; longer ones push the others on."""


def write(context: StatementContext, node: Write) -> Operation:
    """`write …`, `write #n, …`, `write ##n, …`."""
    line = line_of(context, node.items, raw=node.raw)
    if node.channel is None:
        return context.then(lambda: _send(context, line, context.host.write))
    number, channels = context.truncated(node.channel), context.machine.channels

    def action() -> None:
        channel = number()
        _send(context, line, lambda text: channels.write(channel, text))

    return context.then(action)


def _send(context: StatementContext, line: Piece, sink: Callable[[str], None]) -> None:
    """Send a statement's text as one piece, or a long array's in several."""
    pending: list[str] = []
    for piece in line():
        pending.append(piece)
        if len(pending) == 1000:
            sink("".join(pending))
            pending.clear()
            context.machine.check()
    if pending:
        sink("".join(pending))


def note(context: StatementContext, node: Note) -> Operation:
    """`note 'text'; x`: one line of the notebook."""
    line = line_of(context, node.items, raw=False)
    return context.then(lambda: context.host.note("".join(line()).rstrip("\n")))


def line_of(context: StatementContext, items: tuple[WriteItem, ...], *, raw: bool = False) -> Piece:
    """Return a function that yields the pieces of the text of `write`'s items."""
    pieces = [(_item(context, item, raw=raw), _SEPARATORS[item.separator]) for item in items]
    stays_open = bool(items) and items[-1].separator != ""

    def ends_line(piece: str) -> bool:
        """Whether a piece is the last line of an array (`$10` is a line end of the user's own)."""
        return piece.endswith("\n") and len(piece) > 1

    def line() -> Iterator[str]:
        last = ""
        for piece, separator in pieces:
            for last in piece():
                yield last
            if separator and not (raw and ends_line(last)):
                yield separator
        if not stays_open and not ends_line(last):
            yield "\n"

    return line


def _item(context: StatementContext, item: WriteItem, *, raw: bool) -> Piece:
    node, values = item.value, context.values
    if isinstance(node, Text):
        return lambda: iter((node.value,))
    if isinstance(node, Name) and not item.form:
        meaning = context.scope.find(node.name)
        if isinstance(meaning, Quantity) and meaning.shape:
            if raw:
                return lambda: raw_array_text(values, meaning)
            return lambda: array_text(values, meaning, node.name)
    if item.form:
        return _coded(context, item)
    value, kind = context.value(node)
    show = raw_text if raw else scalar_text
    return lambda: iter((show(value(), kind),))


def _coded(context: StatementContext, item: WriteItem) -> Piece:
    """`$n` one character, `%n` octal, `%%n` hexadecimal."""
    number, node = context.truncated(item.value), item.value
    if item.form == "$":

        def character() -> Iterator[str]:
            code = number()
            if not 0 <= code < 0x110000 or 0xD800 <= code < 0xE000:
                raise ScriptFault("character-code", node, value=code)
            yield chr(code)

        return character
    convert = octal if item.form == "%" else hexadecimal
    return lambda: iter((convert(number()),))


def dump(context: StatementContext, node: Dump) -> Operation:
    """`dump`, `dump #n`; `dump run` shows the last run's settings and counters."""
    if node.what == "run":
        return context.then(lambda: context.host.command("dump", "run"))
    if node.channel is None:
        return context.then(lambda: _send(context, lambda: all_text(context.values), context.host.write))
    number, channels = context.truncated(node.channel), context.machine.channels

    def action() -> None:
        channel = number()
        _send(context, lambda: all_text(context.values), lambda text: channels.write(channel, text))

    return context.then(action)


def all_text(values: Values) -> Iterator[str]:
    """Yield the settings, set or not, all other scalars with a value, in columns, then the arrays."""
    known = [q for q in values if values.is_defined(q)]
    settings = [values.names[name] for name in _SETTINGS]
    others = [q for q in known if not q.shape and q.name not in _SETTINGS]
    for scalars in (settings, others):
        cells = [f"{q.name} = {value_text(values, q)}" for q in scalars]
        for first in range(0, len(cells), _COLUMNS):
            yield (
                "".join((cell + " ").ljust(_COLUMN) for cell in cells[first : first + _COLUMNS]).rstrip()
                + "\n"
            )
    for quantity in known:
        if quantity.shape:
            yield from array_text(values, quantity, quantity.name)
