"""One communication interval under a rule 9 … 16, step by step, in plain Python.

`interval` starts from t and the states in the values, where the pass at the first step's start has been done,
and comes back with `Ended.RUNNING` once t is `t_next`; with STOPPED where `stop` was set; TERM with the
statement's number in `which`; SOLVER with CVODE's flag in `which`; ZENO where events come too fast; FULL
where there is no room for what delays remember.

The steps are those of `cvode_steps`, `own_steps`, `explicit_steps` or `taylor_steps`, whichever this text is
compiled with. Where the problem `is_free` they go on beyond communication points, whose states are
interpolated: the solver is then ahead of the values. It keeps a history of the solution and begins anew
where the states in the values are not what it left there (at a run's start, where difference-equation code
changed one, where the user did), where an input has changed, and where a derivative jumps.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.codegen.plain_python.library import copy
from desire_tui.engine.codegen.stiff.cvode_steps import (
    begin,
    failures,
    interpolate,
    last_size,
    take_step,
)
from desire_tui.engine.codegen.stiff.look_back import look
from desire_tui.engine.codegen.stiff.model_calls import gather, scatter, transfer
from desire_tui.engine.codegen.stiff.moment_steps import (
    begin_interval,
    enter_step,
    happen,
    has_room,
    look_for_events,
    nearness,
)
from desire_tui.engine.codegen.stiff.progress import record_step, watch_chatter, watch_progress
from desire_tui.engine.codegen.stiff.rounding import watch_noise
from desire_tui.engine.integration.problem import (
    SLIDE_STEPS,
    TOO_NEAR,
)
from desire_tui.engine.integration.sliding import end_slide, follow_slide
from desire_tui.engine.integration.sundials.signatures import TSTOP_RETURN
from desire_tui.engine.integration.switching.memory import CHATTERS
from desire_tui.engine.runtime.run_memory import Ended
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from desire_tui.engine.integration.plain_types import Int32, Ints, Reals
    from desire_tui.engine.integration.problem import SolverProblem
    from desire_tui.engine.runtime.run_memory import RunMemory


def interval(problem: SolverProblem, memory: RunMemory, t_next: float) -> Int32:
    """Make the steps of an interval."""
    states: Reals = problem.states
    between: Reals = problem.between
    synchronise(problem)
    if problem.moments != 0:
        begin_interval(problem, memory)
    if problem.watch != 0 and problem.settled != 0 and problem.t == problem.t_step:
        ended = take_up(problem, problem.depart(problem.watch))
        if ended != 0:
            return ended
    while True:
        if problem.t_step > t_next:
            interpolate(problem, t_next)
            leave(problem, t_next, between)
            return Ended.RUNNING
        if problem.t != problem.t_step and (problem.t_step >= t_next or is_seen(problem) != 0):
            leave(problem, problem.t_step, states)
        while problem.settled == 0:
            ended = settle_here(problem, t_next)
            if ended != 0:
                return ended
        if problem.t_step >= t_next:
            return Ended.RUNNING
        if problem.step != 0 and problem.passed != problem.t_step:  # pass(-, STEP) at a step's start
            problem.passed = problem.t_step
            fired: int = problem.step(memory, states)
            if fired != 0:
                memory.which = fired - 1
                return Ended.TERM
            synchronise(problem)
            if problem.watch != 0 and problem.anew != 0:
                ended = take_up(problem, problem.depart(problem.watch))
                if ended != 0:
                    return ended
        if problem.moments != 0 and has_room(problem) == 0:
            return Ended.FULL
        flag = advance_to(problem, memory, t_next)
        if flag < 0:
            memory.which = flag
            return Ended.SOLVER
        if memory.stop != 0 and problem.t_step < t_next:
            leave(problem, problem.t_step, states)
            return Ended.STOPPED


def is_seen(problem: SolverProblem) -> int:
    """Whether anything but derivatives reads the values between the steps of an interval."""
    return 1 if problem.step != 0 or problem.watch != 0 or problem.moments != 0 else 0


def advance_to(problem: SolverProblem, memory: RunMemory, t_next: float) -> int:
    """Take a step, to `t_next` at most unless the problem is free; return the flag."""
    values: Reals = problem.values
    states: Reals = problem.states
    t_from: float = problem.t_step
    stop = t_next
    if problem.is_free != 0:
        stop = max(stop, problem.t_end)
    near = TOO_NEAR * abs(stop)
    if problem.moments != 0:
        stop = problem.limit_step(problem.moments, t_from, stop, t_next)
        near = max(near, nearness(problem))
    if problem.watch != 0:
        stop = problem.limit(problem.watch, t_from, stop)
    if stop - t_from <= near:
        problem.t_step = stop
        leave(problem, stop, states)
        problem.anew = 1
        problem.settled = 0 if problem.watch != 0 or problem.moments != 0 else 1
        return 0
    if problem.anew != 0:
        begin_anew(problem, t_from)
    if problem.stuck == 0:
        problem.suspect = -1
    if problem.moments != 0:
        enter_step(problem, 1)
    flag = take_step(problem, stop)
    if problem.moments != 0:
        enter_step(problem, 0)
    problem.fresh += 1
    if problem.turns != 0 and problem.fresh > SLIDE_STEPS:
        end_slide(problem)
    t: float = problem.reached[0]
    if flag == TSTOP_RETURN or t >= stop:
        t = stop
    flag = watch_noise(problem, memory, t, flag)
    flag = watch_progress(problem, t, flag)
    flag = watch_chatter(problem, memory, t, flag)
    problem.t_step = t
    if flag < 0 or is_seen(problem) != 0:
        leave(problem, t, states)
    if flag < 0:
        return flag
    size = last_size(problem)
    values[DT] = size
    record_step(memory, size)
    if problem.moments != 0:
        t = look_for_events(problem, t_from)
    if problem.watch != 0:
        found: int = look(problem, t_from, t)
        if found > 0:
            if problem.moments != 0:
                problem.cut_short(problem.moments)
            gather(problem)
            problem.t_step = values[T]
            problem.anew = 1
        if found >= 0:
            problem.settled = 0
            leave(problem, problem.t_step, states)
    if problem.moments != 0:
        problem.remember_step(problem.moments, t_from, problem.t_step)
        problem.settled = 0
        leave(problem, problem.t_step, states)
    return 0


def settle_here(problem: SolverProblem, t_next: float) -> Int32:
    """Take up what has switched or is due where the last step has ended; return why the run ends, else 0."""
    ended = 0
    problem.settled = 1
    if problem.watch != 0:
        ended = take_up(problem, problem.settle(problem.watch, t_next))
    if ended == 0 and problem.moments != 0:
        came = happen(problem)
        if came > 1:
            return Ended.ZENO
        if came != 0:
            passed = problem.passed
            synchronise(problem)
            problem.passed = passed  # there the pass at a step's start is still to be made
            problem.anew = 1
            if problem.watch != 0:
                ended = take_up(problem, problem.depart(problem.watch))
    return ended


def take_up(problem: SolverProblem, bits: int) -> Int32:
    """Go on from the t and states in the values, behind a switching; return why the run ends, else 0."""
    values: Reals = problem.values
    states: Reals = problem.states
    if bits == 0 and values[T] == problem.t:
        return 0
    if problem.moments != 0 and values[T] > problem.t:
        problem.settled = 0  # an event may come behind a switch of t
    gather(problem)
    problem.t_step = values[T]
    leave(problem, problem.t_step, states)
    if bits != 0:
        problem.anew = 1
    return Ended.CHATTERS if bits >= CHATTERS else 0


def leave(problem: SolverProblem, t: float, x: Reals) -> None:
    """Put t and states into the values, and remember them."""
    values: Reals = problem.values
    last: Reals = problem.last
    values[T] = t
    problem.t = t
    scatter(problem, x)
    transfer(last, 0, x, problem.n)


def state_at(problem: SolverProblem, t: float) -> int:
    """Put t and the states that the last step has there into the values (`switching.memory.Place`)."""
    values: Reals = problem.values
    between: Reals = problem.between
    values[T] = t
    interpolate(problem, t)
    scatter(problem, between)
    return 0


def synchronise(problem: SolverProblem) -> None:
    """Begin anew, at the next step, if t, a state or an input is not what it was left as."""
    values: Reals = problem.values
    last: Reals = problem.last
    states: Reals = problem.states
    ranges: Ints = problem.ranges
    inputs: Ints = problem.inputs
    kept: Reals = problem.inputs_kept
    before: Reals = problem.inputs_before
    t = values[T]
    differ = 0
    for k in range(problem.range_count):
        slot = ranges[3 * k]
        first = ranges[3 * k + 1]
        for i in range(ranges[3 * k + 2]):
            differ += values[slot + i] != last[first + i]
    changed = 0
    returned = 0
    for i in range(problem.input_count):
        now: float = values[inputs[i]]
        if now != kept[i]:
            changed += 1
            returned += now == before[i]
            before[i] = kept[i]
            kept[i] = now
    if changed != 0:
        differ += 1
        problem.returned = 1 if returned == changed else 0
    problem.passed = t
    if problem.started != 0 and t == problem.t and differ == 0:
        return
    gather(problem)
    copy(last, 0, states, 0, problem.n)
    problem.anew = 1
    problem.settled = 1
    problem.t = t
    problem.t_step = t


def begin_anew(problem: SolverProblem, t: float) -> None:
    """Let the solver forget its history."""
    if problem.started != 0:
        problem.failed += failures(problem)  # the solver starts to count at 0
        follow_slide(problem, last_size(problem))
        again = problem.fresh == 1  # a state is changed at each step: the step before is the best guess
        begin(problem, t, 2.0 * last_size(problem) if again else 0.0)
        problem.restarts += 1
    else:
        begin(problem, t, problem.first_step)
    problem.fresh = 0
    problem.started = 1
    problem.anew = 0
