"""Walks the experiment-protocol script."""

from __future__ import annotations

from desire_tui.engine.interpreter.host import Host, Interrupted
from desire_tui.engine.interpreter.interpreter import Interpreter
from desire_tui.engine.interpreter.quantity_rows import QuantityRow, names

__all__ = ["Host", "Interpreter", "Interrupted", "QuantityRow", "names"]
