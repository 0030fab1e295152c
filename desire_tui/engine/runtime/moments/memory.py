"""What stepping through moments needs to know: one C structure, filled by `setup`."""

from __future__ import annotations

import ctypes

_ADDRESS, _INT, _REAL = ctypes.c_uint64, ctypes.c_int64, ctypes.c_double
_REALS, _INTS, _ADDRESSES = (ctypes.POINTER(kind) for kind in (_REAL, _INT, _ADDRESS))

Compute = ctypes.CFUNCTYPE(_INT, _ADDRESS, _ADDRESS)
"""f(memory, derivatives): a pass over the values; its result is not looked at."""


Limit = ctypes.CFUNCTYPE(_REAL, _ADDRESS, _REAL, _REAL)
"""f(watch, t, wish): how far a step from t may go."""
Look = ctypes.CFUNCTYPE(ctypes.c_int32, _ADDRESS, _REAL, _REAL)
"""f(watch, t0, t1): whether something has switched in a step; t and states are then those just behind."""
Depart = ctypes.CFUNCTYPE(ctypes.c_int32, _ADDRESS)
"""f(watch): take up what has switched; bits of `switching.memory`."""
Settle = ctypes.CFUNCTYPE(ctypes.c_int32, _ADDRESS, _REAL)
"""f(watch, t): take up what has switched, and cross what switches by t; bits of `switching.memory`."""
Place = ctypes.CFUNCTYPE(_INT, _ADDRESS, _REAL)
"""f(owner, t): put t and the states that the solver's last step has there into the values."""


class Moments(ctypes.Structure):
    """A model's events, and the explicit rule that steps it.

    Events, `count` of them, by number: `period` is 0 for one with a condition, whose present value the pass
    `conditions` puts at `now` + number. The pass `blocks` carries out those with 1 at `due` + number.
    A condition is `armed` while it has not been above 0; `before` is its value at the step's start.

    Histories: `knots` of them, at `times`, which are equal where the value jumps.

    The rule: rows of its tableau as whole multiples over a denominator.
    """

    _fields_ = (
        ("values", _REALS),  # slot 0
        ("memory", _ADDRESS),  # the RunMemory, handed to the model's functions
        ("conditions", Compute), ("blocks", Compute), ("derivative", Compute),
        ("count", _INT),
        ("condition_count", _INT),
        ("now", _INT), ("due", _INT),  # first slots
        ("before", _REALS), ("at_left", _REALS), ("at_right", _REALS), ("fired", _REALS),
        ("armed", _INTS),
        ("in_doubt", _INTS),  # not below 0 behind its own block: up or down?
        ("goes_on", _INT),  # 1: the run continues one, in which what stands at 0 has had its turn
        ("period", _REALS), ("start", _REALS), ("ticks", _REALS), ("next", _REALS),
        # an event that comes ever faster, until it does every few steps
        ("came", _REALS), ("gap", _REALS),  # of each: when it came last, and how long behind the one before
        ("turned", _INTS),  # 1: it fell at once behind its own block, to come again
        ("sooner", _INTS),  # so often in a row it turned, and came sooner than before
        ("widest", _REALS),  # the time between two before it came sooner
        ("lost", _INT),  # number + 1 of one that came so, and then went through: what comes is too close
        ("shrunk", _INTS), ("quick", _INTS),  # so often in a row the gap became less; was a few steps
        # very many events in a very short time
        ("firings", _INT), ("firings_since", _REAL), ("span", _REAL), ("last_fired", _INT),
        # states and the rule
        ("n", _INT),
        ("range_count", _INT), ("ranges", _INTS),  # (slot, first state, count)
        ("x0", _REALS),
        ("k", _REALS),  # derivatives, stage after stage
        ("k_at", _ADDRESSES),  # where each stage's begin
        ("stages", _INT),
        ("rows", _REALS), ("denominators", _REALS),  # of the stages, of the result, of the test
        ("nodes", _REALS),
        # histories of `delay_count` values, a row of `room` numbers each
        ("delay_count", _INT),
        ("sources", Compute),  # puts the present values at `source` + number
        ("source", _INT),
        ("state_of", _INTS),  # the state that a value is, or -1
        ("tau", _REALS),  # 0: it varies
        ("tau_least", _REAL),
        ("has_past", _INT),  # 1: histories are those of the run before
        ("room", _INT), ("knots", _INT),
        ("times", _REALS), ("history", _REALS), ("slopes", _REALS),
        ("spare", _REALS),  # four numbers
        ("near", _REAL),  # times so near to one another are the same
        ("is_inside", _INT),  # 1 inside a step, where a jump at its end has not happened yet
        ("jump_room", _INT), ("jump_count", _INT),
        ("jumps", _REALS), ("smoothness", _INTS),  # when, and the first derivative that jumps
        ("found", _INTS),  # of each value: the knot that was found last
        ("jump_at", _INTS),  # of each value: the next one to come back
        ("is_variable", _INT), ("dt_may_change", _INT),
        # rules 4, 7, 8: what switches besides (`integration.switching.watch`), 0: nothing does
        ("watch", _ADDRESS), ("limit", Limit), ("look", Look), ("depart", Depart),
        ("settle", Settle),
        ("t_stop", _REAL),  # no stage sees what is behind
        # rules 9 … 17, whose steps are not made again: so many looks at each, 0: another rule
        ("places", _INT), ("place", Place), ("owner", _ADDRESS),
        # rule 17: of each condition the number of its series (`along`), where in the step it fell below 0 …
        ("arguments", _INTS), ("fell", _REALS),
        ("kept_armed", _INTS), ("kept_doubt", _INTS), ("kept_before", _REALS),  # at its start
        ("left", _REAL), ("right", _REAL),  # … and between which places the first event comes
    )  # fmt: skip


class SideBySide(ctypes.Structure):
    """`width` runs in lock step: what they need where some of them make a step alone (`side_by_side`).

    Arrays hold a number for each run, those of one slot, state, event or delay side by side.
    """

    _fields_ = (
        ("values", _REALS),  # slot 0
        ("memory", _ADDRESS),  # the RunMemory that all of them use in turn
        ("moments", _ADDRESSES),  # of each run
        ("width", _INT), ("count", _INT), ("n", _INT), ("delay_count", _INT),  # runs, events, states, delays
        ("source", _INT),  # first slot of what delays remember
        ("own_count", _INT), ("own_slots", _INTS), ("own", _REALS),  # what differs, and where it stands
        ("k1", _REALS),
        ("sources", _REALS),  # what the delays remember
        ("before", _REALS), ("armed", _INTS), ("in_doubt", _INTS),  # of the events
        ("soon", _REALS),  # when the next clock is due or a jump comes back
        ("random", _INTS),
        ("wanted", _INTS),  # 1: makes this step alone; 2: its start has been recorded
        ("failed", _INTS),
        # (groups, 4·events + delays, width): period, start, ticks, next time of each; delays
        ("times", _REALS), ("group", _INT),
        ("here", _REAL), ("t_next", _REAL), ("k", _INT),  # where the step begins
        ("s", _REALS), ("past", _REALS), ("found", _REALS),  # times, values before the start, results
    )  # fmt: skip
