"""The command line: `desire`, its commands and all their options.

A file for each family of commands, which all know how a command ends (`ending`); `group` is `desire` itself.
Nothing here is heavy: what a command needs is imported when it runs.
"""

from __future__ import annotations

from desire_tui.cli.analysis_commands import analysis_commands
from desire_tui.cli.check_command import check
from desire_tui.cli.completion_command import completion
from desire_tui.cli.convert_command import convert
from desire_tui.cli.export_command import export
from desire_tui.cli.format_command import fmt
from desire_tui.cli.group import ide, main
from desire_tui.cli.information import config, examples, help_
from desire_tui.cli.lsp_command import lsp
from desire_tui.cli.run_command import run
from desire_tui.cli.serve_command import serve, served
from desire_tui.cli.study_command import study

for _command in (
    ide,
    run,
    check,
    convert,
    help_,
    examples,
    config,
    completion,
    serve,
    served,
    study,
    fmt,
    lsp,
    export,
    *analysis_commands(),
):
    main.add_command(_command)

__all__ = ["check", "main", "run"]
