"""Where `desire` and `python -m desire_tui` begin."""

from __future__ import annotations

import sys

COMMANDS = frozenset({"run", "check", "config", "serve", "ide"})
"""As in `cli`, which takes 30 ms to import; a test holds them together."""


def main(arguments: list[str] | None = None) -> None:
    """Open the desktop if there are only names of files, or nothing; else read the command line."""
    words = sys.argv[1:] if arguments is None else arguments
    try:
        if not any(word.startswith("-") for word in words) and not COMMANDS.intersection(words[:1]):
            from desire_tui.launch import is_possible, open_desktop

            if is_possible():
                open_desktop(tuple(words))
        from desire_tui.cli import main as command_line

        command_line(arguments)
    except KeyboardInterrupt:  # Ctrl-C while modules are still being loaded
        sys.stderr.write("stopped by the user\n")
        sys.exit(3)


if __name__ == "__main__":
    main()
