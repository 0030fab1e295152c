"""The native functions that watch switches, called from Python: for run loops that are no native code."""

from __future__ import annotations

from ctypes import CFUNCTYPE, addressof, c_double, c_int32, c_void_p
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.switching.watch_routines import watch_functions

if TYPE_CHECKING:
    from desire_tui.engine.integration.switching.memory import Watch

_LIMIT = CFUNCTYPE(c_double, c_void_p, c_double, c_double)
_LOOK = CFUNCTYPE(c_int32, c_void_p, c_double, c_double)
_SETTLE = CFUNCTYPE(c_int32, c_void_p, c_double)
_DEPART = CFUNCTYPE(c_int32, c_void_p)


class CalledWatch:
    """Implements `reference.switches.Watching`: what `integration.switching.watch` does, in native code."""

    def __init__(self) -> None:
        self._functions = functions = watch_functions()
        self._limit, self._look_back = _LIMIT(functions.limit), _LOOK(functions.look_back)
        self._settle, self._depart = _SETTLE(functions.settle), _DEPART(functions.depart)

    def begin(self, w: Watch, t: float) -> int:
        """See `watch.begin`."""
        self._functions.begin(w, t)
        return 0

    def limit(self, w: Watch, t: float, wish: float) -> float:
        """See `watch.limit`."""
        return float(self._limit(addressof(w), t, wish))

    def look_back(self, w: Watch, t0: float, t1: float) -> int:
        """See `watch.look_back`."""
        return int(self._look_back(addressof(w), t0, t1))

    def settle(self, w: Watch, t_next: float) -> int:
        """See `watch.settle`."""
        return int(self._settle(addressof(w), t_next))

    def depart(self, w: Watch) -> int:
        """See `watch.depart`."""
        return int(self._depart(addressof(w)))
