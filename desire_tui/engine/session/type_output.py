"""Writes the samples of a `type` request as they come."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.runtime import type_listing

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.lowered.segment import SampleRequest
    from desire_tui.engine.runtime.run_record import RunRecord


class TypeOutput:
    """Observes one run; silent where it has no `type` line. The header comes at once."""

    def __init__(
        self, record: RunRecord, console: Callable[[str], object], channel: Callable[[int, str], object]
    ) -> None:
        self._console, self._channel = console, channel
        self._request: SampleRequest | None = next((r for r in record.requests if r.kind == "type"), None)
        if self._request is not None:
            self._first = record.first_column(self._request)
            self._write(self._request, type_listing.header(self._request) + "\n")

    def block(self, record: RunRecord, first_row: int) -> None:
        """Write the new samples."""
        if self._request is not None:
            rows = record.rows[first_row : record.count]
            self._write(self._request, type_listing.lines(rows, self._first, len(self._request.columns)))

    def _write(self, request: SampleRequest, text: str) -> None:
        if request.channel is None:
            self._console(text)
        else:
            self._channel(request.channel, text)
