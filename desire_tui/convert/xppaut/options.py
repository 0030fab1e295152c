"""XPPAUT's `@` options: those with a meaning here as settings, the others as a list.

A method gets the rule of the same kind: fixed steps the same formula where Desire has it, methods that test
their steps rule 4, stiff ones rule 14.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.convert.model import Settings

METHODS = {
    "discrete": 0, "euler": 2, "modeuler": 1, "rungekutta": 3, "adams": 9, "gear": 14, "volterra": 3,
    "backeul": 14, "qualrk": 4, "stiff": 14, "cvode": 14, "5dp": 4, "83dp": 4, "2rb": 14, "ymp": 3,
}  # fmt: skip
"""XPPAUT's methods, told apart by how they begin, with Desire's rules."""
SAME_FORMULA = frozenset({"discrete", "euler", "modeuler", "rungekutta"})
TOLERANCES = {4: 1e-6, 9: 1e-6, 14: 1e-8}
"""What is asked of rules that test their steps where the file asks for less, or nothing.

Rule 14 errs more in the long run than XPPAUT's stiff methods with the same tolerance: it gets a
hundredth of it.
"""
_NUMBERS = frozenset({
    "total", "dt", "t0", "trans", "transient", "njmp", "nout", "bound", "bounds", "seed", "toler", "tol",
    "tolerance",
    "atoler", "atol", "xlo", "xhi", "ylo", "yhi", "dtmin", "dtmax", "delay",
})  # fmt: skip
_WORDS = frozenset({"meth", "method", "xp", "xplot", "yp", "yplot"})


class Options:
    """The options of a file, as they are read: later ones replace earlier ones."""

    def __init__(self) -> None:
        self._numbers: dict[str, float] = {}
        self._words: dict[str, str] = {}

    def read(self, name: str, value: str) -> str | None:
        """Take an option; return what is to be said of it: "" that it has no meaning here, None nothing."""
        key = name.lower()
        if key in _WORDS:
            self._words[key] = value.lower()
            return None if not key.startswith("meth") else self._method_problem(value.lower())
        if key not in _NUMBERS:
            return ""
        try:
            self._numbers[key] = float(value)
        except ValueError:
            return f"'{value}' is not a number"
        return None

    @staticmethod
    def _method_problem(value: str) -> str | None:
        whole = _method(value)
        if whole is None:
            return f"there is no method '{value}'"
        if whole in SAME_FORMULA:
            return None
        return f"XPPAUT's {whole} becomes irule {METHODS[whole]}, another method of its kind"

    def _number(self, *names: str) -> float | None:
        return next((self._numbers[name] for name in names if name in self._numbers), None)

    @property
    def is_map(self) -> bool:
        """Whether the equations give the next values, not derivatives."""
        return self._method() == "discrete"

    @property
    def start(self) -> float:
        """The time at which the run starts."""
        return self._number("t0") or 0.0

    @property
    def axes(self) -> tuple[str, str]:
        """The names along the axes, "" where none is given."""
        return (
            self._words.get("xp") or self._words.get("xplot", ""),
            self._words.get("yp") or self._words.get("yplot", ""),
        )

    def _method(self) -> str:
        given = self._words.get("meth") or self._words.get("method") or "rungekutta"
        return _method(given) or "rungekutta"

    def settings(self, settings: Settings, *, discrete: bool, noisy: bool) -> None:
        """Fill in rule, times and limits. `noisy`: random numbers are drawn at each step."""
        rule = 0 if discrete else METHODS[self._method()]
        if noisy and rule not in {0, 1, 2, 3}:
            rule = 1  # the others test their steps, which noise never passes
        total = self._number("total")
        total = 20.0 if total is None else abs(total)
        step = self._number("dt") or 0.05
        every = max(1, round(self._number("nout", "njmp") or 1))
        settings.rule = rule
        settings.start = self.start
        settings.transient = min(max(self._number("transient", "trans") or 0.0, 0.0), total)
        if rule in {4, 14}:
            every = 1  # XPPAUT looks at nout for fixed steps only
        if rule == 0:
            total, step = float(round(total)), 1.0
            settings.transient = float(round(settings.transient))
            every = 1
        shown = total - settings.transient
        settings.samples = max(2, round(shown / (abs(step) * every)) + 1)
        settings.step = min(abs(step), shown / (settings.samples - 1)) if shown > 0 else abs(step)
        settings.duration = total if step > 0 else -total
        if rule in TOLERANCES:
            asked = self._number("toler", "tol", "tolerance") or 1.0
            settings.tolerance = min(TOLERANCES[rule] / TOLERANCES[4] * asked, TOLERANCES[rule])
        seed = self._number("seed")
        settings.seed = None if seed is None else round(seed)
        settings.bound = self._number("bound", "bounds")
        low, high = self._number("ylo"), self._number("yhi")
        if low is not None or high is not None:
            limits = [abs(one) for one in (low, high) if one is not None]
            if self.axes[0] not in {"", "t"}:
                limits += [abs(x) for x in (self._number("xlo"), self._number("xhi")) if x is not None]
            settings.scale = max(limits) or None


def _method(value: str) -> str | None:
    """Return the method that a word, its beginning or its number in XPPAUT's menu means."""
    if value.isdigit():
        return list(METHODS)[int(value)] if int(value) < len(METHODS) else None
    if value.startswith("rk"):
        return "rungekutta"
    whole = next((one for one in METHODS if one.startswith(value[:4]) or value.startswith(one[:4])), None)
    return whole or next((one for one in METHODS if one[0] == value[:1]), None)


def preset_setting(name: str, value: float) -> tuple[str, float] | None:
    """Return the system variable that an option of a `set` line stands for; None: it has no meaning here."""
    match name.lower():
        case "total":
            return "<TMAX>", value
        case "dt":
            return "<DT>", value
        case "ylo" | "yhi":
            return "<scale>", abs(value)
        case "toler" | "tol":
            return "<ERMAX>", value
        case _:
            return None
