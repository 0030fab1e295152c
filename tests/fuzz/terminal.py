"""Keys, mouse and resizes to the desktop without a terminal: it goes on, whatever comes."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

from desire_tui.app import DesireApp
from tests.fuzz.corpus import PIECES, programs
from tests.fuzz.mutations import mutated

if TYPE_CHECKING:
    from random import Random

    from textual.pilot import Pilot

KEYS = """up down left right home end pageup pagedown enter escape tab shift+tab backspace delete space shift+up shift+down
shift+left shift+right shift+home shift+end ctrl+home ctrl+end ctrl+left ctrl+right ctrl+a ctrl+z ctrl+y ctrl+x ctrl+v ctrl+c ctrl+k
ctrl+f ctrl+n ctrl+w ctrl+d ctrl+l ctrl+g ctrl+r ctrl+p ctrl+u ctrl+t ctrl+b ctrl+e f1 f2 f3 f4 f5 f6 f7 f8 f9 f11 f12 alt+up
alt+down alt+1 alt+2 alt+3 alt+left alt+right ctrl+pageup ctrl+pagedown shift+f5 ctrl+f5 plus minus x 1 [ ( ' equals_sign""".split()  # noqa: SIM905
SIZES = ((80, 24), (120, 40), (200, 60), (40, 10), (20, 5), (1, 1), (300, 3), (61, 17))


def generate(rng: Random) -> list[str]:
    """Return a program and what is done to the desktop that shows it."""
    text = rng.choice(programs())
    actions = [text if rng.random() < 0.7 else mutated(text, rng)]
    for _ in range(rng.randint(5, 40)):
        kind = rng.random()
        if kind < 0.6:
            actions.append(f"key {rng.choice(KEYS)}")
        elif kind < 0.7:
            actions.append(f"type {rng.choice(PIECES)}")
        elif kind < 0.85:
            what = rng.choice(("click", "click", "double", "down", "up", "hover", "wheel"))
            actions.append(f"{what} {rng.randrange(120)} {rng.randrange(40)}")
        elif kind < 0.93:
            actions.append("size {} {}".format(*rng.choice(SIZES)))
        else:
            actions.append(f"paste {mutated(rng.choice(programs()), rng)}")
    return actions


def check(actions: list[str]) -> None:
    """Do it all; an exception in the app comes out of `run_test`."""
    if not actions:
        return
    for path in Path.cwd().iterdir():
        if path.is_file():
            path.unlink()
    asyncio.run(_drive(actions))


async def _drive(actions: list[str]) -> None:
    file = Path.cwd() / "program.src"
    file.write_text(actions[0], "utf-8", "surrogatepass")
    app = DesireApp([file])
    async with app.run_test(size=(100, 30)) as pilot:
        await pilot.pause()
        for action in actions[1:]:
            if not app.is_running:
                break
            await _act(pilot, action)
        await pilot.pause()


async def _act(pilot: Pilot[object], action: str) -> None:
    from textual.events import MouseScrollDown, Paste

    word, _, rest = action.partition(" ")
    app = pilot.app
    width, height = app.size
    numbers = [int(n) for n in rest.split()] if word not in {"key", "type", "paste"} and rest else [0, 0]
    place = (min(numbers[0], width - 1), min(numbers[-1], height - 1))
    match word:
        case "key":
            await pilot.press(rest)
        case "type":
            await pilot.press(*(("space" if c == " " else c) for c in rest if c.isprintable()))
        case "paste":
            app.screen.post_message(Paste(rest))
        case "size":
            await pilot.resize_terminal(*numbers)
        case "click" | "double":
            await pilot.click(offset=place, times=2 if word == "double" else 1)
        case "down":
            await pilot.mouse_down(offset=place)
        case "up":
            await pilot.mouse_up(offset=place)
        case "hover":
            await pilot.hover(offset=place)
        case "wheel":
            app.screen.post_message(
                MouseScrollDown(None, *place, 0, 0, 0, shift=False, meta=False, ctrl=False)
            )
            await pilot.pause()
