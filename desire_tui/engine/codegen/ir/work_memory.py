"""What compiled code knows besides values and memory: where its own work arrays and pieces are."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING

from desire_tui.engine.runtime.run_memory import RunMemory

if TYPE_CHECKING:
    from desire_tui.engine.codegen.ir.text import IrText

PASSES = ("derivative", "step", "full", "tail", "renewal", "step_renewal", "watch_stage", "watch_end")
"""The pass with its flags folded in: later stages, step starts, communication points, after `term`;
derivatives computed anew behind communication points and behind other step starts (`passes.renewal`);
what tells whether something may have switched in a step (`passes.watch_passes`)."""


class WorkMemory(ctypes.Structure):
    """One model's tables. One of pieces holds the addresses of functions and their data, and ends with 0.

    The addresses in a table may be replaced at any moment by those of faster code that computes the same
    bits.
    """

    _fields_ = (
        ("memory", ctypes.c_uint64),  # the RunMemory of the call under way
        ("values", ctypes.c_uint64),
        ("temps", ctypes.c_uint64),  # scratch vectors of the pieces
        ("term", ctypes.c_int64),  # number of the `term` that fired in the last pass, or -1
        ("hurry", ctypes.c_int64),  # not 0: come back at the next step, faster code is there
        ("derivative", ctypes.c_uint64),  # tables of pieces
        ("step", ctypes.c_uint64),
        ("full", ctypes.c_uint64),
        ("tail", ctypes.c_uint64),
        ("renewal", ctypes.c_uint64),
        ("step_renewal", ctypes.c_uint64),
        ("watch_stage", ctypes.c_uint64),
        ("watch_end", ctypes.c_uint64),
        ("states", ctypes.c_int64),
        ("state_slots", ctypes.c_uint64),  # int64 slot of each state
        ("x", ctypes.c_uint64),  # first state, where the states stand in a row
        ("x0", ctypes.c_uint64),  # states at the step's start
        ("k1", ctypes.c_uint64),  # derivatives of each stage
        ("k2", ctypes.c_uint64),
        ("k3", ctypes.c_uint64),
        ("k4", ctypes.c_uint64),
        ("columns", ctypes.c_uint64),  # int64 slot of each sampled column
        ("column_count", ctypes.c_int64),
        ("vital", ctypes.c_uint64),  # int64 slots of the columns that states depend on
        ("vital_count", ctypes.c_int64),
        ("interval", ctypes.c_uint64),  # rules 9 … 16: `stiff.interval` and its structure
        ("problem", ctypes.c_uint64),
        ("watch", ctypes.c_uint64),  # what switches, and the functions that see to it (`switching`)
        ("limit", ctypes.c_uint64),
        ("follow", ctypes.c_uint64),
        ("depart", ctypes.c_uint64),
        ("mode_count", ctypes.c_int64),
        ("modes_frozen", ctypes.c_uint64),  # rows of modes (`lowered.switching.ModeSlots`)
        ("modes_first", ctypes.c_uint64),
        ("modes_second", ctypes.c_uint64),
        ("factor", ctypes.c_double),  # what loops shared among threads multiply by (`loop.shared_storage`)
        ("partial", ctypes.c_uint64),  # and what they find in each block: two numbers
        ("blocks", ctypes.c_uint64),  # where they are cut (`loop.state_blocks`)
        ("block_count", ctypes.c_int64),
        ("whole_step", ctypes.c_uint64),  # `lanes.replica_steps`: takes the place of stages; or 0
        ("box_low", ctypes.c_uint64),  # the box in which no mode switches (`integration.switching.clearance`)
        ("box_high", ctypes.c_uint64),
        ("box_wait", ctypes.c_uint64),  # where the steps are counted down until it may be made anew
    )


_KINDS = {ctypes.c_double: "double", ctypes.c_int64: "i64", ctypes.c_int32: "i32", ctypes.c_uint64: "ptr"}


class Fields:
    """Reads and writes the fields of a C structure in a text. Unsigned fields and arrays are pointers."""

    __slots__ = ("_base", "_offsets", "_text")

    def __init__(self, text: IrText, structure: type[ctypes.Structure], base: str) -> None:
        self._text = text
        self._base = base
        self._offsets = _offsets(structure)

    def at(self, name: str) -> str:
        """Return the field's address."""
        offset, _ = self._offsets[name]
        return self._text.op(f"getelementptr i8, ptr {self._base}, i64 {offset}")

    def load(self, name: str, *, volatile: bool = False) -> str:
        """Read the field; `volatile`: another thread may have written it."""
        kind = self._offsets[name][1]
        return self._text.op(f"load {'volatile ' if volatile else ''}{kind}, ptr {self.at(name)}")

    def name(self, variable: str, name: str) -> None:
        """Read the field into a variable."""
        self._text.do(f"{variable} = load {self._offsets[name][1]}, ptr {self.at(name)}")

    def store(self, name: str, value: str) -> None:
        """Write the field."""
        kind = self._offsets[name][1]
        self._text.do(f"store {kind} {value}, ptr {self.at(name)}")


def _offsets(structure: type[ctypes.Structure]) -> dict[str, tuple[int, str]]:
    known = _TABLES.get(structure)
    if known is None:
        fields = [(entry[0], entry[1]) for entry in structure._fields_]
        known = _TABLES[structure] = {
            name: (getattr(structure, name).offset, _KINDS.get(kind, "ptr")) for name, kind in fields
        }
    return known


_TABLES: dict[type[ctypes.Structure], dict[str, tuple[int, str]]] = {}


def memory_fields(text: IrText, base: str = "%m") -> Fields:
    """Fields of the run's memory."""
    return Fields(text, RunMemory, base)


def context_fields(text: IrText, base: str = "%c") -> Fields:
    """Fields of the model's context."""
    return Fields(text, WorkMemory, base)
