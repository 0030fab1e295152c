"""Keys take effect in the order in which they were typed.

Textual puts a letter into the queue of the focused widget, but carries out bindings elsewhere: the app's own
(F5) at once, ahead of letters that still wait; a widget's own (backspace, arrows) only after the key has gone
up through all its parents, behind letters that were typed later. Whoever types faster than the screen follows
would get another text than was typed, or run a program whose last line is still in the queue.
"""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING

from textual.screen import ModalScreen
from textual.widget import Widget
from textual.widgets import Input, TextArea

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from textual import events
    from textual.app import App
    from textual.screen import Screen
    from textual.worker import Worker

PATIENCE_S = 2.0
"""A widget that is busy for longer does not hold up the keys of the others."""


class KeyOrdering:
    """Carries out the keys of one app."""

    def __init__(self, app: App[None]) -> None:
        self._app = app
        self.action_begun: Worker[None] | None = None
        """The action begun last that takes its time."""

    async def carry_out(self, event: events.Key, hand_over: Callable[[events.Key], Awaitable[None]]) -> None:
        """Carry out a key that may be bound: after what was typed before it, before what comes next.

        `hand_over` is the app's usual way: bindings with priority, else the focused widget's queue.
        """
        app = self._app
        await caught_up(app.focused)
        field, screen, begun = app.focused, app.screen, self.action_begun
        await self._deal_with(event, field, hand_over)
        if field is not None and isinstance(screen, ModalScreen):
            for above in field.ancestors:  # Return in a dialog's field goes up to the dialog, which ends
                await caught_up(above if isinstance(above, Widget) else None)
        if app.screen is not screen and isinstance(screen, ModalScreen):
            await self._at_rest(app.screen)
        elif self.action_begun is not begun:
            await self._at_rest(screen)

    async def _deal_with(
        self, event: events.Key, field: Widget | None, hand_over: Callable[[events.Key], Awaitable[None]]
    ) -> None:
        if not isinstance(field, (Input, TextArea)):
            await hand_over(event)
            return
        event.bubble = False  # type: ignore[misc]  # of this one event only
        await hand_over(event)
        await caught_up(field)
        if not event.is_forwarded or event._stop_propagation:  # noqa: SLF001 - no public way to ask (Textual is pinned)
            return
        if not await self._app._check_bindings(event.key) and field.parent is not None:  # noqa: SLF001 - as above
            event.bubble = True  # type: ignore[misc]
            event._bubble_to(field.parent)  # noqa: SLF001 - what Textual itself would have done

    async def _at_rest(self, screen: Screen[object]) -> None:
        """Wait until an action just begun is done, or has opened a dialog that takes keys."""
        end = asyncio.get_running_loop().time() + PATIENCE_S
        app, worker = self._app, self.action_begun
        while worker is not None and not worker.is_finished and asyncio.get_running_loop().time() < end:
            if app.screen is not screen and takes_keys(app.screen):
                return
            await asyncio.sleep(0.001)


def takes_keys(screen: Screen[object]) -> bool:
    """Whether a screen that was just opened has its focus, or stands and has nothing that could get it."""
    return screen.focused is not None or (screen.is_mounted and not screen.focus_chain)


async def caught_up(widget: Widget | None) -> None:
    """Wait until a widget has dealt with all that is in its queue."""
    done = asyncio.Event()
    if widget is not None and widget.is_attached and widget.call_later(done.set):
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(done.wait(), PATIENCE_S)
