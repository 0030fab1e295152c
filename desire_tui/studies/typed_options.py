"""A study as it is typed on the desktop's command line: the options of `desire study`, quotes not needed."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from desire_tui.batch.set_option import from_texts
from desire_tui.engine.diagnostics import DesireError, Diagnostic, closest
from desire_tui.studies.design import METHODS

if TYPE_CHECKING:
    from collections.abc import Iterator

EXAMPLE = "study --over k=1:10:10 --keep x[end]"
OPTIONS = (
    "over",
    "sample",
    "points",
    "runs",
    "design",
    "seed",
    "keep",
    "set",
    "segment",
    "output",
    "threads",
)
_WHOLE = {"runs": 1000, "seed": 7, "threads": 2}
"""Options that take a whole number, with an example of each."""
_SHORT = {"-o": "output"}
_OPTION = re.compile(r"(?:^|\s)(--[A-Za-z-]+|-o)(?=[\s=]|$)")
_QUOTES = "\"'"


def typed_options(text: str) -> dict[str, Any]:
    """Return the options in `--over k=1:10:10 --keep x[end], max(v)`. DesireError 510: what is wrong."""
    found: dict[str, Any] = {"over": [], "sample": [], "keep": [], "settings": {}}
    single: dict[str, str] = {}
    sets: list[str] = []
    for name, value in _pairs(text):
        match name:
            case "over" | "sample" | "keep":
                found[name].append(value)
            case "set":
                sets.append(value)
            case _:
                single[name] = value
    try:
        found["settings"] = from_texts(sets)
    except ValueError as wrong:
        raise _wrong(f"'{wrong}' sets nothing", "--set TMAX=2") from None
    for name in _WHOLE:
        found[name] = _whole(name, single[name]) if name in single else None
    method = single.get("design", METHODS[0])
    if method not in METHODS:
        raise _wrong(f"there is no design '{method}'", ", ".join(METHODS))
    return {
        **found, "design": method, "points": single.get("points"), "segment": single.get("segment"),
        "output": single.get("output"),
    }  # fmt: skip


def _pairs(text: str) -> Iterator[tuple[str, str]]:
    places = list(_OPTION.finditer(text))
    before = text[: places[0].start()] if places else text
    if before.strip():
        raise _wrong(f"'{before.strip()}' belongs to no option", EXAMPLE)
    ends = [place.start() for place in places[1:]] + [len(text)]
    for place, end in zip(places, ends, strict=True):
        word = place[1]
        name = _SHORT.get(word, word[2:])
        if name not in OPTIONS:
            near = closest(name, OPTIONS)
            known = ", ".join(f"--{option}" for option in OPTIONS)
            raise _wrong(f"'{word}' is no option of a study", f"did you mean --{near}?" if near else known)
        value = text[place.end() :][: end - place.end()].strip().removeprefix("=").strip()
        if len(value) > 1 and value[0] == value[-1] and value[0] in _QUOTES:
            value = value[1:-1]
        if not value:
            raise _wrong(f"nothing stands behind '{word}'", EXAMPLE)
        yield name, value


def _whole(name: str, text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = -1
    if value < (0 if name == "seed" else 1):
        raise _wrong(f"--{name} {text}: no whole number that can be meant", f"--{name} {_WHOLE[name]}")
    return value


def _wrong(what: str, remedy: str) -> DesireError:
    return DesireError(Diagnostic("study-form", None, {"what": what, "remedy": remedy}))
