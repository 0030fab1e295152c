"""Colours of curves on white paper: every one can be seen (WCAG 2.2, 1.4.11), white ones in ink."""

from __future__ import annotations

import pytest

from desire_tui.engine.graph.colors import curve_rgb, rgb


def luminance(color: tuple[int, int, int]) -> float:
    parts = [c / 255 / 13.02 if c / 255 <= 0.04045 else ((c / 255 + 0.055) / 1.055) ** 2.4 for c in color]
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]


@pytest.mark.parametrize("color", range(16))
def test_every_curve_is_seen_on_white_paper(color: int):
    assert 1.05 / (luminance(curve_rgb(color, white=True)) + 0.05) >= 3.0
    assert curve_rgb(color, white=False) == rgb(color, white=False)


def test_a_white_net_on_white_paper_is_gone():
    assert rgb(15, white=True) == (255, 255, 255)
