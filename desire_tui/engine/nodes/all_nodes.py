"""Every class of nodes by its name, for code that makes nodes from generated text."""

from __future__ import annotations

from desire_tui.engine.nodes import (
    assignments,
    commands,
    control,
    declarations,
    display,
    expressions,
    files,
    program,
    segment,
)
from desire_tui.engine.nodes.record import Node

_MODULES = (assignments, commands, control, declarations, display, expressions, files, program, segment)

NODE_CLASSES: dict[str, type[Node]] = {
    name: value
    for module in _MODULES
    for name, value in vars(module).items()
    if isinstance(value, type) and issubclass(value, Node)
}
