"""What a work is, and how long it takes."""

from __future__ import annotations

import resource
import time
from collections.abc import Callable

Prepared = Callable[[], object]
"""What is measured. If it returns a float, that is how many seconds it took."""
Work = Callable[[], Prepared]
"""Prepares, and returns what is measured."""


def seconds(work: Prepared, count: int) -> float:
    """Return what so many times take: processor time of this process and of those it has waited for."""
    began, told = _processor_time(), 0.0
    for _ in range(count):
        answer = work()
        told += answer if isinstance(answer, float) else 0.0
    return told or _processor_time() - began


def wait_until_idle() -> None:
    """Return when no other thread of this process has computed for 30 ms."""
    before = -1.0
    while time.process_time() - before > 0.002:
        before = time.process_time()
        time.sleep(0.03)


def _processor_time() -> float:
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime
