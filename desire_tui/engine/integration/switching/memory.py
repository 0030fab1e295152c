"""What watching a run's switches needs to know: one C structure, filled by `setup`."""

from __future__ import annotations

import ctypes

_ADDRESS, _INT, _REAL = ctypes.c_uint64, ctypes.c_int64, ctypes.c_double
_REALS, _INTS = ctypes.POINTER(_REAL), ctypes.POINTER(_INT)

Compute = ctypes.CFUNCTYPE(_INT, _ADDRESS, _ADDRESS)
"""f(memory, derivatives): a pass over the values; its result is not looked at."""
Place = ctypes.CFUNCTYPE(_INT, _ADDRESS, _REAL)
"""f(owner, t): put t and the states that the step has there into the values."""

JUMPED, CHATTERS = 1, 2
"""What `settle` and `depart` report, as bits: derivatives or states jumped; the run must end."""


class Watch(ctypes.Structure):
    """A model's switches in a run.

    Modes: numbers that are constant while a step lasts. `frozen` are those in force, `live` what `modes`
    computes from t and the states in the values, of `arguments`; each stand in a row there.

    Switches of t: a program (see `program`) over registers `low` and `high`; behind them, up to
    `box_instruction_count`, it has the modes' jumps, whose bounds over a box of t and states tell that no
    mode switches there (see `clearance`).
    """

    _fields_ = (
        ("values", _REALS),  # slot 0
        ("memory", _ADDRESS),  # the RunMemory, handed to the model's functions
        ("modes", Compute),
        ("derivative", Compute),
        ("place", Place),
        ("owner", _ADDRESS),  # what `place` is called with
        ("count", _INT),  # of modes
        ("frozen", _INT), ("live", _INT), ("arguments", _INT),  # first slots
        ("rising", _INTS),  # of each mode: 1 where only 0 → 1 counts (`term`, `event`)
        ("thresholds", _INTS),  # of each mode: a `lowered.switching.Threshold`
        ("thresholds_are_0", _INT),  # all of them
        ("at_start", _REALS),  # arguments at the step's start, and what they changed by in the one before …
        ("changes", _REALS),
        ("h_before", _REAL),  # … of this size
        ("switched", _INT),  # the mode that switched last; -1 - k: switch of t number k
        # states, and the step's polynomial for rules that have none of their own
        ("n", _INT),
        ("range_count", _INT), ("ranges", _INTS),  # (slot, first state, count)
        ("x0", _REALS), ("f0", _REALS), ("x1", _REALS), ("f1", _REALS),
        ("f1_address", _ADDRESS),
        ("t0", _REAL), ("h", _REAL),
        ("is_cubic", _INT),  # 0: f1 is not known yet
        # switches of t
        ("instructions", _INTS), ("instruction_count", _INT),
        ("low", _REALS), ("high", _REALS),
        ("tables", _INTS),  # (slot, number of breakpoints)
        ("before", _REALS), ("behind", _REALS),  # what each instruction's switch is at two times
        ("inputs", _INTS), ("input_registers", _INTS), ("input_count", _INT),  # slots → registers
        ("clear_to", _REAL),  # nothing switches up to here
        ("found", _INT),  # whether something switches between `last` and `next`, neighbouring numbers
        ("last", _REAL), ("next", _REAL),
        ("is_jump", _INT), ("culprit", _INT),  # the instruction
        ("t_end", _REAL),
        # a box in which no mode switches
        ("box_instruction_count", _INT),
        ("box_count", _INT),  # sides; 0: no box is kept
        ("box_slots", _INTS), ("box_registers", _INTS),  # of each side
        ("box_low", _REALS), ("box_high", _REALS), ("box_scale", _REALS),
        ("reach_low", _REALS), ("reach_high", _REALS),  # by how much sides are moved next
        ("box_last", _REALS), ("box_moves", _REALS),  # where it was at the step's end, how far it moved …
        ("box_h", _REAL),  # … in a step of this size
        ("box_known", _INT),  # 0: it has to be made from nothing
        ("box_wait", _INT), ("box_pause", _INT),  # steps until it may be made again
        ("box_since", _REAL),  # t where it was made
        ("strayed", _INT),  # whether steps inside it have left `at_start` behind
        # chattering
        ("switches", _INT), ("switches_since", _REAL), ("span", _REAL),
    )  # fmt: skip
