"""A segment's statements that are parsed when somebody asks for them (`engine.warm_start`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.program import SegmentText

if TYPE_CHECKING:
    from collections.abc import Callable


class DeferredSegmentText(SegmentText):
    """A segment whose `body` and `jacobian` are read from the text with the first of them that is wanted."""

    __slots__ = ("_read",)
    _read: Callable[[], SegmentText]

    def __init__(self, label: str | None, at: int, read: Callable[[], SegmentText]) -> None:
        for name, value in (("label", label), ("at", at), ("_read", read)):
            object.__setattr__(self, name, value)

    def __getattr__(self, name: str) -> object:
        """Fill in the statements; two threads that do so at once find the same."""
        if name not in ("body", "jacobian"):
            raise AttributeError(name, name=name, obj=self)
        text = self._read()
        object.__setattr__(self, "body", text.body)
        object.__setattr__(self, "jacobian", text.jacobian)
        return object.__getattribute__(self, name)
