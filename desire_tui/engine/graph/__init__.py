"""What the display statements mean: frames, curves, colours, keys, points. No drawing (language.md 13)."""

from __future__ import annotations

from desire_tui.engine.graph.color_keys import Key
from desire_tui.engine.graph.colors import BLACK, WHITE, Rgb, curve_rgb, rgb
from desire_tui.engine.graph.model import Curve, Frame, Graph, Points, ShownArray
from desire_tui.engine.graph.pages import GraphBook
from desire_tui.engine.graph.polylines import clip_polyline, thin_columns
from desire_tui.engine.graph.settings import DisplaySettings

__all__ = [
    "BLACK", "WHITE", "Curve", "DisplaySettings", "Frame", "Graph", "GraphBook", "Key", "Points", "Rgb",
    "ShownArray", "clip_polyline", "curve_rgb", "rgb", "thin_columns",
]  # fmt: skip
