"""Nodes to a lowered program: names, kinds, shapes, order, guards.

`structure` finds a script's blocks, `check` every problem before a run, `lower` makes a segment ready for a
back end, the slices say which statements a pass executes.
"""

from __future__ import annotations

from desire_tui.engine.analysis.lowering import check, lower, state_order
from desire_tui.engine.analysis.slices import derivative_slice, full_pass, step_slice, tail_pass
from desire_tui.engine.analysis.structure import Structure, script_structure, structure

__all__ = [
    "Structure",
    "check",
    "derivative_slice",
    "full_pass",
    "lower",
    "script_structure",
    "state_order",
    "step_slice",
    "structure",
    "tail_pass",
]
