"""Which word was meant."""

from __future__ import annotations

import pytest

from desire_tui.engine.diagnostics import closest

WORDS = ("for", "if", "while", "write", "dispt", "x1", "theta", "tau")


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("fro", "for"), ("fir", "for"), ("fi", "if"), ("whlie", "while"), ("wirte", "write"), ("disp", "dispt"),
        ("tua", "tau"), ("thet", "theta"), ("x2", None), ("zz", None), ("for" * 1000, None),
    ],
)  # fmt: skip
def test_closest(typed, meant):
    assert closest(typed, WORDS) == meant
