"""Runs one program for the server, in a process of its own: a run may take long, or need all memory.

`python -m desire_tui.lsp.run_worker` reads a request as JSON from standard input and writes what became of it
to standard output. The program may do what `desire run` lets it: no shell, no files outside its folder.
"""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from desire_tui.batch.runner import Runner

CONSOLE_MAX = 100_000
"""Characters of console text that are handed on: its end."""


def run(request: dict[str, Any]) -> dict[str, Any]:
    """Run a program; return status, problems, console text, pictures and final values of scalars.

    `text`, `name`, `path` (None: it has no file) say what to run, `picture` where its graph goes.
    """
    from desire_tui.batch.headless_listener import HeadlessListener
    from desire_tui.batch.runner import Runner, RunOptions
    from desire_tui.engine.source import Source

    path = Path(request["path"]) if request["path"] else None
    listener = HeadlessListener(lambda _: None, iter(()), lambda _: None)
    source = Source(request["text"], request["name"], path)
    runner = Runner(source, RunOptions(has_folder=path is not None), listener)
    runner.run()
    pictures = _pictures(runner, Path(request["picture"]))
    result = runner.result()
    values = {name: value for name, value in result.quantities.items() if isinstance(value, int | float)}
    return {
        "status": runner.status,
        "problems": [asdict(problem) for problem in result.problems],
        "console": result.console[-CONSOLE_MAX:],
        "runs": [run.summary for run in result.runs],
        "pictures": pictures,
        "values": values,
    }


def _pictures(runner: Runner, path: Path) -> list[str]:
    """Write a program's graphs; return where they are."""
    from desire_tui.engine.diagnostics import DesireError
    from desire_tui.engine.outputs.picture_files import write_pictures

    graphs = [page for page in runner.session.graphs if not page.is_empty]
    if not graphs:
        return []
    try:
        write_pictures(graphs, path)
    except DesireError as error:
        runner.problems.extend(error.diagnostics)
    return [str(made) for made in sorted(path.parent.glob(f"{path.stem}*{path.suffix}"))]


def main() -> None:
    """Answer one request."""
    request = json.loads(sys.stdin.buffer.read())
    answer = json.dumps(run(request))
    sys.stdout.write(answer)
    sys.stdout.flush()


if __name__ == "__main__":
    main()
