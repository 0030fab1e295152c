"""The process that does works: it reads orders and answers with seconds."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from benchmarks.against.front_ends import FRONT_ENDS
from benchmarks.against.runs import runs_and_scripts
from benchmarks.against.work import seconds

if TYPE_CHECKING:
    from benchmarks.against.work import Prepared

WORKS = {**runs_and_scripts(), **FRONT_ENDS}


def serve() -> None:
    """Do what the lines of the input say until it ends: `prepare NAME`, `repeat COUNT`, `forget`."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what works print is not an answer
    work: Prepared | None = None
    for line in sys.stdin:
        order, _, argument = line.rstrip("\n").partition(" ")
        try:
            count = int(argument) if order == "repeat" else 1
            if order == "prepare":
                work = WORKS[argument]()
            elif order == "forget":
                work = None
            answer = f"{seconds(work, count) if work is not None else 0.0:.9f}"
        except Exception as problem:  # noqa: BLE001 - `against` tells of it: old versions do not know all works
            answer = f"{type(problem).__name__}: {problem}".replace("\n", " ")
        answers.write(answer + "\n")
        answers.flush()
