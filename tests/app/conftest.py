"""A desktop of one's own for each test: no file of the user's is read or written."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from time import monotonic
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import pytest
from textual._context import active_app
from textual.css.stylesheet import Stylesheet

from desire_tui.app import DesireApp
from desire_tui.desktop.quick_stylesheet import StyleTables

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable
    from pathlib import Path

    from textual.css.model import RuleSet
    from textual.css.types import CSSLocation
    from textual.pilot import Pilot

OSCILLATOR = """\
-- undamped oscillator: x = cos(t)
TMAX = 6 | DT = 0.001 | NN = 301
irule 3
x = 1
drun
write 'x = '; x
DYNAMIC
d/dt x = v
d/dt v = -x
dispt x, v
"""
LONG = OSCILLATOR.replace("TMAX = 6", "TMAX = 1E7").replace("NN = 301", "NN = 1000001")
"""Goes on for minutes."""
PATIENCE_S = 60.0
"""What a busy machine may take to do what a test waits for."""


@pytest.fixture(autouse=True)
def own_places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("CONFIG", "STATE", "DATA"):
        monkeypatch.setenv(f"XDG_{name}_HOME", str(tmp_path / name.lower()))
    monkeypatch.setenv("COLORTERM", "truecolor")
    for name in ("TMUX", "NO_COLOR", "VISUAL", "EDITOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("desire_tui.common.dialogs.GRACE_SECONDS", 0.0)
    for module in ("app", "pilot"):
        monkeypatch.setattr(f"textual.{module}.wait_for_idle", settled)
    monkeypatch.setattr("textual.pilot.Pilot._wait_for_screen", messages_read)
    monkeypatch.setattr(Stylesheet, "_parse_rules", parsed_once)
    monkeypatch.setattr("desire_tui.desktop.quick_stylesheet.StyleTables", lambda: STYLE_TABLES)


STYLE_TABLES = StyleTables()
"""For all desktops of the process, whose rules are the same objects: an eighth of their start."""
_parse_rules = Stylesheet._parse_rules
_parsed: dict[object, list[RuleSet]] = {}
_variables: WeakKeyDictionary[Stylesheet, tuple[dict[str, str], frozenset[tuple[str, str]]]] = (
    WeakKeyDictionary()
)


def parsed_once(
    sheet: Stylesheet,
    css: str,
    read_from: CSSLocation,
    is_default_rules: bool = False,
    tie_breaker: int = 0,
    scope: str = "",
) -> list[RuleSet]:
    """Parse a widget's style sheet once for all apps of the process, not once for each: an eighth of their start."""
    key = (css, read_from, is_default_rules, tie_breaker, scope)
    if key not in sheet._parse_cache:
        variables, said = _variables.get(sheet, ({}, frozenset()))
        if variables is not sheet._variables:  # other colours are another dictionary
            said = frozenset(sheet._variables.items())
            _variables[sheet] = sheet._variables, said
        known = (*key, said)
        if known not in _parsed:
            _parsed[known] = _parse_rules(sheet, css, read_from, is_default_rules, tie_breaker, scope)
        sheet._parse_cache[key] = _parsed[known]
    return sheet._parse_cache[key]


async def settled(min_sleep: float = 0.0, max_sleep: float = 1.0) -> None:
    """Wait until the app has nothing to do; what its timers would do in a moment it does at once.

    Textual's own `wait_for_idle` asks for the processor time of the whole process: while a simulation runs in another
    thread, each key would take a second. What the event loop has ready is what counts.
    """
    end = monotonic() + max_sleep
    await asyncio.sleep(min_sleep)
    await nothing_ready(end)
    while (act := due()) is not None and monotonic() < end:
        act()
        await nothing_ready(end)


def due() -> Callable[[], None] | None:
    """Return what the app's timers would do in at most 1/60 s: tell the panes a new size, draw what has changed."""
    app = active_app.get(None)
    if app is None or not app._screen_stack or not app.screen.is_running:
        return None
    if app._resize_timer is not None:
        return app._check_resize
    return app.screen._on_timer_update if app.screen._update_timer._active.is_set() else None


async def messages_read(_: Pilot[None], timeout: float = 1.0) -> bool:  # noqa: ASYNC109 - Textual's own name
    """Wait until all messages that widgets have are read.

    Textual's own `_wait_for_screen` sends one more to each of a hundred widgets, at each key: a sixth of the time
    of these tests.
    """
    await asyncio.sleep(0)
    await nothing_ready(monotonic() + timeout)
    return True


async def nothing_ready(end: float) -> None:
    """Wait until the event loop has nothing ready: whoever has a message to read is ready."""
    loop = asyncio.get_running_loop()
    while loop._ready and monotonic() < end:  # noqa: ASYNC110 - an idle loop tells nobody
        await asyncio.sleep(0)


async def until(pilot: Pilot[None], condition: Callable[[], object]) -> None:
    """Let the app work until something holds, and lay out and draw what follows from it.

    Textual's own `pause` sends a message to every widget: on a busy machine that kept the app from what it was to do.
    """
    end = monotonic() + PATIENCE_S
    while not condition() and monotonic() < end:
        await asyncio.sleep(0.003)
        pilot.app.screen._on_timer_update()
    assert condition()
    await pilot.pause()


class Desktop:
    """The running app with what tests do most."""

    def __init__(self, app: DesireApp, pilot: Pilot[None]) -> None:
        self.app, self.pilot = app, pilot

    async def until(self, condition: Callable[[], object]) -> None:
        await until(self.pilot, condition)

    async def press(self, *keys: str) -> None:
        await self.pilot.press(*keys)

    async def line(self, text: str) -> None:
        """Give a command line."""
        self.app.command.prompt.focus()
        self.app.command.prompt.value = text
        await self.pilot.press("enter")
        await self.pilot.pause()

    async def idle(self) -> None:
        await self.until(lambda: not self.app.engine.is_busy)
        await self.pilot.pause()

    async def do(self, command_id: str, argument: str = "") -> None:
        self.app.do(command_id, argument)
        await self.pilot.pause()

    @property
    def output(self) -> str:
        self.app.message_handlers.flush()
        return self.app.command.console.text


@asynccontextmanager
async def desktop(*files: Path, size: tuple[int, int] = (100, 30)) -> AsyncIterator[Desktop]:
    app = DesireApp(files)
    async with app.run_test(size=size) as pilot:
        await until(pilot, lambda: app.is_ready)
        try:
            yield Desktop(app, pilot)
        finally:
            app.session.end()


@pytest.fixture
def program(tmp_path: Path) -> Callable[[str, str], Path]:
    def write(text: str, name: str = "osc.src") -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    return write
