"""The table of analyses: desktop commands, `desire NAME …`, Python functions and help are made from it."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    from desire_tui.analysis.progress import Progress
    from desire_tui.analysis.result import Result
    from desire_tui.analysis.subject import Subject


@dataclass(frozen=True)
class Analysis:
    """An analysis: its word, what it does, how a request is written, the module whose `analyse` does it."""

    name: str
    title: str
    summary: str
    form: str
    """How a request is written; empty if there is none."""
    example: str
    """A request that works for the program in its help page."""
    module: str
    """Where its function is: `module`, whose function is `analyse`, or `module:function`."""
    may_be_empty: bool = False
    """Whether it can be asked for by its word alone."""

    def run(self, subject: Subject, request: str, progress: Progress) -> Result:
        """Do it. DesireError: what is wrong with the request or the program, or why nothing is found."""
        module, _, function = self.module.partition(":")
        found: Result = getattr(import_module(module), function or "analyse")(subject, request, progress)
        return found


_OVER = "QUANTITY over NAME [= START] [in [LOW, HIGH]] [log], … [by local|global|cma] [runs N]"
ANALYSES = (
    Analysis(
        "fit", "Fit to data", "Parameters and initial values that make curves agree with measurements",
        "NAME [= START] [in [LOW, HIGH]] [log], … to QUANTITY [~ COLUMN] [weights SIGMA], … [from 'FILE']",
        "k, x in [0, 10] to y ~ position from 'measured.csv'", "desire_tui.analysis.fit.analysis",
    ),
    Analysis(
        "measured", "Measured points", "Measured points over the curves of a run, and how far they are off",
        "QUANTITY [~ COLUMN], … from 'FILE'", "y ~ position from 'measured.csv'",
        "desire_tui.analysis.fit.comparison",
    ),
    Analysis(
        "sensitivity", "Sensitivity", "What changes with what: exact derivatives along runs, or whole ranges",
        "NAME, … of NAME, … [normalised], or global NAME in [LOW, HIGH], … of QUANTITY, … [morris] [runs N]",
        "k of x", "desire_tui.analysis.sensitivity.question",
    ),
    Analysis(
        "minimise", "Minimise", "Values at which a quantity that runs leave is least", _OVER,
        "max(x) over k in [0, 5]", "desire_tui.analysis.optimise.search:minimise",
    ),
    Analysis(
        "maximise", "Maximise", "Values at which a quantity that runs leave is greatest", _OVER,
        "max(x) over k in [0, 5]", "desire_tui.analysis.optimise.search:maximise",
    ),
    Analysis(
        "linearise", "Linearise", "The linear system near a place: poles, margins, Bode, Nyquist, steps",
        "[INPUT, … -> OUTPUT, …] [at start|end|steady|t = T] [from here] [along PLACES]", "u -> y at steady",
        "desire_tui.analysis.linear.linearise", may_be_empty=True,
    ),
    Analysis(
        "section", "Section", "Passages of orbits through a plane (Poincaré), located, and the return map",
        "STATE = LEVEL [up|down|both] | every PERIOD, then [of STATE, …] [from TIME] [points N]",
        "x = 0 up of y", "desire_tui.analysis.signals.section",
    ),
    Analysis(
        "lyapunov", "Lyapunov exponents", "How fast neighbouring orbits part, by the variational equations",
        "[for TIME] [every TIME] [from TIME]", "for 1000", "desire_tui.analysis.signals.lyapunov",
        may_be_empty=True,
    ),
    Analysis(
        "histogram", "Distribution", "How the values of samples are distributed",
        "NAME, … [bins N] [from TIME]", "x", "desire_tui.analysis.signals.distribution:histogram",
    ),
    Analysis(
        "average", "Average", "Means of samples with the confidence that their correlation allows",
        "NAME, … [from TIME]", "x", "desire_tui.analysis.signals.distribution:average",
    ),
    Analysis(
        "spectrum", "Spectrum", "Power spectrum of samples (Welch), with its peaks",
        "NAME, … [window SAMPLES] [from TIME]", "x", "desire_tui.analysis.signals.spectrum",
    ),
    Analysis(
        "steady", "Steady states", "Where all states stand still: eigenvalues, kind, stability",
        "[from here | all in STATE = [FROM, TO], …] [over NAME in [FROM, TO] [places N]]",
        "all in x = [-2, 2]", "desire_tui.analysis.steady.steady", may_be_empty=True,
    ),
    Analysis(
        "continue", "Continuation", "Steady states and cycles over a parameter; folds, Hopf, branch points",
        "NAME in [FROM, TO][, NAME in [FROM, TO]] [from here|STATE = VALUE …|cycle|fold N] [without cycles]",
        "k in [0, 2]", "desire_tui.analysis.continuation.continuation",
    ),
    Analysis(
        "phase", "Phase plane", "Field, nullclines, steady states, manifolds and basins in a plane",
        "[STATE, STATE] [in STATE = [FROM, TO], …] [from STATE = VALUE, …] [without basins]",
        "x, y in x = [-2, 2], y = [-2, 2]", "desire_tui.analysis.phase_plane.phase", may_be_empty=True,
    ),
)  # fmt: skip
BY_NAME = {analysis.name: analysis for analysis in ANALYSES}
