"""Lowered segments as native code (the only home of llvmlite)."""

from __future__ import annotations

from desire_tui.engine.codegen.backend import NativeBackend

__all__ = ["NativeBackend"]
