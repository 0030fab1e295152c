"""One Session: program, quantities, run, graph, console. The only package that knows every stage."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.session.listener import Listener, StoppedAt
from desire_tui.engine.session.permissions import PermissionRequest, Permissions
from desire_tui.engine.session.status import State, Status

if TYPE_CHECKING:
    from desire_tui.engine.session.session import Session

__all__ = ["Listener", "PermissionRequest", "Permissions", "Session", "State", "Status", "StoppedAt"]


def __getattr__(name: str) -> object:
    """Import `Session` when it is asked for: it brings the whole engine, and a screen comes first."""
    if name == "Session":
        from desire_tui.engine.session.session import Session

        return Session
    raise AttributeError(name)
