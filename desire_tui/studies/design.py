"""Which runs a study makes: a grid of values, and at each of its points drawn or listed values.

Runs are numbered from 0, the last axis first. Any stretch of them can be made alone, so no machine needs to
hold a design of 10⁹ runs: what is drawn for run k depends on the seed and k only (Latin hypercubes apart,
which are made as a whole).
"""

from __future__ import annotations

from functools import cached_property
from math import prod
from typing import TYPE_CHECKING, Literal, NamedTuple, get_args

import numpy as np

from desire_tui.engine.diagnostics import DesireError, Diagnostic

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from desire_tui.studies.distributions import Distribution

    Floats = NDArray[np.float64]

Method = Literal["random", "latin", "sobol"]
METHODS: tuple[Method, ...] = get_args(Method)
RUN = "run"
"""The dimension over which values are drawn or listed."""
_SOBOL_BITS = 32  # scipy cannot skip in longer sequences
_DOUBLE_BITS = 53
_PHILOX_WORDS = 4


class Axis(NamedTuple):
    """A dimension of the result: a quantity over its values, or (no values) the runs drawn or listed."""

    name: str
    values: Floats | None
    size: int


class Design:
    """All runs. `axes` are the dimensions of what is kept, `names` what varies, in the columns' order."""

    def __init__(
        self,
        over: Mapping[str, Floats],
        sample: Mapping[str, Distribution] | None = None,
        points: Mapping[str, Floats] | None = None,
        runs: int | None = None,
        method: Method = "random",
        seed: int = 0,
    ) -> None:
        """DesireError 511: there is nothing to run; 510: a name is given twice."""
        self._over, self._sample, self._points = dict(over), dict(sample or {}), dict(points or {})
        self.method, self.seed = method, seed
        for name, values in self._over.items():
            if not len(values):
                raise _empty(f"'{name}' has no values", "give at least one")
        names = [*self._over, *self._points, *self._sample]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise DesireError(Diagnostic("study-twice", None, {"name": twice}))
        self.names = tuple(names)
        """What varies."""
        self.draws = self._count(runs)
        """Runs at each point of the grid."""
        if method == "sobol" and self.draws > 1 << _SOBOL_BITS:
            raise _empty(
                f"a Sobol sequence has {1 << _SOBOL_BITS} points, not {self.draws}", "draw at random"
            )
        self.axes = tuple(Axis(name, values, len(values)) for name, values in self._over.items())
        if self._sample or self._points or runs is not None or not self.axes:
            self.axes += (Axis(RUN, None, self.draws),)
        self.shape = tuple(axis.size for axis in self.axes)
        self.runs = prod(self.shape)

    def _count(self, runs: int | None) -> int:
        listed = {len(values) for values in self._points.values()}
        if len(listed) > 1:
            raise _empty(
                f"its lists have {' and '.join(map(str, sorted(listed)))} values", "make them equally long"
            )
        if runs is not None and runs < 1:
            raise _empty(f"runs is {runs}", "1 or more")
        if listed:
            length = listed.pop()
            if not length:
                raise _empty("its list is empty", "give at least one point")
            if runs is not None and runs != length:
                raise _empty(f"{runs} runs are wanted of a list of {length}", "leave the number of runs away")
            return length
        if self._sample and runs is None:
            raise _empty("values are drawn, but nobody says how often", "--runs 1000 (runs=1000)")
        return 1 if runs is None else runs

    def rows(self, first: int, count: int) -> Floats:
        """Return the values of runs `first … first + count - 1`: (runs, names)."""
        numbers = np.arange(first, first + count)
        made = np.empty((count, len(self.names)))
        places = np.unravel_index(numbers, self.shape)
        for column, (values, place) in enumerate(zip(self._over.values(), places, strict=False)):
            made[:, column] = values[place]
        column = len(self._over)
        drawn = numbers % self.draws
        for values in self._points.values():
            made[:, column] = values[drawn]
            column += 1
        if self._sample:
            uniform = self._uniform(drawn)
            for k, distribution in enumerate(self._sample.values()):
                made[:, column + k] = distribution.numbers(uniform[:, k])
        return made

    @property
    def drawn_names(self) -> tuple[str, ...]:
        """What varies along the dimension `run`."""
        return self.names[len(self._over) :]

    def drawn(self, first: int = 0, count: int | None = None) -> dict[str, Floats]:
        """Return values along the dimension `run`, by names; `count` None: all."""
        if not self.drawn_names:
            return {}
        rows = self.rows(first, self.draws - first if count is None else count)
        return {name: rows[:, len(self._over) + k] for k, name in enumerate(self.drawn_names)}

    def description(self) -> dict[str, object]:
        """Return what makes it the same study again, in plain numbers and texts."""
        told: dict[str, object] = {
            f"list of {name}": values.tolist() for name, values in {**self._over, **self._points}.items()
        }
        told |= {f"distribution of {name}": repr(drawn) for name, drawn in self._sample.items()}
        return {**told, "number of runs": self.runs, "design": self.method, "seed": self.seed}

    # ------------------------------------------------------------------ numbers uniform in (0, 1)

    def _uniform(self, numbers: NDArray[np.int64]) -> Floats:
        """Return (numbers, distributions); neighbouring numbers are made in one go."""
        if self.method == "latin":
            return self._hypercube[numbers]
        make = self._random if self.method == "random" else self._sobol
        breaks = np.flatnonzero(np.diff(numbers) != 1) + 1
        stretches = np.split(numbers, breaks)
        return np.concatenate([make(int(part[0]), len(part)) for part in stretches])

    def _random(self, first: int, count: int) -> Floats:
        width = len(self._sample)
        blocks = -(-width // _PHILOX_WORDS)  # each run begins at a block of its own
        raw = np.random.Philox(key=self.seed, counter=first * blocks).random_raw(
            count * blocks * _PHILOX_WORDS
        )
        words = raw.reshape(count, blocks * _PHILOX_WORDS)[:, :width]
        whole = (words >> np.uint64(64 - _DOUBLE_BITS)).astype(np.float64)
        return (whole + 0.5) * 2.0**-_DOUBLE_BITS

    def _sobol(self, first: int, count: int) -> Floats:
        import warnings

        from scipy.stats import qmc

        sequence = qmc.Sobol(len(self._sample), scramble=True, bits=_SOBOL_BITS, rng=self.seed)
        if first:
            sequence.fast_forward(first)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # that a power of 2 is balanced best: docs say it
            return _open(np.asarray(sequence.random(count)))

    @cached_property
    def _hypercube(self) -> Floats:
        from scipy.stats import qmc

        return _open(np.asarray(qmc.LatinHypercube(len(self._sample), rng=self.seed).random(self.draws)))


def _open(uniform: Floats) -> Floats:
    """Keep 0 out, where distributions have their infinite ends."""
    return np.clip(uniform, 2.0**-_DOUBLE_BITS, 1.0 - 2.0**-_DOUBLE_BITS)


def _empty(what: str, remedy: str) -> DesireError:
    return DesireError(Diagnostic("study-empty", None, {"what": what, "remedy": remedy}))
