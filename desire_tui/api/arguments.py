"""Checks of what callers give: a wrong name is an error that says the nearest right one."""

from __future__ import annotations

from math import isfinite
from operator import index
from typing import TYPE_CHECKING, Any, NoReturn, get_args

from desire_tui.engine.diagnostics import closest
from desire_tui.engine.session.session import BackendName

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

BACKENDS: tuple[BackendName, ...] = get_args(BackendName)


def refuse_name(function: str, what: str, name: str, known: Iterable[str]) -> NoReturn:
    """Raise TypeError: there is no such keyword."""
    near = closest(name, known)
    hint = f"; did you mean {near!r}?" if near else ""
    raise TypeError(f"{function}() has no {what} {name!r}{hint}")


def checked_backend(name: str) -> BackendName:
    """Return a back end's name. ValueError: there is no such back end."""
    for known in BACKENDS:
        if name == known:
            return known
    near = closest(str(name), BACKENDS)
    hint = f"did you mean {near!r}?" if near else f"there are {' and '.join(map(repr, BACKENDS))}"
    raise ValueError(f"backend={name!r} is unknown; {hint}")


def checked_timeout(seconds: float | None) -> float | None:
    """Return a time limit. ValueError: it is no time that can pass."""
    if seconds is None:
        return None
    if isinstance(seconds, bool) or not isinstance(seconds, int | float):
        raise TypeError(f"timeout is a number of seconds or None, not {seconds!r}")
    if not seconds > 0 or not isfinite(seconds):
        raise ValueError(f"timeout={seconds!r} is no time that can pass: give seconds above 0, or None")
    return float(seconds)


def checked_count(argument: str, number: Any, least: int = 1) -> int | None:
    """Return a whole number, NumPy's too. TypeError: it is none; ValueError: it is too small."""
    if number is None:
        return None
    try:
        whole = index(number)
    except TypeError:
        whole = None
    if isinstance(number, bool) or whole is None:
        raise TypeError(f"{argument} is a whole number or None, not {number!r}")
    if whole < least:
        raise ValueError(f"{argument}={number!r} cannot be: give {least} or more, or None")
    return whole


def checked_mapping(argument: str, given: Any) -> Mapping[str, Any]:
    """Return what is given by names; nothing for None. TypeError: it is no mapping."""
    if given is None:
        return {}
    if not hasattr(given, "items"):
        raise TypeError(f"{argument} is a mapping of names, such as {{'k': …}}, or None, not {given!r}")
    found: Mapping[str, Any] = given
    return found


def checked_names(record: str | Iterable[str]) -> tuple[str, ...]:
    """Return names of what is to be recorded. TypeError: they are none."""
    if isinstance(record, str):
        return (record,)
    try:
        names = tuple(record)
    except TypeError:
        names = (record,)  # type: ignore[assignment]
    for name in names:
        if not isinstance(name, str):
            raise TypeError(f"record is a name or a list of names, not {record!r}")
    return names


def checked_function(argument: str, function: Any) -> None:
    """TypeError: what is to be called while runs go on is no function."""
    if function is not None and not callable(function):
        raise TypeError(f"{argument} is a function or None, not {function!r}")


def checked_lines(lines: Any) -> tuple[str, ...]:
    """Return the lines that a script's `input` reads. TypeError: they are none."""
    if isinstance(lines, str) or not hasattr(lines, "__iter__"):
        raise TypeError(f"input is a list of lines, not {lines!r}")
    return tuple(map(str, lines))
