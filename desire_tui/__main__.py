"""Where `desire` and `python -m desire_tui` begin."""

from __future__ import annotations

import atexit
import gc
import os
import sys

from desire_tui.systems import reason_against

COMMANDS = frozenset({
    "average", "check", "completion", "config", "continue", "convert", "examples", "export", "fit",
    "fmt", "help", "histogram", "ide", "linearise", "lsp", "lyapunov", "maximise", "measured",
    "minimise", "phase", "run", "section", "sensitivity", "serve", "served", "spectrum", "steady",
    "study",
})  # fmt: skip
"""As in `cli`, which takes 30 ms to import; a test holds them together."""


YOUNG_MOST = 200_000
"""New objects after which the garbage collector of a headless process looks at them. Python's own 700 are a
tenth of a short run: modules stay, and Desire's own garbage holds no cycles."""
BLAS_IDLE = "20"
"""OpenBLAS's threads look for work 2²⁰ ticks of the processor (0.4 ms), then sleep."""


def main(arguments: list[str] | None = None) -> None:
    """Do what the command line says, or `arguments`; without them the process is `desire`'s own."""
    if arguments is not None:
        _obey(arguments)
        return
    # OpenBLAS's other threads would look for work 2²⁶ ticks long as soon as NumPy is imported: 50 of the
    # 400 ms of processor time of a short run, on the core that loads LLVM meanwhile
    os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", BLAS_IDLE)
    if sys.argv[1:2] in (["run"], ["check"]):
        gc.set_threshold(YOUNG_MOST)
    ending = _QuickEnd()
    try:
        _obey(None)
        ending.status = 0
    except SystemExit as end:
        ending.status = 0 if end.code is None else end.code
        raise


def _obey(arguments: list[str] | None) -> None:
    """Open the desktop if there are only names of files, or nothing; else read the command line."""
    keep_current_folder_out()
    reason = reason_against()
    if reason is not None:
        sys.exit(reason)
    words = sys.argv[1:] if arguments is None else arguments
    try:
        if not any(word.startswith("-") for word in words) and not COMMANDS.intersection(words[:1]):
            from desire_tui.launch import is_possible, open_desktop

            if is_possible():
                open_desktop(tuple(words))
        from desire_tui.cli import main as command_line

        command_line(arguments, prog_name="desire")
    except KeyboardInterrupt:  # Ctrl-C while modules are still being loaded
        sys.stderr.write("stopped by the user\n")
        sys.exit(3)
    except SystemExit as end:
        _leave_at_once(end.code)
        raise


class _QuickEnd:
    """Ends the process when all who wanted to be told of its end have been.

    What Python does after that gives back, object by object, memory that the system takes back at once, and
    lets LLVM do the same: 40 to 80 ms.
    """

    def __init__(self) -> None:
        self.status: object = None
        """Of the process; None or a text: that is Python's to report."""
        atexit.register(self._leave)  # the first to be registered is the last to be called

    def _leave(self) -> None:
        if not isinstance(self.status, int):
            return
        try:
            sys.stdout.flush()
            sys.stderr.flush()
        except (OSError, ValueError):  # Python says so, and has a status for it
            return
        os._exit(self.status & 0xFF)


def _leave_at_once(status: object) -> None:
    """End here if a library is in a long call, for which `sys.exit` would wait."""
    work = sys.modules.get("desire_tui.engine.exclusive_work")  # else nothing was computed
    if work is not None and (status is None or isinstance(status, int)):
        work.leave_at_once(status or 0)


def keep_current_folder_out() -> None:
    """Import nothing from the folder that programs of strangers may stand in.

    `python -m` and an empty entry in PYTHONPATH put it before the libraries: its `numpy.py` would run as
    ours. The folder of this package itself stays, and those of Python.
    """
    try:
        here = os.path.realpath(os.getcwd())  # noqa: PTH109 - pathlib is not loaded yet
    except OSError:  # it was deleted
        here = ""
    own = (os.path.dirname(os.path.dirname(os.path.abspath(__file__))), sys.prefix, sys.base_prefix)  # noqa: PTH100, PTH120
    sys.path[:] = [
        entry for entry in sys.path
        if os.path.isabs(entry) and (os.path.realpath(entry) != here or entry.startswith(own))  # noqa: PTH117
    ]  # fmt: skip


if __name__ == "__main__":
    main()
