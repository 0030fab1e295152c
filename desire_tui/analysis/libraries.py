"""Libraries that only analyses use: imported when they are needed, named when they are missing."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from desire_tui.engine.diagnostics import DesireError, Diagnostic


def needed(library: str, what: str) -> Any:
    """Return a library's module. DesireError 522: `what` needs it, and it is not installed."""
    try:
        return import_module(library)
    except ImportError as reason:
        if reason.name is None or reason.name.partition(".")[0] != library.partition(".")[0]:
            raise
        facts = {"what": what, "library": library.partition(".")[0]}
        raise DesireError(Diagnostic("analysis-library", None, facts)) from None
