"""`desire lsp`: the language server."""

from __future__ import annotations

import sys
from importlib.util import find_spec

import click

from desire_tui.batch.ending import guarded


@click.command()
@click.option("--stdio", is_flag=True, help="Talk on standard input and output; it always does.")
def lsp(*, stdio: bool) -> None:
    """Answer an editor about programs: problems, completion, help, names, layout, runs.

    A language server (LSP 3.17) that editors start themselves; docs/editors.md says how. Needs
    pip install 'desire-tui[lsp]'.
    """
    del stdio  # clients give it because other servers want it
    if find_spec("pygls") is None:
        raise click.UsageError("desire lsp needs pygls: pip install 'desire-tui[lsp]'")

    def work() -> int:
        from desire_tui.lsp.server import serve

        serve()
        return 0

    sys.exit(guarded(work))
