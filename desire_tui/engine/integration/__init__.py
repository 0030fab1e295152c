"""Integration rules as data, and CVODE by function pointer."""

from __future__ import annotations

from desire_tui.engine.integration.tableaus import TABLEAUS, Tableau

__all__ = ["TABLEAUS", "Tableau"]
