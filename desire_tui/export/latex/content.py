"""A program's segments as a LaTeX document: equations, FUNCTIONs, parameters and initial values."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.check.declared import DeclaredNames
from desire_tui.engine.graph.units import units_of
from desire_tui.engine.nodes.declarations import Function
from desire_tui.engine.nodes.display import GraphText
from desire_tui.engine.nodes.expressions import Call, Name
from desire_tui.engine.nodes.walk import walk
from desire_tui.engine.structure.structure import structure
from desire_tui.engine.syntax.parse import parse
from desire_tui.export.latex.equations import SegmentEquations
from desire_tui.export.latex.expressions import Expressions
from desire_tui.export.latex.symbols import COMMA, Symbols, escaped
from desire_tui.export.latex.tables import table, used_names
from desire_tui.export.run import exported_run

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from desire_tui.engine.nodes.program import Placed, Program, SegmentText
    from desire_tui.engine.source import Source
    from desire_tui.engine.structure.structure import Structure
    from desire_tui.engine.values import Values
    from desire_tui.export.formats import Export
    from desire_tui.export.latex.equations import Group

LONG = 150
"""Characters of LaTeX behind which a sum goes on in the next row."""
ROWS_MAX = 60
"""Equations in one display: readers that render a display as a whole do not like longer ones."""
NOTES = {
    r"\odot": r"$\odot$ multiplies element by element, as do fractions, powers and functions.",
    r"\mathrm{S}^{": r"$\mathrm{S}^{k}\mathbf{x}$ has the elements $x_{i+k}$, 0 where there are none.",
    r"\operatorname{row}": r"$\operatorname{row}$ is the row of a matrix that $\mathrm{iRow}$ selects.",
    r"\operatorname{white}": r"$\operatorname{white}(s)$ is white noise of the spectral density $s^2$.",
    r"\operatorname{ran}": r"$\operatorname{ran}$ is uniformly distributed over $(-1, 1)$.",
    r"\operatorname{gauss}": r"$\operatorname{gauss}$ is normally distributed, with mean 0 and variance 1.",
}
"""What signs mean that a reader may not know."""
HEAD = r"""\documentclass{article}
\usepackage{amsmath,amssymb,longtable}
\usepackage[utf8]{inputenc}
\allowdisplaybreaks
\begin{document}
"""
TAIL = r"""\end{document}
"""


def content(export: Export) -> bytes:
    """Return the document. DesireError: the program has mistakes, or does not come to a run."""
    run = exported_run(export)
    return latex(parse(export.source), run.values, export.segment).encode()


def latex(program: Program, values: Values, only: str | None = None) -> str:
    """Return a program's segments, or the one with that label, as LaTeX; `values` are those of the start."""
    document = _Document(program, values)
    wanted = [one for one in program.segments if only is None or one.label == only]
    parts = [HEAD]
    for segment in wanted:
        parts += document.segment(segment)
    return "\n".join([*parts, TAIL])


