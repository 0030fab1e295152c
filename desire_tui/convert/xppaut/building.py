"""From an `.ode` file's declarations to a model.

XPPAUT knows a file's names before it looks at the formulas, and so do we: first every name with its spelling,
then what stands behind the names.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from desire_tui.convert.expressions import (
    ZERO,
    Call,
    Expression,
    Name,
    functions_in,
    names_in,
    number,
    with_parts,
)
from desire_tui.convert.model import Function, Preset, Quantity, State
from desire_tui.convert.ordering import Circular, in_order, needed_by
from desire_tui.convert.xppaut.chance import processes
from desire_tui.convert.xppaut.declarations import Declaration, braced, pairs
from desire_tui.convert.xppaut.expression_parser import BUILT_IN, NotConvertible, constant, parsed
from desire_tui.convert.xppaut.flags import events
from desire_tui.convert.xppaut.options import Options, preset_setting
from desire_tui.convert.xppaut.sums import Places, written_out
from desire_tui.convert.xppaut.tables import table

if TYPE_CHECKING:
    from desire_tui.convert.model import Model
    from desire_tui.convert.xppaut.logical_lines import Line
    from desire_tui.engine.diagnostics import Diagnostic

_REFUSED = {
    "volterra": "Volterra integral equations are not solved here",
    "volt": "Volterra integral equations are not solved here",
    "algebraic": "algebraic equations are not solved here; a variable that can be computed from others is one line",
    "solve": "algebraic equations are not solved here",
    "special": "sums over arrays by network functions have no counterpart here",
    "export": "functions of a library are not called here",
    "options": "options in a file of their own are not read; copy them into the file behind @",
    "unknown": "it is no declaration of XPPAUT's",
    "matrix row": "no markov line stands above it",
}


class Building:
    """A model while it is built from declarations."""

    def __init__(self, model: Model, declarations: list[Declaration]) -> None:
        self.model = model
        self.declarations = declarations
        self.spelling: dict[str, str] = {}
        """Names in lower case as they are spelled where they are declared."""
        self.places = Places(([], [], []), {})
        self.functions: dict[str, Function] = {}
        self.histories: dict[str, Expression] = {}
        """What states were before the start, for delays: where `x(0)=` says it."""
        self.starts: dict[str, tuple[Expression, Line]] = {}
        self.table_names: set[str] = set()
        self.rates_read: list[Declaration] = []
        """Rows of rates that belong to a Markov chain."""
        self.options = Options()

    def build(self) -> None:
        """Build it."""
        self._header()
        self._names()
        self._options()
        self._parameters()
        self._starts()
        self._functions()
        self._tables()
        self._chance()
        self._equations()
        self._variables()
        self._shown()
        self._events()
        self._presets()
        self._settings()
        for one in self.declarations:
            if one.kind in _REFUSED and one not in self.rates_read:
                self.refuse(one.line, _REFUSED[one.kind])
        self.model.problems.sort(key=_place)

    # -------------------------------------------------------------------------------------------- problems

    def refuse(self, line: Line, reason: str, what: str | None = None) -> None:
        """Say that a part of the model could not be taken over."""
        self.model.problems.append(
            line.problem("convert-part", what=_short(what or line.text), reason=reason)
        )

    def note(self, line: Line, what: str, reason: str) -> None:
        """Say that something was done in another way, or left out without harm."""
        self.model.problems.append(line.problem("convert-note", what=_short(what), reason=reason))

    def expression(self, text: str, line: Line) -> Expression:
        """Return a formula of the file with names as they are spelled, or 0 where it cannot be read: a problem."""
        notes: list[str] = []
        try:
            found = written_out(parsed(text, notes=notes), self.places)
        except NotConvertible as reason:
            self.refuse(line, str(reason))
            return ZERO
        for note in dict.fromkeys(notes):
            self.note(line, line.text, note)
        return self._known(found, line)

    def _known(self, expression: Expression, line: Line, dummies: tuple[str, ...] = ()) -> Expression:
        """Return it with names as they are spelled; what nobody declared is a problem."""
        match expression:
            case Name(name) if name in dummies or name in {"t", "PI"}:
                return expression
            case Name(name):
                if name not in self.spelling:
                    self.refuse(line, f"'{name}' is declared nowhere")
                return Name(self.spelling.get(name, name))
            case Call("delay", arguments):
                return self._delay(arguments, line, dummies)
            case Call(function, arguments):
                inner = tuple(self._known(argument, line, dummies) for argument in arguments)
                if function in self.table_names and len(inner) == 1:
                    return Call("func1", (inner[0], Name(self.spelling[function])))
                if function in self.spelling:
                    return Call(self.spelling[function], inner)
                if function not in _LIBRARY:
                    self.refuse(line, f"there is no function '{function}'")
                return Call(function, inner)
            case _:
                return with_parts(expression, lambda part: self._known(part, line, dummies))

    def _delay(self, arguments: tuple[Expression, ...], line: Line, dummies: tuple[str, ...]) -> Expression:
        """Return a delayed state: before the start it is what `x(0)=` says, else 0, not its initial value."""
        if self.options.is_map:
            self.refuse(line, "delays in maps have no counterpart here")
        if len(arguments) != 2:
            self.refuse(line, "'delay' takes a variable and a time")
            return ZERO
        what, tau = (self._known(argument, line, dummies) for argument in arguments)
        before = self.histories.get(what.name.lower(), ZERO) if isinstance(what, Name) else ZERO
        return Call("delay", (what, tau, before))

    # ---------------------------------------------------------------------------------------------- names

    def _header(self) -> None:
        """Make the comment at the top of the file the program's own: up to the last blank line in it."""
        if self.declarations:
            one = self.declarations[0]
            above, blank, below = one.line.comment.rpartition("\n\n")
            self.model.comment = above if blank else below
            line = replace(one.line, comment=below if blank else "")
            self.declarations[0] = replace(one, line=line)

    def _of(self, *kinds: str) -> list[Declaration]:
        return [one for one in self.declarations if one.kind in kinds]

    def _names(self) -> None:
        states = [one.name for one in self._of("rate", "next")]
        parameters: list[str] = []
        constants: dict[str, float] = {}
        for one in self._of("param", "number"):
            for name, value in pairs(one.right) or ():
                parameters.append(name)
                try:
                    constants[name.lower()] = constant(parsed(value or "0"), constants)
                except NotConvertible:
                    continue  # told when its value is read
        noises = [name for one in self._of("wiener") for name, _ in pairs(one.right) or ()]
        chains = [one.right.split()[0] for one in self._of("markov")]
        fixed = [one.name for one in self._of("fixed")]
        other = [one.name for one in self._of("derived", "function")]
        tables = [word for one in self._of("table") for word in one.right.split()[:1]]
        for name in [*states, *chains, *parameters, *fixed, *noises, *other, *tables]:
            self.spelling.setdefault(name.lower(), name)
        self.table_names.update(name.lower() for name in tables)
        for one in self._of("rate", "next", "fixed", "function", "derived"):
            if one.name.lower() in BUILT_IN:
                self.refuse(one.line, f"'{one.name}' is a word of XPPAUT's")
        kinds = [[name.lower() for name in group] for group in (states + chains, fixed, parameters)]
        self.places = Places(kinds, constants)

    # --------------------------------------------------------------------------------------------- options

    def _options(self) -> None:
        for one in self._of("option"):
            idle: list[str] = []
            for name, value in pairs(one.right.replace("{", " ").replace("}", " ")) or [(one.right, "")]:
                reason = self.options.read(name, value)
                if reason == "it has no meaning here":
                    idle.append(name)
                elif reason is not None:
                    self.note(one.line, f"{name}={value}", reason)
            if idle:
                self.note(one.line, ", ".join(idle), "no meaning here")

    # -------------------------------------------------------------------------------------------- the parts

    def _parameters(self) -> None:
        for one in self._of("param", "number"):
            values = pairs(one.right)
            if values is None:
                self.refuse(one.line, "it is no list of name=value")
                continue
            for count, (name, value) in enumerate(values):
                expression = self.expression(value or "0", one.line)
                comment = one.line.comment if count == 0 else ""
                self.model.parameters.append(Quantity(self.spelling[name.lower()], expression, comment))
        for one in self._of("derived"):
            expression = self.expression(one.right, one.line)
            self.model.parameters.append(
                Quantity(self.spelling[one.name.lower()], expression, one.line.comment)
            )

    def _functions(self) -> None:
        for one in self._of("function"):
            dummies = one.dummies
            try:
                notes: list[str] = []
                body = written_out(parsed(one.right, notes=notes), self.places)
            except NotConvertible as reason:
                self.refuse(one.line, str(reason))
                continue
            for note in dict.fromkeys(notes):
                self.note(one.line, one.line.text, note)
            name = self.spelling[one.name.lower()]
            known = self._known(body, one.line, dummies)
            self.model.functions.append(Function(name, dummies, known, one.line.comment))
        self.functions = {function.name: function for function in self.model.functions}

    def _tables(self) -> None:
        for one in self._of("table"):
            try:
                made = table(one, self)
            except NotConvertible as reason:
                self.refuse(one.line, str(reason))
            else:
                self.model.tables.append(made)

    def _starts(self) -> None:
        """Read initial values; a formula of t behind `x(0)=` is the history of delays."""
        for one in self.declarations:
            if one.kind == "initial":
                expression = self.expression(one.right, one.line)
                self.histories[one.name.lower()] = expression
                self.starts[one.name.lower()] = (_at_zero(expression, self.options), one.line)
            elif one.kind == "init":
                values = pairs(one.right)
                if values is None:
                    self.refuse(one.line, "it is no list of name=value")
                for name, value in values or ():
                    self.starts[name.lower()] = (self.expression(value or "0", one.line), one.line)

    def _chance(self) -> None:
        for one in self._of("wiener"):
            names = pairs(one.right)
            for count, (name, _) in enumerate(names or ()):
                comment = one.line.comment if count == 0 else ""
                self.model.noises.append(Quantity(self.spelling[name.lower()], number(1.0), comment))
            if names is None:
                self.refuse(one.line, "it is no list of names")
        self.model.markov.extend(processes(self))

    def _equations(self) -> None:
        seen: set[str] = set()
        for one in self._of("rate", "next"):
            name = one.name.lower()
            if name in seen:
                self.refuse(one.line, f"'{one.name}' has an equation already")
                continue
            seen.add(name)
            start, _ = self.starts.pop(name, (ZERO, one.line))
            rate = self.expression(one.right, one.line)
            self.model.states.append(State(self.spelling[name], rate, start, one.line.comment))
        for process in self.model.markov:
            process.initial = self.starts.pop(process.name.lower(), (ZERO, None))[0]
        for name, (start, line) in self.starts.items():
            if name in {one.lower() for one in self.spelling}:
                self.model.held.append(Quantity(self.spelling[name], start))
            else:
                self.note(line, name, "there is no such variable: its initial value is left out")

    def _variables(self) -> None:
        """Read fixed quantities; those that stand below the use of their values are moved up."""
        found: dict[str, Quantity] = {}
        lines: dict[str, Line] = {}
        for one in self._of("fixed"):
            name = self.spelling[one.name.lower()]
            if name in found or one.name.lower() in self.states:
                self.refuse(one.line, f"'{one.name}' has a formula already")
                continue
            found[name] = Quantity(name, self.expression(one.right, one.line), one.line.comment)
            lines[name] = one.line
        needs = {
            name: needed_by(one.value, self.functions) & found.keys() - {name} for name, one in found.items()
        }
        try:
            order = in_order(needs)
        except Circular as circle:
            self.refuse(lines[circle.names[0]], f"these wait for each other: {circle}")
            order = list(found)
        above: set[str] = set()
        for name in found:
            late = sorted(needs[name] - above)
            if late:
                self.note(lines[name], lines[name].text,
                          f"{', '.join(late)} stands below it; here it is computed above (XPPAUT takes its value of "
                          "the step before)")  # fmt: skip
            above.add(name)
        self.model.variables.extend(found[name] for name in order)

    @property
    def states(self) -> set[str]:
        """The names of what has an equation, in lower case."""
        return set(self.places.kinds[0])

    def _shown(self) -> None:
        taken = {*self.spelling.values()}
        for one in self._of("aux"):
            name, sign, formula = one.right.partition("=")
            name = name.strip()
            if not sign or not name:
                self.refuse(one.line, "it is no name=formula")
                continue
            value = self.expression(formula, one.line)
            if isinstance(value, Name) and value.name.lower() == name.lower():
                continue  # the quantity of that name itself
            while name in taken or name.lower() in self.spelling:
                name = f"{name}_aux"
            taken.add(name)
            self.model.shown.append(Quantity(name, value, one.line.comment))
        only = [
            name.strip().lower() for one in self._of("only") for name in one.right.replace(",", " ").split()
        ]
        self._drawn(only)

    def _drawn(self, only: list[str]) -> None:
        known = {**self.spelling, **{shown.name.lower(): shown.name for shown in self.model.shown}}
        settings = self.model.settings
        x, y = self.options.axes
        if only:
            settings.ordinates = tuple(known[name] for name in only if name in known)
        if x and x != "t" and x in known:
            settings.abscissa = known[x]
            first = [state.name for state in self.model.states if state.name != known[x]]
            settings.ordinates = (known[y],) if y in known else tuple(first[:1]) or (known[x],)
        for one in self._of("bndry"):
            self.note(
                one.line,
                one.line.text,
                "boundary values are not fitted here; the initial-value problem stays",
            )

    def _events(self) -> None:
        self.model.events.extend(events(self))

    def _presets(self) -> None:
        for one in self._of("set"):
            name, _, _ = one.right.partition("{")
            values: list[Quantity] = []
            for inner in braced(one.right):
                for key, text in pairs(inner) or ():
                    found = self._preset_value(key, text, one.line)
                    if found is not None:
                        values.append(found)
            self.spelling.setdefault(f"set {name.strip()}", f"set_{name.strip()}")
            if values:
                self.model.presets.append(Preset(f"set_{name.strip()}", values, one.line.comment))

    def _preset_value(self, key: str, text: str, line: Line) -> Quantity | None:
        if key.lower() in self.spelling:
            return Quantity(self.spelling[key.lower()], self.expression(text or "0", line))
        try:
            setting = preset_setting(key, float(text))
        except ValueError:
            setting = None
        if setting is None:
            self.note(line, f"{key}={text}", "no meaning here")
            return None
        return Quantity(setting[0], number(setting[1]))

    def _settings(self) -> None:
        discrete = self.options.is_map or bool(self._of("next") and not self._of("rate"))
        self.options.settings(
            self.model.settings, discrete=discrete, noisy=bool(self.model.noises or self.model.markov)
        )
        everything = [state.rate for state in self.model.states] + [one.value for one in self.model.variables]
        drawn = any({"ran", "gauss"} & functions_in(one) for one in everything)
        if drawn and self.model.settings.rule not in {0, 1, 2, 3}:
            self.model.settings.rule, self.model.settings.tolerance = 1, None


_LIBRARY = frozenset(
    "sin cos tan asin acos atan sinh cosh tanh exp abs sqrt ceil ln log floor sgn atan2 max min mod ran gauss".split()
)


def _at_zero(expression: Expression, options: Options) -> Expression:
    """Return a history's value at the start: t stands for the start there."""
    from desire_tui.convert.expressions import substituted

    return (
        substituted(expression, {"t": number(options.start)}) if "t" in names_in(expression) else expression
    )


def _place(problem: Diagnostic) -> tuple[int, int]:
    return (problem.line or 0, problem.column or 0)


def _short(text: str) -> str:
    flat = " ".join(text.split())
    return flat if len(flat) <= 60 else f"{flat[:57]}…"
