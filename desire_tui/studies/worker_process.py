"""Loaded into the worker processes of a local cluster when they begin (a `preload` of distributed)."""

from __future__ import annotations

import signal


def dask_setup(worker: object) -> None:
    """Leave Ctrl-C, which a terminal sends to all processes, to the study: it ends its workers in order."""
    del worker
    signal.signal(signal.SIGINT, signal.SIG_IGN)
