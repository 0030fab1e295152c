"""One message."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Wording:
    """Error number, sentence, hint and the explanation shown on the help page."""

    code: int
    message: str
    hint: str = ""
    explanation: str = ""
