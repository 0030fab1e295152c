"""`desire examples --copy DIR`: the example programs as files of one's own."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from desire_tui.engine.visible_text import visible_line

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path


def copy_examples(programs: Sequence[Path], root: Path, folder: Path) -> int:
    """Copy programs below `root` to the same places below `folder`; return the exit status, 0.

    A file that is there stays as it is, so that one's own changes do; which did is told. OSError: what the
    machine refuses.
    """
    kept, copied = [], 0
    for program in programs:
        target = folder / program.relative_to(root)
        target.parent.mkdir(parents=True, exist_ok=True)
        try:
            with target.open("xb") as file:
                file.write(program.read_bytes())
        except FileExistsError:
            if target.read_bytes() != program.read_bytes():
                kept.append(target)
            continue
        copied += 1
    place = visible_line(str(folder))
    sys.stdout.write(f"{copied} program{'s' * (copied != 1)} copied to {place}\n")
    if kept:
        names = ", ".join(visible_line(str(path)) for path in kept)
        sys.stderr.write(f"not copied, as a changed file is there: {names}\n")
    return 0