class _Document:
    def __init__(self, program: Program, values: Values) -> None:
        self._program, self._values = program, values
        self._structure: Structure = structure(program)
        names = DeclaredNames(program, self._structure)
        self._functions: dict[str, Function] = {
            name: placed.node
            for name, placed in self._structure.functions.items()
            if isinstance(placed.node, Function)
        }
        ranks = {name: len(quantity.shape) for name, quantity in names.quantities.items()}
        self._writer = Expressions(Symbols(names.everything), ranks, frozenset(self._functions), {})
        self._units = _units(program)

    def segment(self, segment: SegmentText) -> Iterator[str]:
        """Yield the parts of a segment."""
        title = "Equations" if segment.label is None else f"Segment {escaped(segment.label)}"
        yield rf"\section*{{{title}}}"
        made = SegmentEquations(self._structure.submodels)
        made.add_all(segment.body, self._writer)
        shown = [part for group in made.groups for part in _group(group)]
        shown += self._own_functions(segment.body)
        yield from shown
        signs = [note for sign, note in NOTES.items() if any(sign in part for part in shown)]
        for note in dict.fromkeys([*made.notes, *self._tables_read(segment.body), *signs]):
            yield f"\n{note}"
        if segment.jacobian:
            jacobian = SegmentEquations({})
            jacobian.add_all(segment.jacobian, self._writer)
            yield "\nThe Jacobian matrix has the elements"
            yield from _group(jacobian.groups[0])
        yield from _left_out(made.left_out, self._program.source)
        yield from self._tables(segment.body)

    def _own_functions(self, body: Sequence[Placed]) -> Iterator[str]:
        """Yield the FUNCTIONs that a segment calls, those too that only others of them call."""
        called: dict[str, None] = {}
        waiting = list(body)
        nodes = [placed.node for placed in waiting]
        for submodel in self._structure.submodels.values():
            nodes += [placed.node for placed in submodel.body]
        while nodes:
            for part in walk(nodes.pop(0)):
                if isinstance(part, Call) and part.name in self._functions and part.name not in called:
                    called[part.name] = None
                    nodes.append(self._functions[part.name])
        if not called:
            return
        yield "\nwith"
        rows = []
        for name in called:
            function = self._functions[name]
            dummies = [self._writer.dummy(dummy) for dummy in function.dummies]
            left = rf"{self._writer.function(name)}\left({COMMA.join(dummies)}\right)"
            rows.append(_row(left, "=", self._writer.within_function(function.dummies).write(function.body)))
        yield _align(rows)

    def _tables_read(self, body: Sequence[Placed]) -> Iterator[str]:
        """Yield a note for each table function."""
        for placed in body:
            for part in walk(placed.node):
                if isinstance(part, Call) and part.name in {"func1", "func2"} and len(part.args) > 1:
                    name = part.args[1 if part.name == "func1" else 2]
                    if isinstance(name, Name):
                        yield f"${self._writer.function(name.name)}$ is a table, linear between its points."

    def _tables(self, body: Sequence[Placed]) -> Iterator[str]:
        used = used_names(body, self._structure.submodels, self._functions)
        for title, names, start in (
            ("parameter", used.parameters, False),
            ("initial state", used.begins, True),
        ):
            made = table(title, names, self._values, self._writer, self._units, start=start)
            if made:
                yield f"\n{made}"


def _units(program: Program) -> Mapping[str, str]:
    found: dict[str, str] = {}
    for placed in program.script:
        node = placed.node
        if isinstance(node, GraphText) and node.part == "units":
            found |= units_of(node.text)
    return found


def _group(group: Group) -> Iterator[str]:
    if not group.equations:
        return
    if group.when:
        yield f"\n{group.when}"
    rows = [_row(*equation) for equation in group.equations]
    for first in range(0, len(rows), ROWS_MAX):
        yield _align(rows[first : first + ROWS_MAX])


def _align(rows: Sequence[str]) -> str:
    body = " \\\\\n".join(f"  {row}" for row in rows)
    return f"\\begin{{align*}}\n{body}\n\\end{{align*}}"


def _row(left: str, relation: str, right: str) -> str:
    return f"{left} &{relation} {_broken(right)}"


def _broken(right: str) -> str:
    """Break a long sum at signs outside of all brackets, fractions and cases."""
    if len(right) <= LONG:
        return right
    pieces, depth, start, at = [], 0, 0, 0
    while at < len(right):
        if right.startswith((r"\left", r"\begin"), at) and not right.startswith(r"\leftarrow", at):
            depth += 1
        elif right.startswith((r"\right", r"\end"), at):
            depth -= 1
        elif right[at] == "{":
            depth += 1
        elif right[at] == "}":
            depth -= 1
        elif depth == 0 and right.startswith((" + ", " - "), at) and at - start > LONG // 2:
            pieces.append(right[start:at])
            start = at + 1
        at += 1
    pieces.append(right[start:])
    return " \\\\\n  &\\quad ".join(pieces)


def _left_out(statements: Sequence[Placed], source: Source) -> Iterator[str]:
    """Yield the lines that are no equations, as they stand in the program."""
    if not statements:
        return
    yield "\nLines of the program that have no form as mathematics:\n\\begin{verbatim}"
    for placed in statements:
        span = placed.span()
        text = " ".join(source.text[span.start : span.end].split())
        yield f"line {source.position(span.start).row}: {text}"
    yield r"\end{verbatim}"
