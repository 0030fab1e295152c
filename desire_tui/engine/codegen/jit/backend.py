"""Makes models out of lowered segments."""

from __future__ import annotations

import atexit
import threading
from collections import OrderedDict
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.jit.background import Improver
from desire_tui.engine.codegen.jit.cache import CodeCache
from desire_tui.engine.codegen.jit.compiler import machine
from desire_tui.engine.codegen.jit.native_model import NativeModel
from desire_tui.engine.codegen.loop.compiled_loops import array_loop
from desire_tui.engine.gc_pause import undisturbed_allocation
from desire_tui.engine.integration.rules import MOST_USED_FIRST, rule_numbered

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.values import Values

_MODELS_MOST = 32
_SETTLED_SECONDS = 0.4
"""A process that lives longer than this may run more programs: a headless run is over by then."""
_STORE = CodeCache()
"""One for all back ends of a process: code depends on nothing but its text."""
_IMPROVER = Improver()


_ENDING = threading.Event()


def _finish(thread: threading.Thread) -> None:
    """At the program's end: let LLVM finish what it is at, before its memory goes."""
    _ENDING.set()
    thread.join(1.0)


class NativeBackend:
    """Native code through LLVM, for all rules.

    LLVM is loaded in a thread that starts with this object: by the time somebody types `zz` it is there.
    """

    name = "native"

    def __init__(self) -> None:
        self.store = _STORE
        self.improver = _IMPROVER
        self._models: OrderedDict[tuple[int, int, int], tuple[Segment, Values, Model]] = OrderedDict()
        warming = threading.Thread(target=self._warm_up, name="desire starts LLVM", daemon=True)
        warming.start()
        atexit.register(_finish, warming)

    def _warm_up(self) -> None:
        """Load LLVM; later compile every rule's loop, so that the next program need not."""
        machine()
        if _ENDING.wait(_SETTLED_SECONDS):
            return
        for rule in MOST_USED_FIRST:
            if _ENDING.is_set():
                return
            self.store.quick([array_loop(rule, contiguous=True)])

    def model(self, segment: Segment, rule: int, values: Values) -> Model:
        """Prepare `segment` for integration rule `rule`; the same segment again costs nothing."""
        key = (id(segment), rule, id(values))
        known = self._models.get(key)
        if known is not None:
            self._models.move_to_end(key)
            if isinstance(known[2], NativeModel):
                self.improver.again(known[2])
            return known[2]
        with self.improver.held(), undisturbed_allocation:
            made = self._make(segment, rule, values)
        self._models[key] = (segment, values, made)  # the key's ids stay taken as long as these live
        while len(self._models) > _MODELS_MOST:
            self._models.popitem(last=False)
        return made

    def _make(self, segment: Segment, rule: int, values: Values) -> Model:
        if rule_numbered(rule).kind == "multistep" and segment.order:
            from desire_tui.engine.codegen.stiff.stiff_model import StiffModel

            return StiffModel(self, segment, rule, values)
        return NativeModel(self, segment, rule, values)
