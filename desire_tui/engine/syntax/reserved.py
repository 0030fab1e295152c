"""Words that mean something in every program: nothing else can be called so."""

from __future__ import annotations

from desire_tui.engine.library import LIBRARY
from desire_tui.engine.syntax.words import KEYWORDS, SOFT_WORDS
from desire_tui.engine.values import SYSTEM_VARIABLES

RESERVED = frozenset({*KEYWORDS, *LIBRARY, *SYSTEM_VARIABLES}.union(*SOFT_WORDS.values()))
"""Keywords with all their spellings, functions of the library, system variables."""
