"""Which operating systems this runs on; elsewhere a sentence, before anything of theirs is looked for."""

from __future__ import annotations

import sys

ON_WINDOWS = (
    "desire needs Linux or macOS; on Windows it runs in WSL, the Windows Subsystem for Linux: "
    "type `wsl --install` in a terminal, then `pip install desire-tui` in the Linux that this brings"
)


def reason_against() -> str | None:
    """Return why this system will not do, as a sentence for its user; None if it will."""
    return ON_WINDOWS if sys.platform == "win32" else None


def check() -> None:
    """Refuse a system that will not do. OSError: a sentence that says why."""
    reason = reason_against()
    if reason is not None:
        raise OSError(reason)
