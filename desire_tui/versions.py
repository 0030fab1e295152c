"""The versions of this package and of everything that it stands on, for reports of faults."""

from __future__ import annotations

import platform
import re
from importlib import metadata

from desire_tui.version import __version__

_REQUIREMENT = re.compile(r"([\w.-]+)(?:[^;]*;.*extra == ['\"](\w+)['\"])?")
_FOR_DEVELOPERS = frozenset({"all", "dev", "docs"})


def versions() -> list[str]:
    """Return lines: this package, Python and the machine, what is needed, what extras bring."""
    lines = [f"desire, version {__version__}"]
    lines.append(f"Python {platform.python_version()}, {platform.system()} {platform.machine()}")
    needed, by_extra = _requirements()
    if needed:
        lines.append(", ".join(_version(name) for name in needed))
    lines += [f"[{extra}] {', '.join(map(_version, names))}" for extra, names in by_extra.items()]
    return lines


def _requirements() -> tuple[list[str], dict[str, list[str]]]:
    """Return names of what is always needed, and by extra; nothing where the package is not installed."""
    try:
        every = metadata.requires("desire-tui") or []
    except metadata.PackageNotFoundError:  # a clone, by PYTHONPATH
        return [], {}
    needed: list[str] = []
    by_extra: dict[str, list[str]] = {}
    for requirement in every:
        found = _REQUIREMENT.match(requirement)
        if found is None or found[1] == "desire-tui":  # [all] names our own extras
            continue
        if found[2] is None:
            needed.append(found[1])
        elif found[2] not in _FOR_DEVELOPERS:
            by_extra.setdefault(found[2], []).append(found[1])
    return needed, by_extra


def _version(name: str) -> str:
    try:
        return f"{name} {metadata.version(name)}"
    except metadata.PackageNotFoundError:
        return f"{name} not installed"
