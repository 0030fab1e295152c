"""Runs, when their fast code is in, and scripts, when their texts are known: each rule's, `programs.txt`."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING

from benchmarks.against.work import wait_until_idle

if TYPE_CHECKING:
    from collections.abc import Iterator

    from benchmarks.against.work import Prepared, Work

PROGRAMS = Path(__file__).with_name("programs.txt")
"""Programs behind lines with their names: == NAME."""
LORENZ = "d/dt x = a*(y - x)\nd/dt y = x*(r - z) - y\nd/dt z = x*y - b*z\ndispt x, y, z"
_SMALL = {
    "Lorenz": ("a = 10 | b = 8/3 | r = 28 | x = 1 | y = 1 | z = 1", 10.0, LORENZ),
    "van der Pol": ("x = 2", 20.0, "d/dt x = v\nd/dt v = 3*(1 - x*x)*v - x\ndispt x"),
    "orbit": (
        "x = 0.5 | v = sqrt(3)", 12.0,
        "r = sqrt(x*x + y*y)\nd/dt x = u\nd/dt y = v\nd/dt u = -x/r^3\nd/dt v = -y/r^3\ndispt x, y",
    ),
}  # fmt: skip
_HEAT = "Vectr d/dt u = u{1} - 2*u + u{-1}\nmiddle = u[500]\ndispt middle"
_RULES = (1, 2, 3, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16)
_FIXED = (1, 2, 3, 5)


def runs_and_scripts() -> dict[str, Work]:
    """Return the works."""
    works: dict[str, Work] = {}
    for rule in _RULES:
        works |= {f"rule {rule:2}, {name}": partial(_runs, text) for name, text in _of_rule(rule)}
    for part in PROGRAMS.read_text(encoding="utf-8").split("== ")[1:]:
        name, _, text = part.partition("\n")
        works[name] = partial(_scripts if name.startswith("script: ") else _runs, text)
    many = "a = 1000 | b = 1000 | DT = 0.0001 | NN = 3 | "
    for setting in ("irule 3 | TMAX = 0.03", "irule 16 | ERMAX = 0.001 | TMAX = 0.002"):
        works[f"1401 equations, {setting}"] = partial(_runs, f"{many}{setting}\ndrun\nDYNAMIC\n{ladder(700)}")
    return works


def ladder(count: int) -> str:
    """Return an LC ladder of 2·count + 1 scalar equations."""
    lines = ["d/dt i0 = b*(1 - v1 - i0)"]
    for k in range(1, count + 1):
        after = f"v{k + 1}" if k < count else f"i{k}"
        lines += [f"d/dt v{k} = a*(i{k - 1} - i{k})", f"d/dt i{k} = b*(v{k} - {after})"]
    return "\n".join([*lines, "dispt v1"])


def _of_rule(rule: int) -> Iterator[tuple[str, str]]:
    """Yield small models, scalar equations and an array under a rule."""
    rest = "drun\nDYNAMIC\n"
    for name, (script, end, body) in _SMALL.items():
        times = f"TMAX = {10 * end} | DT = 0.0002" if rule in _FIXED else f"TMAX = {3 * end} | DT = 0.001"
        yield name, f"irule {rule} | ERMAX = 1e-7 | {times} | NN = 201\n{script}\n{rest}{body}"
    head = f"irule {rule} | ERMAX = 1e-5 | NN = 3"
    end = 0.05 if rule in _FIXED else 0.01
    script = f"a = 1000 | b = 1000 | TMAX = {end} | DT = 0.0001"
    yield "401 equations", f"{head} | {script}\n{rest}{ladder(200)}"
    script = "STATE u[1000] | u[500] = 1 | TMAX = 20 | DT = 0.05"
    yield "heat, 1,000 states", f"{head} | {script}\n{rest}{_HEAT}"


def _runs(text: str) -> Prepared:
    """Prepare a program whose run is then repeated."""
    from desire_tui.engine.session.session import Session
    from desire_tui.engine.source import Source

    session = Session()
    session.erun(Source(text, "work"))
    assert session.runs
    for _ in range(
        3
    ):  # the second thread compiles fast code meanwhile, some of it once runs have lasted 15 ms
        end = process_time() + 0.02
        while process_time() < end:
            session.execute("drunr")
        wait_until_idle()
    return lambda: session.execute("drunr")


def _scripts(text: str) -> Prepared:
    """Prepare a script that is then carried out again and again."""
    from desire_tui.engine.session.session import Session
    from desire_tui.engine.source import Source

    session = Session()
    session.erun(Source(text, "work"))
    wait_until_idle()
    return lambda: session.erun(Source(text, "work"))
