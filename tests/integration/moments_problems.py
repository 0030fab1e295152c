"""What happens at a moment, as Desire programs with exact ends: pulses, switches, roots, events, delays."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, log, pi, sqrt

from desire_tui.engine.integration.rules import rules_of
from desire_tui.engine.session.listener import Listener
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source

RULES = rules_of("variable", "multistep", "series")
ERMAX = 1e-6


@dataclass(frozen=True)
class Moment:
    """A program without its rule; `end` is the exact value of `name` at the end, `largest` its largest magnitude."""

    title: str
    settings: str
    body: str
    name: str
    end: float
    largest: float

    def program(self, rule: int) -> str:
        return f"{self.settings} | irule {rule} | ERMAX = {ERMAX}\ndrun\nDYNAMIC\n{self.body}\n"


def _bounces() -> float:
    """v(20) of a ball from 50 m that keeps 80 % of its speed: parabolas between impacts."""
    g, keeps = 9.8, 0.8
    at, speed = sqrt(100.0 / g), sqrt(100.0 * g)
    while True:
        speed *= keeps
        flight = 2.0 * speed / g
        if at + flight > 20.0:
            return speed - g * (20.0 - at)
        at += flight


MOMENTS = (
    Moment(
        "pulse of 0.5 every 100, NN = 101", "TMAX = 1000 | NN = 101 | DT = 0.01",
        "ph = t - 100*trnc(t/100)\nd/dt m = 40*swtch(ph - 10)*swtch(10.5 - ph)\ndispt m", "m", 200.0, 200.0,
    ),
    Moment(
        "one pulse of 1, then a long decay, NN = 21", "TMAX = 20 | NN = 21 | DT = 0.01",
        "d/dt m = -m + 5*swtch(t - 10)*swtch(11 - t)\ndispt m", "m", 5 * (1 - exp(-1)) * exp(-9), 5 * (1 - exp(-1)),
    ),
    Moment(
        "sgn(sin(6*t)), NN = 11", "TMAX = 10 | NN = 11 | DT = 0.01", "d/dt x = sgn(sin(6*t))\ndispt x", "x",
        20 * pi / 6 - 10, pi / 6,
    ),
    Moment(
        "free fall from 50, term -y: t", "y = 50 | TMAX = 10 | NN = 21 | DT = 0.01",
        "d/dt y = v\nd/dt v = -9.8\nterm -y\ndispt y", "t", sqrt(100 / 9.8), 3.2,
    ),
    Moment(
        "bouncing ball by event: v(20)", "y = 50 | TMAX = 20 | NN = 21 | DT = 0.01",
        "d/dt y = v\nd/dt v = -9.8\ndispt y\nevent -y\nv = -0.8*v | y = 0", "v", _bounces(), 31.3,
    ),
    Moment(
        "10 mg every 24: A(95.5)", "TMAX = 95.5 | NN = 5 | DT = 0.01",
        "d/dt A = -0.1*A\ndispt A\nevery 24\nA = A + 10", "A",
        sum(10 * exp(-0.1 * (95.5 - 24 * k)) for k in range(4)), 11.1,
    ),
    Moment(
        "d/dt x = -delay(x, 1): x(2)", "x = 1 | TMAX = 2 | NN = 11 | DT = 0.01", "d/dt x = -delay(x, 1)\ndispt x", "x",
        -0.5, 1.0,
    ),
    Moment(
        "x = x + 1 behind SAMPLE 2: x(4)", "TMAX = 4 | NN = 5 | DT = 0.01",
        "d/dt x = -x\ndispt x\nSAMPLE 2\nx = x + 1", "x", (exp(-2) + 1)*exp(-1), 1.14,
    ),
    Moment(
        "threshold by a state: time above 0.25 of exp(-t)", "x = 1 | TMAX = 5 | NN = 2 | DT = 0.01",
        "d/dt x = -x\nd/dt q = swtch(x - 0.25)\ndispt q", "q", log(4), log(4),
    ),
)  # fmt: skip


def error(moment: Moment, rule: int) -> tuple[float, int]:
    """Return the error at the end in units of ERMAX times the largest magnitude (4, 7, 8: + 1), and the steps."""
    session = Session(Listener())
    session.erun(Source(moment.program(rule), "moment"))
    record, found = session.runs[-1], session.values.find(moment.name)
    assert found is not None
    scale = moment.largest + (1.0 if rule in rules_of("variable") else 0.0)
    return abs(session.values.cells[found.slot] - moment.end) / scale / ERMAX, record.steps
