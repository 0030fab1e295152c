"""The structure that CVODE's callbacks get: where the model's functions, states and tables stand.

Native callbacks (`codegen.stiff`) and Python ones (`integration.callbacks`) read the same structure;
addresses are plain integers, 0 for what is missing.
"""

from __future__ import annotations

import ctypes
from enum import IntEnum
from typing import Any

_ADDRESS, _INT, _REAL = ctypes.c_uint64, ctypes.c_int64, ctypes.c_double


STUCK_MOST = 100
"""So many steps in a row that leave t as it was end the run: a pole, or a jump that no step gets across."""
STUCK_FLAG, STUCK_AT_EDGE_FLAG = -1, -10
"""What is then reported, as CVODE's flags: too much work; derivatives that were not finite."""
TOO_NEAR = 2e-15
"""A step is not worth making if t and its end differ by this part of t: CVODE refuses it."""
CHATTER_STEPS, CHATTER_PART, CHATTER_FLAG = 50_000, 1e-3, -3
"""A run ends (CVODE's flag: error test failed) if so many steps went through less than this part of COMINT
and half as many were rejected besides: a relay that holds the solution on its jump would take for ever."""


JACOBIAN_SERVES_STEPS = 51
"""A Jacobian serves for so many steps [CVODE's msbj], but for a single one while the corrector is in doubt.

Where it changes from step to step, and an old one is far larger than it should be, corrections come out as
next to nothing, which passes for convergence: `d/dt y = -1/(2*y)` went through its singularity on a straight
line, to 1e9, under rules 10, 11, 14 and 15, and no flag said so. CVODE's corrector is also held to a stricter
test in doubt (`sundials.solver.Convergence`)."""
DOUBT_FAILURE, DOUBT_FROM, DOUBT_MOST = 20, 40, 100
"""A failure of the corrector raises doubt by the first number, up to the last, each step lowers it by 1; from
the second on it counts: three failures in a row, then one in twenty steps."""
ITERATION_DOUBT_FROM = 0
"""The same of functional iteration: any failure counts, for twenty steps, as it tells of a stiff model."""


ERROR_SHARE = 0.02
"""Part of ERMAX that a step's error, a root mean square over the states, may reach by the solver's estimate.

Errors of single states are larger than the mean, true ones larger than estimated, and they add up: with 1
ERMAX was exceeded tenfold to a hundredfold at the end of common problems, and Robertson's ran away at most
tolerances. With 1/50 the multistep rules keep 10·ERMAX on all problems of docs/rules.md, in 1.3 to 2 times
the steps."""
NEWTON_ERROR_SHARE = 0.04
"""The same under rules whose corrector is Newton's iteration with a whole matrix, whose own errors are small:
with 1/25 they keep 6·ERMAX on the same problems, with 1/20 not even 10."""
SERIES_ERROR_SHARE = 0.1
"""The same under rule 17, of which not the error but the first terms left out are estimated."""

FLOOR = 1e-20
"""A wave that runs into states at rest moves distant ones by 1e-200 at once; to follow those to ERMAX of
themselves would take the smallest of steps, and 1/1e-320 is no number at all."""


NOISE_WAIT, NOISE_FAILURE = 300, 20
"""Steps until rounding noise is looked for, a failed try counting as 20; twice as many each time that there
is none."""
NOISE_NEVER = 2**62
"""Steps until it is looked for by solvers whose steps do not depend on derivatives' last digits."""
NOISE_TRIES = 6
"""Evaluations with states up to 2.5 ulps away: what the derivatives differ by is their rounding level."""
NOISE_PART = 100.0
"""A derivative within so many rounding levels of 0, of a state within so many of their sum, is noise."""
NOISE_ROOM = 1000.0
"""Errors of such a state may be so many times as large: the corrector is held to a thousandth of them."""
ULP = 2.220446049250313e-16


SLIDE_TURNS, SLIDE_STEPS, SLIDE_PARTS = 200, 3, 4000
"""A relay slides (`integration.sliding`) if so many times in a row an input returns to what it was before,
within so many steps each time; steps may then grow to the run's length divided by the last number."""


