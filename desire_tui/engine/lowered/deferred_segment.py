"""A lowered segment whose statements are made when somebody asks for them.

A process that starts a program again knows its states, columns and code from an earlier one
(`engine.warm_start`); the statements are read by error messages, sensitivities, exports and the like.
"""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from desire_tui.engine.lowered.segment import Segment

if TYPE_CHECKING:
    from collections.abc import Callable

DEFERRED = frozenset({"body", "names"})
"""The fields that wait."""
_FILLING = threading.Lock()


class DeferredSegment(Segment):
    """A segment without `body` and `names` until one of them is read; from then on an ordinary one."""

    _lower: Callable[[], Segment]

    @classmethod
    def of(cls, known: Segment, lower: Callable[[], Segment], noted: object) -> DeferredSegment:
        """Return a segment with all fields of `known` but those that wait; `lower` makes the whole one.

        `noted`: what a back end noted of its code, as plain data.
        """
        made = cls.__new__(cls)
        vars(made).update(vars(known), _lower=lower, noted=noted)
        for name in DEFERRED:
            del vars(made)[name]
        return made

    def __getattr__(self, name: str) -> object:
        """Fill in the fields that wait."""
        if name not in DEFERRED:
            raise AttributeError(name, name=name, obj=self)
        own = vars(self)
        with _FILLING:
            if name not in own:
                whole = vars(self._lower())
                known = [field for field in self.__match_args__ if field not in DEFERRED]
                if any(whole[field] != own[field] for field in known):
                    raise RuntimeError("a segment lowered once more is another one")
                own.update({field: whole[field] for field in DEFERRED})
        return own[name]
