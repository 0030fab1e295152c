"""One Session: program, quantities, run, graph, console. The only package that knows every stage."""

from __future__ import annotations

from desire_tui.engine.session.listener import Listener, StoppedAt
from desire_tui.engine.session.permissions import PermissionRequest, Permissions
from desire_tui.engine.session.session import Session
from desire_tui.engine.session.status import State, Status

__all__ = ["Listener", "PermissionRequest", "Permissions", "Session", "State", "Status", "StoppedAt"]
