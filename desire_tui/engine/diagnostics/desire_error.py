"""A user's mistake as an exception."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import replace
from desire_tui.engine.diagnostics.render import render_all

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics.diagnostic import Diagnostic
    from desire_tui.engine.source import Source, Span


class DesireError(Exception):
    """A user's mistake, on its way to the one place that shows it.

    `diagnostics` holds at least one; `number`, `file`, `line`, `column`, `message` and `hint` are those
    of the first. As text it is the message as it is drawn: the program's line, the place underlined, a hint.
    """

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__(*(d.key for d in diagnostics))
        self.diagnostics = diagnostics

    def placed(self, span: Span, source: Source | None) -> DesireError:
        """Return the error with problems that have no place of their own placed here."""
        if all(d.span is not None for d in self.diagnostics):
            return self
        return DesireError(
            *(
                d if d.span is not None else replace(d, span=span, source=d.source or source)
                for d in self.diagnostics
            )
        )

    @property
    def number(self) -> int:
        """Desire's error number."""
        return self.diagnostics[0].code

    @property
    def file(self) -> str | None:
        """Name of the program's file."""
        return self.diagnostics[0].file

    @property
    def line(self) -> int | None:
        """Line in it, from 1; None: it has no place there."""
        return self.diagnostics[0].line

    @property
    def column(self) -> int | None:
        """Column in the line, from 1."""
        return self.diagnostics[0].column

    @property
    def message(self) -> str:
        """What is wrong, without a place."""
        return self.diagnostics[0].message

    @property
    def hint(self) -> str | None:
        """What to do about it."""
        return self.diagnostics[0].hint

    def __str__(self) -> str:
        return render_all(self.diagnostics)

    def __reduce__(self) -> tuple[type[DesireError], tuple[Diagnostic, ...]]:
        return DesireError, self.diagnostics
