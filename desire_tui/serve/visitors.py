"""The visitors: a token for each, and one desktop at a time for each token."""

from __future__ import annotations

import asyncio
import hmac
import secrets
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

_TOKEN_BYTES = 32


class InUse(Exception):  # noqa: N818 - an answer, not a fault
    """Somebody is connected with this token."""


@dataclass(eq=False)
class Visitor:
    """Whoever has this token."""

    token: str = field(default_factory=lambda: secrets.token_urlsafe(_TOKEN_BYTES))
    _desktop: asyncio.Lock = field(default_factory=asyncio.Lock)

    @asynccontextmanager
    async def only_desktop(self, patience: float) -> AsyncIterator[None]:
        """Hold this visitor's one desktop; InUse if another connection still has it after `patience` seconds.

        A page that is loaded again connects while the desktop before it is still keeping its work safe.
        """
        try:
            await asyncio.wait_for(self._desktop.acquire(), patience)
        except TimeoutError:
            raise InUse from None
        try:
            yield
        finally:
            self._desktop.release()


class Visitors:
    """All of them: their number is the most desktops that there can be."""

    def __init__(self, number: int) -> None:
        self.all = tuple(Visitor() for _ in range(number))

    def with_token(self, token: str) -> Visitor | None:
        """Return who has this token; the time it takes says nothing about how a wrong one differs."""
        given = token.encode(errors="surrogateescape")
        found: Visitor | None = None
        for visitor in self.all:
            if hmac.compare_digest(visitor.token.encode(), given):
                found = visitor
        return found
