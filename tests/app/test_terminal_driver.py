"""What the driver makes of what a terminal sends."""

from __future__ import annotations

from textual._xterm_parser import XTermParser
from textual.drivers.linux_driver import LinuxDriver

from desire_tui.desktop.terminal_driver import TerminalDriver


def test_a_line_feed_is_enter(monkeypatch):
    keys = []
    monkeypatch.setattr(LinuxDriver, "process_message", lambda _self, message: keys.append(message.key))
    driver = TerminalDriver.__new__(TerminalDriver)
    for event in XTermParser().feed("a\nb\r"):
        driver.process_message(event)
    assert keys == ["a", "enter", "b", "enter"]
