"""How far an analysis is, and whether it is to go on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from desire_tui.analysis.result import Result


class Progress(Protocol):
    """Called from the analysis's thread, at least a few times a second; it is cheap."""

    def __call__(self, part: float | None, told: str, so_far: Result | None = None) -> bool:
        """Hear that a `part` (0 … 1, None: unknown) is done. False: end, and return what there is.

        `so_far` is what is known by now, to be shown at once.
        """


def unwatched(part: float | None, told: str, so_far: Result | None = None) -> bool:
    """Go on: nobody looks."""
    del part, told, so_far
    return True
