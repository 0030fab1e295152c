"""How often a second a moving slider re-runs its program. `python -m benchmarks.bench_live [SECONDS]`

The whole desktop, without a terminal: a slider is moved as soon as the run before is over, and each run is
parsed, checked, run and drawn anew. The goal is 10 a second for small models.
"""

from __future__ import annotations

import asyncio
import sys
import tempfile
from pathlib import Path
from time import perf_counter

GOAL = 10.0
SECONDS = 3.0
EXAMPLES = Path(__file__).parents[1] / "examples"
OSCILLATOR = """\
TMAX = 10 | DT = 0.01 | NN = 301 | w = 1 | x = 1
drun
DYNAMIC
d/dt x = v
d/dt v = -w*x
dispt x, v
"""


async def rate(path: Path, name: str, seconds: float) -> float:
    """Return live runs a second of a program whose parameter `name` is moved by small steps."""
    from desire_tui.app import DesireApp

    app = DesireApp([path])
    async with app.run_test(size=(120, 40)) as pilot:
        while not app.is_ready:
            await pilot.pause(0.02)
        app.do("run.start")
        await pilot.pause(0.1)
        while app.engine.is_busy:
            await pilot.pause(0.02)
        values = app.session.values
        start = values.cells[values.names[name].slot]
        app.live_mode.ask(
            {name: start}, overlay=False
        )  # the first re-run compiles what the slider's program needs
        while app.engine.is_busy:
            await pilot.pause(0.02)
        runs, began = app.live_mode.runs_made, perf_counter()
        while perf_counter() - began < seconds:
            if not app.engine.is_busy:
                app.live_mode.ask({name: start * (1 + 0.001 * app.live_mode.runs_made)}, overlay=False)
            await asyncio.sleep(0.001)
        while app.engine.is_busy:
            await pilot.pause(0.02)
        return (app.live_mode.runs_made - runs) / (perf_counter() - began)


def main(arguments: list[str]) -> None:
    """Print a table."""
    seconds = float(arguments[0]) if arguments else SECONDS
    with tempfile.TemporaryDirectory() as folder:
        oscillator = Path(folder) / "oscillator.src"
        oscillator.write_text(OSCILLATOR, encoding="utf-8")
        lorenz = next(EXAMPLES.glob("*/lorenz.src"))
        programs = (
            ("oscillator, 1,000 steps", oscillator, "w", f"{GOAL:.0f}"),
            (f"{lorenz.name}, 50,000 samples", lorenz, "b", "–"),
        )
        print(f"{'live runs a second':36s}{'measured':>10s}{'goal':>8s}")
        for title, path, name, goal in programs:
            print(f"{title:36s}{asyncio.run(rate(path, name, seconds)):10.1f}{goal:>8s}")


if __name__ == "__main__":
    main(sys.argv[1:])
