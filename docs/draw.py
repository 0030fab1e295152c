"""Draws the gallery's pictures, docs/pictures/NAME.png: `python -m docs.draw`."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from PIL import Image

from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

DOCS = Path(__file__).parent
SIZE = (720, 450)
COLORS = 160
"""Few enough that a picture needs some 20 kB, enough for smooth edges of a dozen curves."""

PROGRAMS = (
    "ch1/step_response", "ch2/lorenz", "ch2/van_der_pol", "ch2/pendulum_phase_portrait", "ch2/torpedo",
    "ch2/cannonball", "ch2/epidemic", "ch3/chaos_map", "ch3/servo_optimum", "ch4/signal_generator",
    "ch4/hysteresis", "ch4/bang_bang_servo", "ch4/coupled_oscillators", "ch6/parameter_study",
    "ch6/radiating_slab", "ch7/world_model", "ch7/circulation", "ch7/bouncing_ball", "ch7/pilot_ejection",
    "ch7/world_study", "ch8/impedance", "ch8/conformal_mapping", "networks/competitive_learning",
    "networks/fuzzy_servo",
)  # fmt: skip


def draw(name: str) -> Path:
    """Run an example and keep its last graph, small."""
    path = DOCS.parent / "examples" / f"{name}.src"
    target = DOCS / "pictures" / f"{path.stem}.png"
    with tempfile.TemporaryDirectory() as folder:
        session = Session(folder=Path(folder))
        session.erun(Source(path.read_text(encoding="utf-8"), path.name))
        picture = session.snapshot(Path(folder) / "graph.png")
        with Image.open(picture) as image:
            small = image.convert("RGB").resize(SIZE, Image.Resampling.LANCZOS)
    small.quantize(COLORS).save(target, optimize=True)
    return target


if __name__ == "__main__":
    for program in PROGRAMS:
        sys.stdout.write(f"{draw(program)}\n")