FUNCTIONS: dict[str, tuple[Any, tuple[Any, ...]]] = {
    "derivatives": (_INT, (_ADDRESS, _ADDRESS)),
    "tangent": (_INT, (_ADDRESS, _ADDRESS)),
    "jacobian": (_INT, (_ADDRESS, _ADDRESS)),
    "step": (_INT, (_ADDRESS, _ADDRESS)),
    "data_of": (_ADDRESS, (_ADDRESS,)),
    "indices_of": (_ADDRESS, (_ADDRESS,)),
    "starts_of": (_ADDRESS, (_ADDRESS,)),
    "limit": (_REAL, (_ADDRESS, _REAL, _REAL)),
    "look": (ctypes.c_int32, (_ADDRESS, _REAL, _REAL)),
    "settle": (ctypes.c_int32, (_ADDRESS, _REAL)),
    "depart": (ctypes.c_int32, (_ADDRESS,)),
    "limit_step": (_REAL, (_ADDRESS, _REAL, _REAL, _REAL)),
    "look_inside": (_INT, (_ADDRESS, _REAL, _REAL)),
    "look_along_series": (_INT, (_ADDRESS, _ADDRESS, _REAL, _REAL)),
    "cut_short": (None, (_ADDRESS,)),
    "remember_step": (None, (_ADDRESS, _REAL, _REAL)),
    "happen": (ctypes.c_int32, (_ADDRESS, _INT)),
    "at_start": (_INT, (_ADDRESS, _ADDRESS)),
    "recurrences": (None, (_ADDRESS, _ADDRESS, _INT)),
}
"""What the functions are whose addresses stand in a `SolverProblem`: results and arguments."""


class Matrix(IntEnum):
    """How the Jacobian's entries are found."""

    NONE = 0
    TANGENT = 1
    """Exactly: for each colour the derivative of the right-hand side in the direction of its states."""
    DIFFERENCES = 2
    """For each colour one difference of the right-hand side."""
    PROGRAM = 3
    """The program's JACOBIAN segment."""


