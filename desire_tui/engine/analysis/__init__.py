"""Nodes to a lowered program: names, kinds, shapes, order, guards."""

from __future__ import annotations

from desire_tui.engine.analysis.slices import derivative_slice, full_pass, step_slice, tail_pass
from desire_tui.engine.analysis.structure import Structure, script_structure, structure

__all__ = ["derivative_slice", "full_pass", "step_slice", "tail_pass"]
