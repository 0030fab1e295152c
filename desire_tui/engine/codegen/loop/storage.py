"""What the run loop asks of the place where states, derivatives and scalars live."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from desire_tui.engine.integration.tableaus import Row


class Storage(Protocol):
    """Where states, derivatives and scalars are: stack cells or arrays (`…_storage`)."""

    may_come_late: bool
    """Whether code behind `step` may change what derivatives read."""

    def enter(self) -> None:
        """Begin the function."""

    def refresh(self) -> None:
        """Take scalars and states as others have set them in the values."""

    def leave(self) -> None:
        """Bring the values up to date before a return."""

    def load(self, slot: int) -> str:
        """Read t or another scalar."""
        ...

    def store(self, slot: int, value: str) -> None:
        """Write it."""

    def run_pass(self, kind: str, stage: int) -> None:
        """Write a pass whose derivatives are those of a stage, from 1."""

    def save(self) -> None:
        """Keep the states at a step's start."""

    def advance(self, row: Row, dt: str, *, saves: bool = False) -> None:
        """States ← saved states + dt·Σ row·k; `saves`: it saves them itself before."""

    def whole_step(self) -> str:
        """Return the address of what takes a fixed step as a whole, perhaps null; "": there is no such thing.

        Called with the values, the first stage if it is known, else null, t_base, k and DT.
        """
        ...

    def restore(self) -> None:
        """States ← saved states."""

    def difference(self, row: Row, dt: str) -> tuple[str, str]:
        """Return the largest test difference, and the number of the state it belongs to."""
        ...

    def wild(self) -> str:
        """Return an i1: some state is inf or nan."""
        ...

    def width(self) -> str:
        """Return the number of doubles in a row: t and the columns."""
        ...

    def row(self, at: str, t: str) -> str:
        """Write a row of samples; return an i1: some column is inf or nan."""
        ...

    def vital_wild(self) -> str:
        """Return an i1: some column that states depend on is inf or nan."""
        ...

    def has_pass(self, kind: str) -> str:
        """Return an i1: a pass does anything."""
        ...

    def keep_change(self) -> None:
        """Put k1 in k2's place."""

    def switched(self, kind: str) -> str:
        """Return an i1: by what `watch_stage` or `watch_end` has found, some mode may have switched."""
        ...

    @property
    def has_box(self) -> bool:
        """Whether there is a box where no mode switches."""
        ...

    def is_in_box(self, *, at_end: bool) -> str:
        """Return an i1: t (only where it is `at_end`) and states are in that box."""
        ...

    def keep_first_stage(self) -> None:
        """Put k1 where the next call finds it."""

    def keep_start(self) -> None:
        """Put the states at the step's start where others find them."""

    def recall_first_stage(self) -> None:
        """Get it back."""
