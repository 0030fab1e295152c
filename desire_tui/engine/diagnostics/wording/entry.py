"""One message."""

from __future__ import annotations

from desire_tui.engine.data_classes import dataclass


@dataclass(frozen=True, slots=True)
class Wording:
    """Error number, sentence, hint, the help page's explanation; `warning`: it stops no program."""

    code: int
    message: str
    hint: str = ""
    explanation: str = ""
    warning: bool = False
