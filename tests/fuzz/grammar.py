"""Programs made by rule: every statement of segments, every function, every integration rule; small and quick to run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.library import LIBRARY

if TYPE_CHECKING:
    from random import Random

_ONE = [
    e.name for e in LIBRARY.values() if "D" in e.where and e.most == 1 and e.kind not in {"random", "time"}
]
_MATRIX = [name for name in _ONE if "M" in LIBRARY[name].where]
_SAFE = (
    "sin",
    "cos",
    "atan",
    "tanh",
    "sat",
    "SAT",
    "sigmoid",
    "SIGMOID",
    "abs",
    "lim",
    "deadz",
    "tri",
    "sinc",
)
RULES = (0, 1, 1, 2, 3, 3, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16)


class ProgramMaker:
    """Writes one program; all chance comes from `rng`."""

    def __init__(self, rng: Random) -> None:
        self._rng = rng
        self._rule = rng.choice(RULES)
        self._n = rng.choice((1, 2, 2, 3, 4, 5, 7, 17))
        self._m = rng.choice((1, 2, 3, 6))
        self._wild = rng.random() < 0.25
        """Arguments outside a function's domain, divisions by what may be 0."""
        self._draws = rng.random() < 0.3 and self._rule < 9
        self._scalars = ["a", "b", "c", "t"]
        self._vectors = ["p", "q"]
        self._states = rng.sample(["x", "y", "z"], rng.randint(0 if self._rule == 0 else 1, 3))
        self._scalars += self._states
        self._has_vector_state = rng.random() < 0.4
        if self._has_vector_state:
            self._vectors.append("s")
        self._count = 0

    def program(self) -> str:
        """Return its text."""
        segments = [self._segment(), *(f"label two\n{self._segment()}" for _ in range(self._flip(0.15)))]
        runs = "drun\n" + ("drun two\n" if len(segments) > 1 else "") + self._after()
        return f"{self._script()}{runs}DYNAMIC\n{''.join(segments)}"

    def _flip(self, chance: float) -> int:
        return int(self._rng.random() < chance)

    def _number(self) -> str:
        rng = self._rng
        if self._wild and rng.random() < 0.08:
            return rng.choice(("0", "-0", "1e308", "1e-310", "-1", "1e16"))
        return rng.choice(
            (f"{rng.uniform(0.1, 3):.3f}", str(rng.randint(0, 4)), f"-{rng.uniform(0.1, 2):.2f}")
        )

    def _script(self) -> str:
        rng, n, m = self._rng, self._n, self._m
        steps = rng.randint(2, 60)
        comint = rng.randint(1, 3)
        lines = [
            f"n = {n} | m = {m} | a = {self._number()} | b = {self._number()} | c = {self._number()}",
            "ARRAY p[n], q[n], r[n], A[n,n], W[m,n], K[m,n], M[m,n], u[m], w[m], F[8], G[2,3], X[2], Y[3]",
            "ARRAY C[n,m], mask[n], H[40], D[30], V[m]",
            *(["STATE s[n]"] if self._has_vector_state else []),
            f"SEED {rng.randint(0, 99)} | irule {self._rule}",
            "for i = 1 to n | p[i] = sin(i) | q[i] = 1/i - 0.3 | mask[i] = i - 2 | for k = 1 to n | A[i,k] = 0.2*cos(i*k) | next | next",
            "for i = 1 to m | u[i] = 0.3*i - 1 | for k = 1 to n | W[i,k] = 0.1*(i - k) | M[i,k] = i - k | next | next",
            "data -2, -0.5, 1, 2 | data 0, 1, -1, 0.5 | read F",
            "data 1, 2, 3, -1, 0, 1 | read G | data 0, 1 | read X | data -1, 0, 1 | read Y",
            f"FUNCTION f(u$) = {self._expression(['u$', 'a'], 2, draws=False)}",
            f"FUNCTION g(u$, v$) = {self._expression(['u$', 'v$'], 2, draws=False)}",
            "SUBMODEL osc(p$, q$)",
            "  d/dt p$ = q$",
            "  d/dt q$ = -p$ + 0.3*sat(q$)",
            "end",
            *(f"{name} = {self._number()}" for name in self._states),
        ]
        if self._has_vector_state:
            lines.append("for i = 1 to n | s[i] = 0.3*i - 0.5 | next")
        if self._rule > 8:
            lines.append(f"ERMAX = {rng.choice(('1e-4', '1e-6'))}")
        if self._rule == 0 and not self._states and not self._has_vector_state:
            lines.append(f"NN = {rng.randint(1, 12)}")
        else:
            dt = rng.choice(("0.01", "0.02", "0.05", "0.1", "0.03125"))
            lines.append(f"DT = {dt} | TMAX = {float(dt) * steps:.5g} | NN = {max(2, steps // comint + 1)}")
        if rng.random() < 0.1:
            lines.append(
                rng.choice(
                    ("t = -0.5", "MM = 2", "CHECKN = 1", "ERMAX = 1e-5", "DTMAX = 0.05", "scale = 2", "t = 3")
                )
            )
        if rng.random() < 0.2:
            lines.append("PROCEDURE swap(x$, y$)\nk$ = x$ | x$ = y$ | y$ = k$\nend\ncall swap(a, b)")
        if rng.random() < 0.2:
            lines.append(
                f"if {self._expression(['a', 'b'], 1)} > {self._number()} then a = 0.5 else b = 0.7 | proceed"
            )
        if rng.random() < 0.15:
            lines.append("MATRIX A = 0.5*A*A + A%\nVector r = A*p + q" if self._rule else "MATRIX A = $Tr(A)")
        return "\n".join(lines) + "\n"

    def _after(self) -> str:
        rng = self._rng
        lines = []
        if rng.random() < 0.25:
            lines.append(
                rng.choice(("drun", "drunr", "reset | drun", "a = 0.4 | drun", "DT = DT/2 | drun", "clear"))
            )
        if rng.random() < 0.15:
            lines.append("ARRAY fa[8], fb[8]\nfor i = 1 to 8 | fa[i] = sin(i) | next\nFFT F, 8, fa, fb")
        if rng.random() < 0.3:
            lines.append(f"e = {self._expression(['a', 'b', 'p[1]'], 3)}\nwrite e, a")
        return "".join(f"{line}\n" for line in lines)

    def _segment(self) -> str:
        rng = self._rng
        self._known = list(self._scalars)
        lines = []
        for _ in range(rng.randint(0, 4)):
            lines += self._statement()
        for name in self._states:
            if self._rule or rng.random() < 0.8:
                lines += self._derivative(name)
        if self._has_vector_state:
            lines.append(
                f"Vectr d/dt s = {self._vector(2)} - 0.4*s"
                if rng.random() < 0.7
                else "Vectr d/dt s = A*s - s"
            )
        if rng.random() < 0.1 and self._rule:
            lines.append("invoke osc(o1, o2)")
            self._known += ["o1", "o2"]
        for _ in range(rng.randint(0, 3)):
            lines += self._statement()
        if rng.random() < 0.3:
            lines += self._moments()
        if rng.random() < 0.25:
            lines += ["step", *(line for _ in range(rng.randint(1, 2)) for line in self._statement())]
        if rng.random() < 0.25:
            lines += ["OUT", *(line for _ in range(rng.randint(1, 2)) for line in self._statement())]
        elif rng.random() < 0.1:
            lines += [f"SAMPLE {rng.randint(1, 4)}", *self._statement()]
        shown = [name for name in self._known if name != "t"]
        lines.append(f"dispt {', '.join(rng.sample(shown, min(len(shown), 3)))}")
        if rng.random() < 0.1:
            lines += self._moments()
        return "\n".join(lines) + "\n"

    def _moments(self) -> list[str]:
        """Return blocks for what happens at moments, where clocks tick or something passes 0."""
        rng = self._rng
        lines = []
        for _ in range(rng.randint(1, 3)):
            if rng.random() < 0.4:
                period = rng.choice(("0.1", "0.25", "0.04", "0.3333", "abs(a) + 0.05", self._number()))
                start = rng.choice(("", "", ", 0.07", ", -0.1", f", {self._number()}"))
                lines.append(f"every {period}{start}")
            elif self._wild and rng.random() < 0.4:
                lines.append(f"event {self._expression(self._known, 2)}")
            else:  # passes 0 now and then
                name = rng.choice((*self._states, "t"))
                form = rng.choice(("{x} - {y}", "{y} - {x}", "sin({w}*t) - {y}", "sin({w}*{x} + t)"))
                lines.append(
                    f"event {form.format(x=name, y=self._expression(self._known, 1), w=rng.randint(1, 30))}"
                )
            lines += [line for _ in range(rng.randint(1, 3)) for line in self._at_a_moment()]
        return [*lines, "end event"]

    def _at_a_moment(self) -> list[str]:
        """Return statements of a block."""
        rng = self._rng
        form = rng.random()
        if form < 0.45 and self._states:
            name = rng.choice(self._states)
            return [
                f"{name} = {rng.choice((f'-0.8*{name}', f'0.5*{name} + 0.1', f'sat({self._expression(self._known, 1)})'))}"
            ]
        if form < 0.6:
            name = rng.choice("bc")
            return [f"{name} = 0.5*{name} + 0.1*sat({self._expression(self._known, 2)})"]
        if form < 0.7 and self._has_vector_state:
            return [rng.choice(("Vector s = -0.5*s", "s[1] = s[1] - 0.2", "Vector s = sat(p + s)"))]
        made: list[str] = rng.choice(_AT_MOMENTS)(self)
        return made

    def _derivative(self, name: str) -> list[str]:
        rhs = self._expression(self._known, 3)
        if self._draws and self._rng.random() < 0.2:
            rhs += f" + white({self._number()})"
        if not self._wild or self._rng.random() < 0.7:
            rhs = f"{self._rng.choice(('sat', 'tanh', 'sin'))}({rhs}) - 0.5*{name}"
        return [f"d/dt {name} = {rhs}"]

    def _new(self) -> str:
        self._count += 1
        return f"u{self._count}"

    def _statement(self) -> list[str]:
        rng = self._rng
        before = list(self._known)
        made: list[str] = rng.choice(_STATEMENTS)(self)
        if rng.random() < 0.12:
            other = [f"{name} = {self._number()}" for name in self._known[len(before) :]]
            if not other and rng.random() < 0.5:
                other = [f"{rng.choice('bc')} = {self._number()}"]
            guard = self._expression(before, 1, draws=False)
            return [f"if {guard}", *made, *(["else", *other] if other else []), "end if"]
        return made

    def _assigned(self, rhs: str, word: str = "") -> list[str]:
        name = self._new()
        self._known.append(name)
        return [f"{word}{name} = {rhs}"]

    def scalar(self) -> list[str]:
        """x = expression."""
        return self._assigned(self._expression(self._known, 4))

    def persistent(self) -> list[str]:
        """A parameter that changes from pass to pass."""
        name = self._rng.choice("bc")
        return [f"{name} = 0.5*{name} + 0.1*sat({self._expression(self._known, 2)})"]

    def delayed(self) -> list[str]:
        """A delayed value."""
        word = self._rng.choice(("tdelay", "tdelay", "delay"))
        buffer = self._rng.choice(("D", "H"))
        return self._assigned(
            f"{buffer}({self._rng.choice(self._known)}, {self._rng.choice(('0.05', '0.1', 'abs(b)', '0'))})",
            f"{word} ",
        )

    def past(self) -> list[str]:
        """A value of before, kept by the run."""
        rng = self._rng
        time = rng.choice(
            (
                "0.05",
                "0.1",
                "0.21",
                "abs(b)",
                "0.1 + 0.05*sin(t)",
                f"0.1*({self._expression(self._known, 1)})^2",
            )
        )
        before = rng.choice(("", "", ", 0.3", ", cos(t)", ", t"))
        inner = rng.choice(self._known) if rng.random() < 0.7 else self._expression(self._known, 1)
        return self._assigned(f"0.5*delay({inner}, {time}{before})")

    def table(self) -> list[str]:
        """Table functions."""
        x, y = (self._expression(self._known, 1) for _ in range(2))
        return self._assigned(self._rng.choice((f"func1({x}; F)", f"func2({x}, {y}; G, X, Y)")))

    def stored(self) -> list[str]:
        """A history written or read."""
        if self._rng.random() < 0.5:
            return [f"store H = {self._rng.choice(self._known)}"]
        return self._assigned("F", "get ")

    def tracked(self) -> list[str]:
        """Track and hold."""
        return [
            f"trkhld c, {self._rng.choice(self._known)} = {self._expression(self._known, 1)}, {self._number()}"
        ]

    def ended(self) -> list[str]:
        """A run ended early."""
        return [f"term {self._expression(self._known, 1)} - 2"]

    def vector(self) -> list[str]:
        """Whole vectors."""
        rng = self._rng
        target = rng.choice(("p", "q", "r"))
        mask = "[mask] " if rng.random() < 0.1 else ""
        form = rng.random()
        if form < 0.15:
            return [f"Vectr delta {target} = 0.1*({self._vector(2)})"]
        if form < 0.25:
            return [f"Vector {target}^ = {self._vector(1)}"]
        value = f"sat({self._vector(2)})" if rng.random() < 0.6 else self._vector(2)
        while f"{target}{{" in value:
            value = value.replace(f"{target}{{", "q{" if target != "q" else "p{")
        return [f"Vector {target} = {mask}{value}"]

    def product(self) -> list[str]:
        """Matrix times vector."""
        rng = self._rng
        return [
            rng.choice(
                (
                    f"Vector w = {rng.choice(('tanh', 'sat', 'sigmoid'))}(W*p) + u",
                    "Vector r = W%*u - 0.2*q",
                    "Vector w = W*q + 0.1*w",
                    f"Vector r = A*{rng.choice(self._vectors)} + {rng.choice(self._vectors)}",
                    "Vector p = 0.3*A%*q",
                )
            )
        ]

    def matrix(self) -> list[str]:
        """Whole matrices."""
        rng = self._rng
        bounds = rng.choice(("", "", "; -0.3, 0.4", "; -abs(a), abs(a)"))
        mask = rng.choice(("", "", "[M] "))
        function = rng.choice(_MATRIX if self._wild else _SAFE)
        return [
            rng.choice(
                (
                    f"MATRIX K = {mask}{self._number()}*u*p{bounds}",
                    f"MATRIX K = {mask}u & q{bounds}",
                    "DELTA W = 0.01*u*p",
                    f"MATRIX K = {function}(W + K)",
                    "DELTA K = 0.1*W - 0.1*K",
                    "MATRIX K = 0.5*K + 0.2*W",
                )
            )
        ]

    def summed(self) -> list[str]:
        """Scalar products."""
        rng = self._rng
        if rng.random() < 0.3:
            return self._assigned(rng.choice(("u*W*p", "p*A*q", "u*W*q")), "DOT ")
        left, right = rng.choice(self._vectors), rng.choice((*self._vectors, "1"))
        return self._assigned(
            f"{left}*{right}" + (f" - {right if right != '1' else 'q'}*1" if rng.random() < 0.3 else ""),
            rng.choice(("DOT ", "AVG ")),
        )

    def learned(self) -> list[str]:
        """Competitive learning."""
        rng = self._rng
        vigilance = rng.choice(("0", "0", "0", "0.1"))
        return [
            rng.choice(
                (
                    f"CLEARN V = W(p) {rng.choice(('0.1', '0.25'))}, {vigilance}{rng.choice(('', '#'))}",
                    "PLEARN w = W*p; 0.05",
                    "INTP w = W*p; 1.5",
                )
            )
        ]

    def element(self) -> list[str]:
        """Single elements."""
        rng = self._rng
        index = rng.choice(("1", "n", "1", f"{self._n}"))
        return [f"{rng.choice(('p', 'q', 'r'))}[{index}] = {self._expression(self._known, 2)}"]

    def _vector(self, depth: int) -> str:
        rng = self._rng
        if depth == 0 or rng.random() < 0.2:
            name = rng.choice((*self._vectors, *self._vectors, "a", "t", self._number()))
            shifted = name in self._vectors and rng.random() < 0.15
            return f"{name}{{{rng.choice((1, -1, 2))}}}" if shifted else name
        inner = self._vector(depth - 1)
        form = rng.randrange(6)
        if form <= 2:
            return f"({inner} {rng.choice('+-*')} {self._vector(depth - 1)})"
        if form == 3:
            return f"{rng.choice(_ONE if self._wild else _SAFE)}({inner})"
        if form == 4:
            return f"sat({inner})^{rng.choice((2, 3, 1, 0))}"
        return f"1/(2 + {inner}^2)" if not self._draws or rng.random() < 0.6 else f"(ran() + {inner})"

    def _expression(self, names: list[str], depth: int, *, draws: bool = True) -> str:
        rng = self._rng
        if depth == 0 or rng.random() < 0.2:
            if draws and self._draws and rng.random() < 0.12:
                return rng.choice(("ran()", "gauss(0)"))
            return rng.choice(names) if rng.random() < 0.7 else self._number()

        def inner() -> str:
            return self._expression(names, depth - 1, draws=draws)

        form = rng.randrange(12)
        if form <= 3:
            return f"({inner()} {rng.choice('+-*')} {inner()})"
        if form <= 5:
            return f"{rng.choice(_ONE if self._wild else _SAFE)}({inner()})"
        if form == 6:
            return f"{inner()}/({inner()})" if self._wild else f"{inner()}/(1.5 + ({inner()})^2)"
        if form == 7:
            power = (
                rng.choice(("2", "3", "0", "1", "(-1)", "0.5", "b", "5")) if self._wild else rng.choice("23")
            )
            return f"({inner()})^{power}"
        if form == 8:
            return f"{rng.choice(('max', 'min', 'atan2'))}({inner()}, {inner()})"
        if form == 9:
            return f"comp({inner()}, {inner()}, {inner()})"
        if form == 10 and "u$" not in names:
            return f"f({inner()})" if rng.random() < 0.5 else f"g({inner()}, {inner()})"
        return f"sqrt(abs({inner()}))"


_STATEMENTS = (
    *(ProgramMaker.scalar,) * 6,
    ProgramMaker.persistent, ProgramMaker.delayed, ProgramMaker.table, ProgramMaker.stored, ProgramMaker.tracked,
    ProgramMaker.ended, ProgramMaker.vector, ProgramMaker.vector, ProgramMaker.product, ProgramMaker.product,
    ProgramMaker.matrix, ProgramMaker.summed, ProgramMaker.learned, ProgramMaker.element, ProgramMaker.past,
)  # fmt: skip
_AT_MOMENTS = (
    ProgramMaker.scalar, ProgramMaker.persistent, ProgramMaker.table, ProgramMaker.vector, ProgramMaker.product,
    ProgramMaker.matrix, ProgramMaker.summed, ProgramMaker.element,
)  # fmt: skip
