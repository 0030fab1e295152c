"""A screen that can be held: what changes meanwhile is laid out and sent as one picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.screen import Screen

from desire_tui.desktop.banded_compositor import BandedCompositor

if TYPE_CHECKING:
    from textual import events
    from textual.geometry import Size
    from textual.widget import Widget


class DeferredScreen(Screen[None]):
    """Held from its beginning until `release`.

    Textual is pinned; it has no public way. `App.batch_update` drops what is due when it ends late.
    """

    is_held = True
    """Whether nothing is laid out and sent."""
    _has_begun = False

    def __init__(self) -> None:
        super().__init__()
        self._compositor = BandedCompositor()

    def hold(self) -> None:
        """Keep what changes from now on."""
        self.is_held = True

    def release(self) -> None:
        """Lay out and send what changed while the screen was held."""
        if self.is_held:
            super()._on_timer_update()  # still held: it would send twice what is both moved and drawn anew
            self.is_held = False
            self._compositor_refresh()

    def send_only(self, *parts: Widget) -> None:
        """Send what has changed in some widgets at once: Textual's own way takes up to 20 ms longer."""
        if self.is_current:
            self.is_held = False
            others = self._dirty_widgets.difference(parts)
            self._compositor.update_widgets({*parts} & self._compositor.visible_widgets.keys())
            self._compositor_refresh()  # and forgets whatever else has changed
            self._dirty_widgets |= others
            self.check_idle()  # they come next

    def _compositor_refresh(self) -> None:
        if not self.is_held:
            super()._compositor_refresh()

    def _on_timer_update(self) -> None:
        if self.is_held:
            self._update_timer.pause()
        else:
            super()._on_timer_update()

    def _screen_resized(self, size: Size) -> None:
        """Follow the terminal's size; held, lay nothing out again for the size it has already."""
        if self.is_held and self.size == size:
            self._layout_required = True
        else:
            super()._screen_resized(size)

    def _on_screen_resume(self, event: events.ScreenResume) -> None:
        """Begin, or come back from a dialog: in the beginning all styles are new as they are."""
        event.refresh_styles = self._has_begun and event.refresh_styles
        self._has_begun = True
        super()._on_screen_resume(event)
