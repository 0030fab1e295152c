"""The line of a `%%desire` cell: `--set k=3 --record y --name run --timeout 10 --sliders a=0..5`."""

from __future__ import annotations

import argparse
import re
import shlex
from math import isfinite
from typing import TYPE_CHECKING, NamedTuple, NoReturn

from desire_tui.batch.set_option import from_texts
from desire_tui.engine.diagnostics import closest
from desire_tui.notebooks.cell_error import CellError

if TYPE_CHECKING:
    from collections.abc import Sequence

DEFAULT_NAME = "result"
_OPTIONS = ("--set", "--record", "--name", "--timeout", "--sliders")
_SLIDER = re.compile(
    r"\s*(?P<name>[A-Za-z][\w$]*(?:\[[\d\s,]+\])?)\s*=\s*(?P<least>[^,\s]+?)\.\.(?P<most>[^,:\s]+)(?::(?P<step>[^,\s]+))?\s*(?:,|$)"
)


class SliderRange(NamedTuple):
    """A parameter that a slider moves; `step` 0: a hundredth of the range."""

    name: str
    least: float
    most: float
    step: float


class CellOptions(NamedTuple):
    """What the line says."""

    settings: dict[str, float]
    record: tuple[str, ...]
    name: str
    timeout: float | None
    sliders: tuple[SliderRange, ...]


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise CellError(f"%%desire: {message}")


def read_options(line: str) -> CellOptions:
    """Return what the line of a cell says. CellError: what is wrong with it."""
    parser = _Parser(prog="%%desire", add_help=False, allow_abbrev=False)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--record", action="append", default=[])
    parser.add_argument("--name", default=DEFAULT_NAME)
    parser.add_argument("--timeout", type=float)
    parser.add_argument("--sliders", action="append", default=[])
    try:
        words = shlex.split(line)
    except ValueError as error:
        raise CellError(f"%%desire: {error}") from None
    found, others = parser.parse_known_args(words)
    if others:
        near = closest(others[0].partition("=")[0], _OPTIONS)
        hint = f"did you mean {near}?" if near else f"there are {', '.join(_OPTIONS)}"
        raise CellError(f"%%desire has no option '{others[0]}'; {hint}")
    if not found.name.isidentifier():
        raise CellError(f"%%desire --name {found.name}: that cannot be the name of a Python variable")
    if found.timeout is not None and not (found.timeout > 0 and isfinite(found.timeout)):
        raise CellError(f"%%desire --timeout {found.timeout:g}: give seconds above 0")
    try:
        settings = from_texts(found.set)
    except ValueError as error:
        raise CellError(f"%%desire --set {error}: write NAME=NUMBER, such as --set k=3") from None
    record = tuple(name for names in found.record for name in re.split(r",(?![^\[]*\])", names) if name)
    return CellOptions(settings, record, found.name, found.timeout, _sliders(found.sliders))


def _sliders(texts: Sequence[str]) -> tuple[SliderRange, ...]:
    found: list[SliderRange] = []
    for text in texts:
        at = 0
        while at < len(text):
            part = _SLIDER.match(text, at)
            if part is None:
                raise CellError(
                    f"%%desire --sliders {text}: write NAME=LEAST..MOST, such as a=0..5 or a=0..5:0.1"
                )
            found.append(_slider(part, text))
            at = part.end()
    return tuple(found)


def _slider(part: re.Match[str], text: str) -> SliderRange:
    try:
        least, most, step = (float(part[key] or 0) for key in ("least", "most", "step"))
    except ValueError as error:
        raise CellError(f"%%desire --sliders {text}: {error}") from None
    if not (least < most and step >= 0 and isfinite(most - least)):
        raise CellError(f"%%desire --sliders {text}: {part['name']} needs a range that rises")
    return SliderRange(part["name"].replace(" ", ""), least, most, step)
