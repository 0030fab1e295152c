"""What a function in plain Python may refer to besides its own names."""

from __future__ import annotations

import builtins
import math
from typing import TYPE_CHECKING, Any

from desire_tui.engine.codegen.plain_python import library
from desire_tui.engine.codegen.plain_python.kinds import ANNOTATIONS, Kind
from desire_tui.engine.data_classes import dataclass, field
from desire_tui.engine.integration.switching import mathematics

if TYPE_CHECKING:
    import ast
    import ctypes
    from collections.abc import Mapping

    from desire_tui.engine.codegen.plain_python.kinds import Signature

BUILTINS = {
    "range": range, "abs": abs, "min": min, "max": max, "sqrt": math.sqrt, "copy": library.copy,
    "floor": mathematics.floor, "exp": mathematics.exp, "log": mathematics.log, "sin": mathematics.sin,
    "cos": mathematics.cos, "atan": mathematics.atan, "tanh": mathematics.tanh, "fused": mathematics.fused,
}  # fmt: skip


@dataclass(frozen=True)
class Outside:
    """What a program's texts share."""

    structures: Mapping[str, type[ctypes.Structure]]
    pointers: Mapping[str, Signature] = field(default_factory=dict)
    """Of functions whose addresses stand in fields that are declared as mere addresses."""
    direct: Mapping[str, str] = field(default_factory=dict)
    """For a function pointer the function of the program that it always points at."""
    known: Mapping[str, int] = field(default_factory=dict)
    """Whole-numbered fields that always have this value; addresses that are 0."""
    modules: Mapping[str, Mapping[str, Signature]] = field(default_factory=dict)
    """C functions, called as `module.name(…)`."""

    def kind(self, annotation: ast.expr | None) -> Kind | None:
        """Return the type that an annotation names; None: there is none of that name."""
        name = getattr(annotation, "id", "")
        structure = self.structures.get(name)
        return Kind("ptr", structure=structure) if structure is not None else ANNOTATIONS.get(name)


@dataclass(frozen=True)
class Surroundings:
    """What one text's functions see."""

    outside: Outside
    constants: Mapping[str, Any]
    """The module's names."""
    functions: Mapping[str, Signature]
    """Of the whole program."""

    def builtin(self, name: str) -> bool:
        """Whether a name means the built-in function here, not something of the module's own."""
        expected = BUILTINS.get(name)
        found = self.constants.get(name, getattr(builtins, name, None))
        return expected is not None and found is expected
