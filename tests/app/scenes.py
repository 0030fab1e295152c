"""The desktop as it stands after a few keys: for snapshots in tests and for the pictures in docs."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from desire_tui.app import DesireApp

from .conftest import until

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

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


SCENES = (
    Scene("main-80x24", (80, 24)),
    Scene("main-160x50", (160, 50), ("alt+q",)),
    Scene("light-100x30", (100, 30), theme="light"),
    Scene("problem-100x30", (100, 30), text=PROGRAM.replace("r*xdot", "rr*xdto"), words=("problem",)),
    Scene("completion-80x24", (80, 24), ("alt+e", "enter", "s", "i"), run=False, words=("complete",)),
    Scene("help-160x50", (160, 50), words=("help",)),
    Scene("live-100x30", (100, 30), words=("live",)),
)


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
    for step in scene.steps:
        await pilot.press(step)
    for word in scene.words:
        match word:
            case "help":
                app.do("help.word", "dispxy")
            case "live":
                app.do("run.live", "ww")
            case "complete":
                app.do("edit.complete")
    await pilot.pause(0.2)
    app.graph.tick()
    await pilot.pause(0.2)


def app_for(scene: Scene, folder: Path) -> DesireApp:
    """Return an app with the scene's program in a file; the speed of a run, never twice the same, is not shown."""
    path = folder / "step.src"
    path.write_text(scene.text)
    app = DesireApp([path])
    app.show_status = lambda: None  # type: ignore[method-assign]
    return app


def before(scene: Scene) -> Callable[[Pilot[None]], object]:
    """Return what a snapshot does before it is taken."""

    async def run(pilot: Pilot[None]) -> None:
        app = pilot.app
        assert isinstance(app, DesireApp)
        await play(app, pilot, scene)

    return run
