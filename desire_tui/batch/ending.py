"""How every command ends: its exit status, and what the machine refuses as a message."""

from __future__ import annotations

import os
import signal
import sys
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

from desire_tui.engine.user_folders import ignored_variables
from desire_tui.engine.visible_text import visible

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


class WrongUsage(ValueError):  # noqa: N818 - what click calls UsageError
    """Words that cannot be meant so together; the text says why."""


class _ToldToEnd(BaseException):
    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


@contextmanager
def giving_up_files() -> Iterator[None]:
    """Let SIGTERM and SIGHUP end the process when the file being written is given up: no part of it stays."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def give_up(number: int, _: object) -> None:
        raise _ToldToEnd(number)

    before = {
        number: signal.signal(number, give_up)
        for number in (signal.SIGTERM, signal.SIGHUP)
        if signal.getsignal(number) is signal.SIG_DFL
    }
    try:
        yield
    except _ToldToEnd as told:
        signal.signal(told.number, signal.SIG_DFL)
        os.kill(os.getpid(), told.number)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def guarded(work: Callable[[], int]) -> int:
    """Run a command; what the machine refuses (a closed pipe, a full disk) is a message, not a traceback."""
    for sentence in ignored_variables():
        sys.stderr.write(f"warning: {visible(sentence)}\n")
    try:
        status = int(work())
        sys.stdout.flush()
    except BrokenPipeError:
        # the reader of our output has left (`| head`): nothing more to say, and nothing to flush at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except KeyboardInterrupt:
        sys.stderr.write("stopped by the user\n")
        return 3
    except OSError as reason:
        sys.stderr.write(f"error 106: cannot write: {reason.strerror or reason}\n")
        return 1
    return status
