"""The desktop as it stands after a few keys: for snapshots in tests and for the pictures in docs."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.app import DesireApp

from .conftest import until

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.pilot import Pilot

PROGRAM = """\
-- damped oscillator, step response
TMAX = 0.5 | DT = 0.0001 | NN = 1001
ww = 400 | u = 440
display N14
for k = 1 to 5
  r = 10*k
  drunr
  display 2 -- keep the earlier curves
next
write 'the last run had r = '; r

DYNAMIC
d/dt x = xdot
d/dt xdot = u - ww*x - r*xdot
X = x - 1
dispt X
"""


@dataclass(frozen=True)
class Scene:
    """A size, a program and what is done to it."""

    name: str
    size: tuple[int, int]
    steps: tuple[str, ...] = ()
    text: str = PROGRAM
    theme: str = "dark"
    run: bool = True
    words: tuple[str, ...] = field(default=())
    file: str = "step.src"


SCENES = (
    Scene("main-80x24", (80, 24)),
    Scene("main-160x50", (160, 50), ("alt+q",)),
    Scene("light-100x30", (100, 30), theme="light"),
    Scene("problem-100x30", (100, 30), text=PROGRAM.replace("r*xdot", "rr*xdto"), words=("problem",)),
    Scene("completion-80x24", (80, 24), ("alt+e", "enter", "s", "i"), run=False, words=("complete",)),
    Scene("help-160x50", (160, 50), words=("help",)),
    Scene("live-100x30", (100, 30), words=("live",)),
)
EXAMPLES = Path(__file__).parents[2] / "examples"
EPIDEMIC = (EXAMPLES / "ch2" / "epidemic.src").read_text()
FIRST = """\
x = 10 | y = 2
TMAX = 20
drun
DYNAMIC
d/dt x = x - 0.1*x*y
d/dt y = 0.075*x*y - 1.5*y
dispt x, y
"""
"""What a newcomer types: nothing about steps or scales."""
PLANE = FIRST.replace("TMAX", "display fit\nTMAX").replace("dispt x, y", "dispxy x, y")
FAILED = FIRST.replace("- 1.5*y", "- 1.5*y*sqrt(40 - x)/5")
SPRING = """\
-- a spring with friction, pulled out and let go
k = 4 | r = 0.1
x = 1 | v = 0
DT = 0.01 | TMAX = 5 | NN = 101 | irule 3
drun
DYNAMIC
d/dt x = v
d/dt v = -k*x - r*v
dispt x
"""
PICTURES = (
    *SCENES,
    Scene("first-model-100x30", (100, 30), ("shift+f7",), text=FIRST, file="hares.src"),
    Scene("phase-plane-120x34", (120, 34), text=PLANE, file="hares.src"),
    Scene("failed-100x30", (100, 30), text=FAILED, file="hares.src"),
    Scene("palette-100x30", (100, 30), ("ctrl+p", *"csv")),
    Scene("save-100x30", (100, 30), ("ctrl+n", "x", "=", "1", "ctrl+s", *"my", "underscore", *"model")),
    Scene("keys-120x40", (120, 40), ("shift+f1",)),
    Scene("sixteen-colours-80x24", (80, 24), words=("sixteen",)),
    Scene("desktop-120x34", (120, 34), ("alt+q", "down"), text=EPIDEMIC, file="epidemic.src"),
    Scene("study-120x34", (120, 34), text=SPRING, file="spring.src", run=False, words=("study",)),
    Scene("examples-110x34", (110, 34), (*"servo",), run=False, words=("examples",)),
)
"""What docs show; a program of the examples may change without any snapshot being wrong."""


async def play(app: DesireApp, pilot: Pilot[None], scene: Scene) -> None:
    """Bring the app into the scene."""
    await until(pilot, lambda: app.is_ready)
    app.theme = scene.theme
    for area in app.editor.areas:
        area.cursor_blink = False
    app.command.prompt.cursor_blink = False
    if scene.run:
        await pilot.press("f5")
        await until(pilot, lambda: not app.engine.is_busy)
    for step in scene.steps if "examples" not in scene.words else ():
        await pilot.press(step)
    for word in scene.words:
        match word:
            case "examples":
                await show_examples(app, pilot, scene)
            case "help":
                app.do("help.word", "dispxy")
            case "live":
                app.do("run.live", "ww")
            case "study":
                varied = "k=normal(4,0.5), r=uniform(0,0.3)"
                app.do("study.start", f"--sample {varied} --runs 1000 --seed 7 --keep x@0:5:0.05, min(x)")
                await until(pilot, lambda: app.studies.progress is not None and not app.studies.is_going)
            case "complete":
                app.do("edit.complete")
    await pilot.pause(0.2)
    app.graph.tick()
    await pilot.pause(0.2)


async def show_examples(app: DesireApp, pilot: Pilot[None], scene: Scene) -> None:
    """Open the browser, type the steps, wait for the picture."""
    from desire_tui.panes.examples_browser import ExamplesScreen
    from desire_tui.panes.thumbnail import Thumbnail

    app.do("file.examples")
    await until(pilot, lambda: isinstance(app.screen, ExamplesScreen))
    for step in scene.steps:
        await pilot.press(step)
    await until(pilot, lambda: app.screen.query_one(Thumbnail).graph is not None)


def app_for(scene: Scene, folder: Path) -> DesireApp:
    """Return an app with the scene's program in a file; the speed of a run, never twice the same, is not shown."""
    path = folder / scene.file
    path.write_text(scene.text)
    app = DesireApp([path])
    app.show_status = lambda: None  # type: ignore[method-assign]
    if "sixteen" in scene.words:
        app._has_few_colours = True
        app._completed.clear()
        app.stylesheet.set_variables(app.get_css_variables())
    return app


def before(scene: Scene) -> Callable[[Pilot[None]], object]:
    """Return what a snapshot does before it is taken."""

    async def run(pilot: Pilot[None]) -> None:
        app = pilot.app
        assert isinstance(app, DesireApp)
        await play(app, pilot, scene)

    return run
