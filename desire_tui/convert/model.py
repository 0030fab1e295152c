"""A model between two languages: what every reader makes and `program_text` writes as a Desire program.

Names are those of the file, spelled as where it declares them; what Desire cannot call so is renamed by the
writer (`names`). Every part knows the comment that stood above it in the file.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import ZERO, Expression
from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic


@dataclass
class Quantity:
    """A name with an expression: a parameter, a defined variable, an assignment of an event."""

    name: str
    value: Expression
    comment: str = ""
    """What stood above it in the file, without comment signs; lines separated by line feeds."""


@dataclass
class Network(Quantity):
    """An array of sums, each of the same quantities with weights of its own; `value` is their plain sum.

    `kind`: even, periodic, zero (a convolution that goes on so beyond the ends), sparse, mmult. `reach`: how
    far a convolution reaches to either side, else how many weights a row has. `tables`: the weights, and for
    `sparse` the places.
    """

    kind: str = "zero"
    rows: int = 1
    reach: int = 0
    sources: tuple[str, ...] = ()
    tables: tuple[str, ...] = ()


@dataclass
class Root:
    """The start of a state, where an expression is 0: found from its initial value by Newton's method."""

    name: str
    residual: Expression
    slope: Expression
    """Derivative of the residual."""


@dataclass
class State:
    """What a differential equation (or, in a map, a difference equation) computes."""

    name: str
    rate: Expression
    """Its derivative; in a map its next value."""
    initial: Expression = ZERO
    comment: str = ""


@dataclass
class Function:
    """A function of the model's own; its body may read other quantities."""

    name: str
    dummies: tuple[str, ...]
    body: Expression
    comment: str = ""


@dataclass
class Table:
    """A function by points between which it runs straight, as it does beyond the outer ones.

    `xs` rise. `formula`, an expression of `variable`, gives the values anew at each start instead of `ys`.
    """

    name: str
    xs: list[float]
    ys: list[float] = field(default_factory=list)
    formula: Expression | None = None
    variable: str = "t"
    comment: str = ""


@dataclass
class Event:
    """Assignments, in their order, at the moments at which an expression becomes positive."""

    condition: Expression | None
    """None: at the start alone."""
    assignments: list[Quantity]
    comment: str = ""
    at_start: Expression | None = None
    """Where this holds when the run begins, the assignments are made then, too."""
    ends_run: bool = False


@dataclass
class MarkovProcess:
    """A state 0, 1 … that changes at random: `rates[i][k]` is the rate from i to k."""

    name: str
    rates: list[list[Expression]]
    initial: Expression = ZERO
    comment: str = ""


@dataclass
class Settings:
    """How the model is run and drawn. `rule` is Desire's integration rule, 0 a map."""

    rule: int = 3
    start: float = 0.0
    duration: float = 10.0
    step: float | None = None
    """DT; None: what Desire takes."""
    samples: int = 1001
    tolerance: float | None = None
    """What the rule's error test gets."""
    transient: float = 0.0
    """How long the run goes on before anything is shown."""
    seed: int | None = None
    bound: float | None = None
    """The run ends where a state's absolute value exceeds it."""
    scale: float | None = None
    abscissa: str | None = None
    """What is drawn along the horizontal axis; None: the time."""
    ordinates: tuple[str, ...] = ()
    """What is drawn against it; empty: all states and shown quantities."""


@dataclass
class Preset:
    """A named set of values for parameters and settings, to be called from the script."""

    name: str
    values: list[Quantity]
    comment: str = ""


@dataclass
class Model:
    """A whole model. Parameters and variables stand in an order in which they can be computed."""

    title: str
    origin: str
    """The file's name and kind, for the program's first line."""
    comment: str = ""
    parameters: list[Quantity] = field(default_factory=list)
    functions: list[Function] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)
    states: list[State] = field(default_factory=list)
    variables: list[Quantity] = field(default_factory=list)
    shown: list[Quantity] = field(default_factory=list)
    """What is only computed to be looked at."""
    noises: list[Quantity] = field(default_factory=list)
    """White noise of the spectral density value²."""
    markov: list[MarkovProcess] = field(default_factory=list)
    roots: list[Root] = field(default_factory=list)
    held: list[Quantity] = field(default_factory=list)
    """What the script sets and only events change."""
    events: list[Event] = field(default_factory=list)
    presets: list[Preset] = field(default_factory=list)
    settings: Settings = field(default_factory=Settings)
    problems: list[Diagnostic] = field(default_factory=list)
    """What could not be taken over (errors), and what was done in another way (warnings)."""
