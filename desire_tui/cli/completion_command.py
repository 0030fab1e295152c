"""`desire completion`: what a shell needs to complete commands, options and names of programs."""

from __future__ import annotations

import click

_USE = """\
To have it in every new shell:

\b
  bash: desire completion bash > ~/.local/share/bash-completion/completions/desire
  zsh:  desire completion zsh > "${fpath[1]}/_desire"
  fish: desire completion fish > ~/.config/fish/completions/desire.fish
"""


@click.command(help=f"Print the shell code that completes commands, options and file names.\n\n{_USE}")
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
def completion(context: click.Context, shell: str) -> None:
    """Print a shell's completion code."""
    from click.shell_completion import get_completion_class

    completer = get_completion_class(shell)
    assert completer is not None, shell
    source = completer(context.find_root().command, {}, "desire", "_DESIRE_COMPLETE").source()
    click.echo(source.strip("\n"))
