"""What the driver makes of what a terminal sends."""

from __future__ import annotations

from textual._xterm_parser import XTermParser
from textual.drivers.linux_driver import LinuxDriver

from desire_tui.desktop.terminal_driver import TerminalDriver, as_elsewhere


def test_a_line_feed_is_enter(monkeypatch):
    keys = []
    monkeypatch.setattr(LinuxDriver, "process_message", lambda _self, message: keys.append(message.key))
    driver = TerminalDriver.__new__(TerminalDriver)
    for event in XTermParser().feed("a\nb\r"):
        driver.process_message(event)
    assert keys == ["a", "enter", "b", "enter"]


def test_the_linux_console_s_function_keys_with_shift_are_what_they_are_elsewhere():
    """Its keys by drivers/tty/vt/defkeymap.map; `[[E` is F5, which it sends without Shift."""
    sent = "".join(f"\x1b[{number}~" for number in (25, 26, 28, 29, 31, 32, 33, 34)) + "a\x1b[[E\x1b[21~"
    keys = [event.key for event in XTermParser().feed(as_elsewhere(sent))]
    assert keys == [*(f"shift+f{number}" for number in range(1, 9)), "a", "f5", "f10"]
