"""What the structure of a program is: where blocks, labels, definitions and data stand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass, field

if TYPE_CHECKING:
    from desire_tui.engine.diagnostics import Diagnostic
    from desire_tui.engine.nodes.control import Procedure
    from desire_tui.engine.nodes.program import Placed


@dataclass(frozen=True, slots=True)
class ProcedureText:
    """A PROCEDURE: its first line, and the places in the script of that line and of its `end`."""

    node: Procedure
    placed: Placed
    opens: int
    closes: int


@dataclass(frozen=True, slots=True)
class SubmodelText:
    """A SUBMODEL with its body's statements."""

    name: str
    dummies: tuple[str, ...]
    body: tuple[Placed, ...]
    placed: Placed


@dataclass(frozen=True)
class Structure:
    """What stands where. A *place* is an index into the script.

    `partner`: `if` → its `else`, or its `proceed` if it has none; `else` → its `proceed`; every other
    opener → its closer; every closer → its opener. `exits`: `exit` → the closer of the loop it leaves, or
    None for a PROCEDURE's return. `inside`: per statement the innermost open `if`, `else`, loop or
    definition, −1 outside of all. `data`: places of the data statements. `segment_partner`: per segment (by
    its label) the same as `partner` for `if`, `else` and `end if` in its body; an `if` without `end if` has
    none and rules the rest of the segment. `labels` and `numbers` (of lines) give places; the definitions go
    by name. `faults`: by a statement's offset the error that stops a program which gets to it, whether in the
    script, in a segment or in a submodel.
    """

    partner: dict[int, int] = field(default_factory=dict)
    exits: dict[int, int | None] = field(default_factory=dict)
    inside: list[int] = field(default_factory=list)
    labels: dict[str, int] = field(default_factory=dict)
    numbers: dict[int, int] = field(default_factory=dict)
    procedures: dict[str, ProcedureText] = field(default_factory=dict)
    submodels: dict[str, SubmodelText] = field(default_factory=dict)
    functions: dict[str, Placed] = field(default_factory=dict)
    data: list[int] = field(default_factory=list)
    segment_partner: dict[str | None, dict[int, int]] = field(default_factory=dict)
    problems: tuple[Diagnostic, ...] = ()
    faults: dict[int, Diagnostic] = field(default_factory=dict)

    def place(self, target: str) -> int | None:
        """Return where a label or a line number (digits) stands in the script."""
        return self.numbers.get(int(target[:9])) if target.isdigit() else self.labels.get(target)
