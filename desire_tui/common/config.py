"""The user's configuration: a TOML file.

What is wrong in it is named by file, key and nearest key; the rest counts.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

from desire_tui.commands import BY_ID, COMMANDS, binding_ids
from desire_tui.common.paths import config_file
from desire_tui.engine.diagnostics import closest
from desire_tui.engine.thread_count import THREADS_MOST
from desire_tui.engine.user_folders import ignored_variables

if TYPE_CHECKING:
    from pathlib import Path


@dataclass
class Config:
    """Settings with their defaults."""

    theme: str = "dark"
    """dark, light, contrast, publication, or any theme of Textual's."""
    frames_per_second: int = 33
    """How often the graph is drawn during a run, 1 … 60."""
    completion_after: int = 3
    """Letters after which completions are offered by themselves; 0: only on demand."""
    restore_session: bool = True
    """Open the tabs of the last session when no file is named."""
    checkpoint_seconds: int = 1
    """How often unsaved work is written to the recovery file, 1 … 600."""
    plain_characters: bool = False
    """Whether blocks are drawn for braille, straight corners for round ones, as on the Linux console."""
    threads: int = 0
    """Threads for one run of a large model, in every command (`engine.thread_count`); 0: all cores."""
    keys: dict[str, str] = field(default_factory=dict)
    """Action → keys."""


LIMITS = {
    "frames_per_second": (1, 60),
    "completion_after": (0, 20),
    "checkpoint_seconds": (1, 600),
    "threads": (0, THREADS_MOST),
}
ABOUT = {
    "theme": "dark, light, contrast, publication, or a theme of Textual's",
    "frames_per_second": "how often the graph is drawn during a run",
    "completion_after": "letters after which completions open by themselves; 0: on demand only",
    "restore_session": "open the tabs of the last session when no file is named",
    "checkpoint_seconds": "how often unsaved work goes to the recovery file",
    "plain_characters": "blocks for braille, for fonts that lack it; the Linux console gets them anyway",
    "threads": "threads for one run of a model with more than 65,536 elements; 0: all cores",
}


def load(path: Path | None = None) -> tuple[Config, list[str]]:
    """Read the configuration; returns it with a sentence for each thing wrong in it."""
    path = path or config_file()
    settings, wrong = Config(), ignored_variables()
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return settings, wrong
    except (OSError, UnicodeDecodeError) as error:
        return settings, [*wrong, _unreadable(path, error)]
    import tomllib  # most people have no such file, and open the desktop 10 ms sooner

    try:
        stored = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        return settings, [*wrong, _unreadable(path, error)]
    known = {entry.name: entry for entry in fields(Config)}
    for key, value in stored.items():
        if key not in known:
            wrong.append(f"{path}: unknown key '{key}'{_nearest(key, list(known))}")
        elif key == "keys":
            wrong += [f"{path}: {sentence}" for sentence in _read_keys(settings, value)]
        elif (sentence := _misfit(key, value, getattr(settings, key))) is not None:
            wrong.append(f"{path}: '{key}' {sentence}")
        else:
            setattr(settings, key, value)
    return settings, wrong


def _unreadable(path: Path, error: Exception) -> str:
    return f"{path}: {getattr(error, 'strerror', None) or error}; the defaults are used"


def keymap(settings: Config) -> dict[str, str]:
    """Return Textual's keymap: the first binding of a command gets the keys, its others none."""
    mapped = {}
    for command_id, keys in settings.keys.items():
        first, *others = binding_ids(BY_ID[command_id])
        mapped[first] = keys
        mapped |= dict.fromkeys(others, keys)
    return mapped


def defaults_text() -> str:
    """Return a configuration file that says what the defaults are, everything commented out."""
    settings = Config()
    lines = ["# Desire's configuration. Remove the # of what you change.", ""]
    for key, about in ABOUT.items():
        value = getattr(settings, key)
        shown = f'"{value}"' if isinstance(value, str) else str(value).lower()
        lines += [f"# {about}", f"# {key} = {shown}", ""]
    lines += ["# Keys: several are separated by commas.", "[keys]"]
    lines += [f'# "{command.id}" = "{command.keys}"'.ljust(52) + f"# {command.title}" for command in COMMANDS]
    return "\n".join(lines) + "\n"


def _nearest(key: str, known: list[str]) -> str:
    close = closest(key, known)
    return (
        f"; did you mean '{close}'?"
        if close
        else f"; there are: {', '.join(known)}"
        if len(known) < 10
        else ""
    )


def _misfit(key: str, value: Any, default: Any) -> str | None:
    if type(value) is not type(default):
        wanted = {bool: "true or false", int: "a whole number", str: "a text in quotes"}[type(default)]
        return f"must be {wanted}, not {value!r}"
    if key in LIMITS and not LIMITS[key][0] <= value <= LIMITS[key][1]:
        return f"must lie within {LIMITS[key][0]} … {LIMITS[key][1]}, not {value}"
    return None


def _read_keys(settings: Config, stored: Any) -> list[str]:
    if not isinstance(stored, dict):
        return ["'keys' must be a table: [keys]"]
    wrong = []
    for command_id, keys in stored.items():
        if isinstance(keys, dict):  # unquoted run.start = "f5" nests
            stored_names = {f"{command_id}.{name}": value for name, value in keys.items()}
            wrong += _read_keys(settings, stored_names)
        elif command_id not in BY_ID:
            wrong.append(f"unknown action '{command_id}' in [keys]{_nearest(command_id, list(BY_ID))}")
        elif not isinstance(keys, str) or not keys.strip():
            wrong.append(f"the keys of '{command_id}' must be a text such as \"f5\", not {keys!r}")
        else:
            settings.keys[command_id] = keys.replace(" ", "")
    return wrong
