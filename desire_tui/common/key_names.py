"""Keys as people call them."""

from __future__ import annotations

_NAMES = {
    "ctrl": "Ctrl", "alt": "Alt", "shift": "Shift", "pagedown": "PgDn", "pageup": "PgUp", "backslash": "\\",
    "underscore": "_", "at": "@", "equals_sign": "=", "plus": "+", "minus": "-", "left": "←", "right": "→",
    "up": "↑", "down": "↓", "space": "Space", "escape": "Esc", "enter": "Enter", "tab": "Tab", "delete":
    "Del", "slash": "/", "full_stop": ".", "comma": ",", "semicolon": ";", "apostrophe": "'",
    "home": "Home", "end": "End", "insert": "Ins", "backspace": "Backspace",
}  # fmt: skip


def key_name(key: str) -> str:
    """Return one key's name: `ctrl+pagedown` → `Ctrl+PgDn`."""
    return "+".join(
        _NAMES.get(part, part.upper() if len(part) == 1 or part[0] == "f" else part)
        for part in key.split("+")
    )


def key_names(keys: str) -> str:
    """Return the names of keys that are separated by commas."""
    return ", ".join(dict.fromkeys(key_name(key) for key in keys.split(",") if key))
