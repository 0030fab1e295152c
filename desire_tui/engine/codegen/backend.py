"""Makes models out of lowered segments."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import TYPE_CHECKING

from desire_tui.engine.codegen.background import Improver
from desire_tui.engine.codegen.compiler import machine
from desire_tui.engine.codegen.loopcode import Loops
from desire_tui.engine.codegen.model import NativeModel
from desire_tui.engine.codegen.store import Store

if TYPE_CHECKING:
    from desire_tui.engine.lowered import Segment
    from desire_tui.engine.runtime.backend import Model
    from desire_tui.engine.values import Values

_MODELS_MOST = 32
STIFF_RULES = range(9, 17)


class NativeBackend:
    """Native code through LLVM, for all rules.

    LLVM is loaded, and the run loop of rule 1 compiled, in a thread that starts with this object: by the time
    somebody types `zz` it is there.
    """

    name = "native"

    def __init__(self) -> None:
        self.store = Store()
        self.loops = Loops(self.store)
        self.improver = Improver()
        self._models: OrderedDict[tuple[int, int, int], tuple[Segment, Values, Model]] = OrderedDict()
        threading.Thread(target=machine, name="desire starts LLVM", daemon=True).start()

    def model(self, segment: Segment, rule: int, values: Values) -> Model:
        """Prepare `segment` for integration rule `rule`; the same segment again costs nothing."""
        key = (id(segment), rule, id(values))
        known = self._models.get(key)
        if known is not None:
            self._models.move_to_end(key)
            return known[2]
        made = self._make(segment, rule, values)
        self._models[key] = (segment, values, made)  # the key's ids stay taken as long as these live
        while len(self._models) > _MODELS_MOST:
            self._models.popitem(last=False)
        return made

    def _make(self, segment: Segment, rule: int, values: Values) -> Model:
        if rule in STIFF_RULES and segment.order:
            from desire_tui.engine.codegen.stiff import StiffModel

            return StiffModel(self, segment, rule, values)
        return NativeModel(self, segment, rule, values)
