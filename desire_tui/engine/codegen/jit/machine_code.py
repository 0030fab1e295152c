"""Compiled functions in memory, whoever put them there."""

from __future__ import annotations

from typing import Protocol


class MachineCode(Protocol):
    """Functions that can be called as long as this object lives; their memory is freed with it."""

    size: int
    """In bytes, about."""

    def address(self, name: str) -> int:
        """Return a function's address."""
        ...
