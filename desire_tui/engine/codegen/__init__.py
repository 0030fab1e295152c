"""Lowered segment and rule to native code: the only home of llvmlite."""
