"""Help pages: one for every statement, library function, system variable, command and error.

The pages are plain Markdown, built from tables: `pages/*.toml` (statements, commands, variables), the
function library, and the error wordings. The help pane, F1, completion and `docs/` all read them here.
"""
