"""A model while it is built from an `.ode` file's declarations: names, formulas, problems.

XPPAUT knows a file's names before it looks at the formulas, and so do we: first every name with its spelling,
then what stands behind the names.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.expressions import ZERO, Call, Expression, Name, Number, with_parts
from desire_tui.convert.xppaut.constants import constant
from desire_tui.convert.xppaut.declarations import pairs
from desire_tui.convert.xppaut.expression_parser import parsed
from desire_tui.convert.xppaut.options import Options
from desire_tui.convert.xppaut.sums import Places, written_out
from desire_tui.convert.xppaut.vocabulary import BUILT_IN, FUNCTIONS, LINEAR, NotConvertibleError

if TYPE_CHECKING:
    from desire_tui.convert.model import Model
    from desire_tui.convert.xppaut.declarations import Declaration
    from desire_tui.convert.xppaut.logical_lines import Line


class Building:
    """The model so far, the declarations, and what they say about names."""

    def __init__(self, model: Model, declarations: list[Declaration]) -> None:
        self.model = model
        self.declarations = declarations
        self.spelling: dict[str, str] = {}
        """Names in lower case as they are spelled where they are declared."""
        self.roles: dict[str, str] = {}
        """What they are: quantity, function, table."""
        self.arguments = {one.name.lower(): len(one.dummies) for one in self.of("function")}
        """How many each function takes."""
        self.histories: dict[str, Expression] = {}
        """What states were before the start, for delays: where `x(0)=` says it."""
        self.starts: dict[str, tuple[Expression, Line]] = {}
        """Initial values that nothing has taken yet, by names in lower case."""
        self.used: list[Declaration] = []
        """Lines that belong to others: the rows of a Markov chain's rates."""
        self.options = Options()
        self.places = Places(([], [], []), {})
        self._declare()

    @property
    def states(self) -> set[str]:
        """The names of what has a differential or difference equation, in lower case."""
        return set(self.places.kinds[0])

    def of(self, *kinds: str) -> list[Declaration]:
        """Return the declarations of some kinds, in their order."""
        return [one for one in self.declarations if one.kind in kinds]

    def _declare(self) -> None:
        states = [one.name for one in self.of("rate", "next")]
        states += [name for one in self.of("solve") for name, _ in (pairs(one.right) or ())[:1]]
        parameters: list[str] = []
        constants: dict[str, float] = {}
        for one in self.of("param", "number"):
            for name, value in pairs(one.right) or ():
                parameters.append(name)
                try:
                    constants[name.lower()] = constant(parsed(value or "0"), constants)
                except NotConvertibleError:
                    continue  # told when its value is read
        noises = [name for one in self.of("wiener") for name, _ in pairs(one.right) or ()]
        chains = [one.right.split()[0] for one in self.of("markov")]
        fixed = [one.name for one in self.of("fixed")]
        for group, role in (
            ([*states, *chains, *parameters, *fixed, *noises], "quantity"),
            ([one.name for one in self.of("derived")], "quantity"),
            ([one.name for one in self.of("function")], "function"),
            ([word for one in self.of("table") for word in one.right.split()[:1]], "table"),
            ([found[1] for one in self.of("special") if (found := LINEAR.match(one.right))], "network"),
        ):
            for name in group:
                self.spelling.setdefault(name.lower(), name)
                self.roles.setdefault(name.lower(), role)
        for one in self.of("rate", "next", "fixed", "function", "derived"):
            if one.name.lower() in BUILT_IN:
                self.refuse(one.line, f"'{one.name}' is a word of XPPAUT's")
            elif (self.roles[one.name.lower()] == "function") != (one.kind == "function"):
                self.refuse(one.line, f"'{one.name}' is a {self.roles[one.name.lower()]} already")
        kinds = [[name.lower() for name in group] for group in (states + chains, fixed, parameters)]
        self.places = Places(kinds, constants)

    # -------------------------------------------------------------------------------------------- problems

    def refuse(self, line: Line, reason: str) -> None:
        """Say that a line could not be taken over."""
        self.model.problems.append(line.problem("convert-part", what=line.text, reason=reason))

    def note(self, line: Line, what: str, reason: str) -> None:
        """Say that something was done in another way, or left out without harm."""
        self.model.problems.append(line.problem("convert-note", what=what, reason=reason))

    # -------------------------------------------------------------------------------------------- formulas

    def formula(self, text: str, line: Line, dummies: tuple[str, ...] = ()) -> Expression:
        """Return a formula of the file, names spelled as where they are declared.

        Where it cannot be read it is 0, and there is a problem; what nobody declared is one too.
        """
        notes: list[str] = []
        try:
            found = written_out(parsed(text, notes=notes), self.places)
        except NotConvertibleError as reason:
            self.refuse(line, str(reason))
            return ZERO
        for note in dict.fromkeys(notes):
            self.note(line, text, note)
        return self._known(found, line, dummies)

    def _known(self, expression: Expression, line: Line, dummies: tuple[str, ...]) -> Expression:
        match expression:
            case Name(name) if name in dummies or name in {"t", "<PI>"}:
                return expression
            case Name(name):
                if name not in self.spelling:
                    self.refuse(line, f"'{name}' is declared nowhere")
                elif self.roles[name] != "quantity":
                    self.refuse(line, f"'{name}' is a {self.roles[name]} and needs an argument")
                return Name(self.spelling.get(name, name))
            case Call("delay", arguments):
                return self._delay(arguments, line, dummies)
            case Call(function, arguments):
                inner = tuple(self._known(argument, line, dummies) for argument in arguments)
                role = self.roles.get(function)
                if role == "network":
                    return self._element(function, inner, line)
                if role == "table":
                    return Call("func1", (inner[0], Name(self.spelling[function])))
                if role != "function" and function not in FUNCTIONS:
                    self.refuse(line, f"there is no function '{function}'")
                elif role == "function" and len(inner) != self.arguments[function]:
                    self.refuse(line, f"'{function}' takes {self.arguments[function]} argument(s)")
                return Call(self.spelling.get(function, function), inner)
            case _:
                return with_parts(expression, lambda part: self._known(part, line, dummies))

    def _element(self, network: str, place: tuple[Expression, ...], line: Line) -> Expression:
        """Return an element of a network's sums; XPPAUT counts from 0, Desire from 1."""
        try:
            index = constant(place[0], self.places.constants)
        except NotConvertibleError:
            self.refuse(line, f"which element of '{network}' is meant must be a constant")
            return ZERO
        return Call("[]", (Name(self.spelling[network]), Number(float(int(index) + 1))))

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