class SolverProblem(ctypes.Structure):
    """One model under a multistep rule.

    Functions of the model, C calling convention: `derivatives(memory, k)` and `tangent(memory, k)` write n
    numbers to `k` from t and the states (and their directions) in the values; `jacobian(memory)` runs the
    JACOBIAN segment; `step(memory)` runs `pass(-, STEP)` and returns 0, or 1 + the number of the `term`
    that fired.

    Tables: `ranges` holds triples (slot, first state, count) of int64. The states of colour c are
    `seeds[seed_starts[c]] …`, its matrix entries `rows[entry_starts[c]] …` with their flat `places` in the
    matrix and (PROGRAM, one colour) `sources` in the program's array. A sparse matrix' own `row_indices` and
    `column_starts` are copied into it each time. All are int32.
    """

    _fields_ = (
        ("memory", _ADDRESS),  # the RunMemory, handed to the model's functions
        ("values", _ADDRESS),  # slot 0
        ("derivatives", _ADDRESS),
        ("tangent", _ADDRESS),
        ("jacobian", _ADDRESS),
        ("step", _ADDRESS),
        ("n", _INT),
        ("range_count", _INT),
        ("ranges", _ADDRESS),
        ("states", _ADDRESS),  # CVODE's y
        ("last", _ADDRESS),  # y as CVODE left it: another one now means that the program changed a state
        ("largest", _ADDRESS),  # max |y| so far
        ("floor", _REAL),  # no state's largest value counts as less: FLOOR times that of all states
        ("tolerance", _REAL),  # ERMAX
        ("absolute", _REAL),  # ERABS
        ("noise", _ADDRESS),  # below this error a state is nothing but rounding noise (`stiff.rounding`)
        ("noisy", _INT),  # 1: one of those is not 0
        ("moved", _ADDRESS),  # n numbers each, to find that
        ("base", _ADDRESS),
        ("rate", _ADDRESS),
        ("level", _ADDRESS),
        ("noise_seen", _INT),  # steps and failed tries when noise was looked for last …
        ("noise_wait", _INT),  # … and how many more there must be until the next time
        ("method", _INT),  # a Matrix
        ("colours", _INT),
        ("seed_starts", _ADDRESS),
        ("seeds", _ADDRESS),
        ("entry_starts", _ADDRESS),
        ("rows", _ADDRESS),
        ("columns", _ADDRESS),  # DIFFERENCES: each entry's state
        ("places", _ADDRESS),
        ("sources", _ADDRESS),
        ("directions", _ADDRESS),  # TANGENT: n numbers, the states' directions; 0 but while it is called
        ("array", _ADDRESS),  # PROGRAM: the JACOBIAN segment's array
        ("spare", _ADDRESS),  # n numbers
        ("nonzeros", _INT),
        ("row_indices", _ADDRESS),
        ("column_starts", _ADDRESS),
        ("data_of", _ADDRESS),  # SUNDIALS' functions that tell where a matrix keeps its numbers …
        ("indices_of", _ADDRESS),  # … and, sparse, rows and column starts
        ("starts_of", _ADDRESS),
        ("solver", _ADDRESS),  # CVODE's memory
        ("vector", _ADDRESS),  # N_Vector over `states`
        ("derivative_calls", _INT),
        ("started", _INT),  # 0: nothing has been done yet
        ("anew", _INT),  # 1: begin anew before the next step
        ("t", _REAL),  # of the states in `last`, which the values were left with
        ("t_step", _REAL),  # time that the solver has reached, its states in `states`
        ("t_end", _REAL),  # of the run
        ("passed", _REAL),  # time at which the pass at a step's start has been made
        ("is_free", _INT),  # 1: steps go beyond communication points, where states are interpolated
        ("settled", _INT),  # 0: what has switched in the last step is still to be taken up
        ("between", _ADDRESS),  # n numbers: states inside a step …
        ("between_vector", _ADDRESS),  # … and CVODE's N_Vector over them
        ("inputs", _ADDRESS),  # int64 slots of what code at points and steps sets and derivatives read …
        ("inputs_kept", _ADDRESS),  # … and the numbers there when the last step began
        ("inputs_before", _ADDRESS),  # … and those that stood there before they changed to these
        ("input_count", _INT),
        ("returned", _INT),  # 1: all inputs that changed last changed back
        ("turns", _INT),  # so often in a row
        ("relief", _REAL),  # 1, or what `tolerance` and `absolute` are multiplied by while a relay slides …
        ("slide_size", _REAL),  # … until steps are so large
        ("watch", _ADDRESS),  # `switching.memory.Watch`, 0: nothing switches
        ("limit", _ADDRESS),  # functions of `switching.watch`
        ("look", _ADDRESS),
        ("settle", _ADDRESS),
        ("depart", _ADDRESS),
        ("moments", _ADDRESS),  # `runtime.moments.memory.Moments`, 0: neither events nor delays
        ("limit_step", _ADDRESS),  # functions of `runtime.moments`
        ("look_inside", _ADDRESS),
        ("look_along_series", _ADDRESS),
        ("cut_short", _ADDRESS),
        ("remember_step", _ADDRESS),
        ("happen", _ADDRESS),
        ("first_step", _REAL),  # 0: CVODE looks for one
        ("jacobian_calls", _INT),
        ("failed", _INT),  # steps tried again before the last restart
        ("suspect", _INT),  # state whose derivative was not finite; -1: none
        ("restarts", _INT),
        ("diverged", _INT),  # how often the corrector has failed since the last restart …
        ("doubt", _INT),  # … and how much is thought of that
        ("doubt_from", _INT),  # from where it counts
        ("convergence", _REAL),  # share of the error test left to CVODE's corrector …
        ("convergence_in_doubt", _REAL),  # … and in doubt
        ("fresh", _INT),  # steps since the last restart
        ("stuck", _INT),  # steps in a row that were too small to change t
        ("watch_steps", _INT),  # steps since chattering was last looked for, and t and failures then
        ("watch_t", _REAL),
        ("watch_failed", _INT),
        ("reached", _REAL * 1),  # where CVODE's functions write what they find
        ("size", _REAL * 1),
        ("count", _INT * 1),
    )
