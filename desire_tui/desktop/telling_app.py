"""What the app tells its user: notices, errors, where files are, faults of ours."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from desire_tui.common import paths
from desire_tui.common.reach import Reach
from desire_tui.desktop.paned_app import PanedApp
from desire_tui.engine.user_folders import make_private
from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from pathlib import Path

    from textual.notifications import SeverityLevel

    from desire_tui.desktop.served_driver import ServedWebDriver


class TellingApp(PanedApp):
    """Sentences go where they are seen, and stay where they are wanted later."""

    errors_reported = 0
    """How many errors were reported to the user."""
    keeps_answers = False
    """Whether a command of the command line is being carried out: what it says stays in the output."""

    def __init__(self) -> None:
        super().__init__()
        self.reach = Reach()

    def notify(
        self,
        message: str,
        *,
        title: str = "",
        severity: SeverityLevel = "information",
        timeout: float | None = None,
        markup: bool = True,
    ) -> None:
        """Show a sentence for a while; the answer to a typed command stays in the output, too."""
        if self.keeps_answers:
            self.command.console.add(message, "warning" if severity == "warning" else "notice")
        self._show_toast(message, title, severity, timeout, markup)

    def _show_toast(
        self, message: str, title: str, severity: SeverityLevel, timeout: float | None, markup: bool
    ) -> None:
        super().notify(message, title=title, severity=severity, timeout=timeout, markup=markup)

    def report_error(self, sentence: str, *, code: int | None) -> None:
        """Report an error of the user (`code` None: a warning)."""
        self.errors_reported += 1
        text = f"error {code}: {sentence}" if code else sentence
        self.command.console.add(text, "error" if code else "warning")
        self._show_toast(text, "", "error" if code else "warning", 6, markup=False)

    def is_file_name(self, name: str) -> bool:
        """Whether a file can be called so; the user is told if not."""
        if not paths.can_name_a_file(name):
            self.report_error(f"no file can be called {visible_line(name)}", code=38)
            return False
        return True

    def may_read(self, path: Path) -> bool:
        """Whether the user may open a file; he is told if not."""
        return self._within_reach(self.reach.may_read(path))

    def may_write(self, path: Path, *endings: frozenset[str]) -> bool:
        """Whether the user may save a file of a program, or one with such endings; he is told if not."""
        return self._within_reach(self.reach.may_write(path, *endings))

    def _within_reach(self, allowed: bool) -> bool:
        if not allowed:
            # the same words for every file: whether one is there is not for visitors either
            self.report_error(
                f"visitors open and save programs and results in {self.reach.folder} only", code=451
            )
        return allowed

    def snapshot_written(self, path: Path) -> None:
        """Report where the picture is."""
        self.command.console.add(f"{path}", "notice")
        self.file_written(path)

    def file_written(self, path: Path) -> None:
        """Say where a file is that was saved for the user; in a browser he gets a copy."""
        copied = False
        if self.is_web:
            with suppress(OSError):  # it stands where it was saved
                copied = self._served_driver.hand_over(path)
        copy = " and sent to the browser" if copied else ""
        self.notify(f"Saved {path}{copy}", timeout=3, markup=False)

    @property
    def _served_driver(self) -> ServedWebDriver:
        from desire_tui.desktop.served_driver import ServedWebDriver

        assert isinstance(self._driver, ServedWebDriver)
        return self._driver

    def log_fault(self, summary: str, details: str) -> None:
        """Keep a fault of ours in a file and say so; the session goes on."""
        path = self.write_fault(details)
        where = f"; details in {path}" if path is not None else ""
        self.report_error(f"internal error (not yours): {summary}{where}", code=None)

    def write_fault(self, details: str) -> Path | None:
        """Write a fault up; returns where, None if the folder cannot be written."""
        path = paths.state_folder() / "faults.log"
        try:
            make_private(str(path.parent))
            with path.open("a", encoding="utf-8", errors="backslashreplace") as file:
                path.chmod(0o600)
                file.write(details + "\n")
        except OSError:
            return None
        return path
