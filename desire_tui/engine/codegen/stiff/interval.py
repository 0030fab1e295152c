"""`…_interval`: one communication interval under a rule 9 … 16, step by step, without Python.

    int32 cvode_interval(Problem*, RunMemory*, double t_next, int32 passed)

starts from t and the states in the values and comes back with `Ended.RUNNING` once t is `t_next`; with
STOPPED where `stop` was set; TERM with the statement's number in `which`; SOLVER with CVODE's flag in
`which`. `passed` is 1 if the pass at the first step's start has been done (it always is at a communication
point), 0 to go on inside an interval.

`own_interval` does the same with the other of the two `steppers`. They keep a history of the solution and
begin anew where the states in the values are not what they left there: at a run's start, where
difference-equation code changed one, where the user did.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from desire_tui.engine.codegen.stiff.callbacks import scatter
from desire_tui.engine.codegen.stiff.ir_builder import INT, INT32, POINTER, REAL, VOID, FixedFunction
from desire_tui.engine.integration.problem import (
    CHATTER_FLAG,
    CHATTER_PART,
    CHATTER_STEPS,
    STUCK_AT_EDGE_FLAG,
    STUCK_FLAG,
    STUCK_MOST,
)
from desire_tui.engine.integration.sundials.signatures import TSTOP_RETURN
from desire_tui.engine.runtime.run_memory import Ended, RunMemory
from desire_tui.engine.values import DT, T

if TYPE_CHECKING:
    from desire_tui.engine.codegen.stiff.steppers import Stepper


def add_interval(module: Any, stepper: Stepper) -> None:
    """Add the interval of a stepper to a module that has the callbacks and `desire_gather`."""
    _add_sync(module, stepper)
    _add_interval(module, stepper)


def add_gather(module: Any) -> None:
    """Add `desire_gather`: copy the states' values to the solver's vector."""
    f = FixedFunction(module, "desire_gather", VOID, [POINTER])
    (problem,) = f.arguments
    values, ranges, states = (f.get(problem, name) for name in ("values", "ranges", "states"))
    with f.loop(INT(0), f.get(problem, "range_count")) as i:
        at = f.build.mul(i, INT(3))
        slot, first, count = (f.load(ranges, f.build.add(at, INT(k)), INT) for k in range(3))
        f.copy(f.at(states, first), f.at(values, slot), f.build.mul(count, INT(8)))
    f.build.ret_void()


def _add_sync(module: Any, stepper: Stepper) -> None:
    """Begin anew if t or a state is not what the solver left."""
    f = FixedFunction(module, f"{stepper.prefix}_sync", VOID, [POINTER])
    (problem,) = f.arguments
    f.outside("desire_gather", VOID, [problem])
    states, last = f.get(problem, "states"), f.get(problem, "last")
    t = f.load(f.get(problem, "values"), INT(T))
    differ = f.build.alloca(INT)
    same_t = f.build.fcmp_ordered("==", t, f.get(problem, "t"))
    going = f.build.icmp_signed("!=", f.get(problem, "started"), INT(0))
    f.build.store(f.build.select(f.build.and_(same_t, going), INT(0), INT(1)), differ)
    with f.loop(INT(0), f.get(problem, "n")) as i:
        other = f.build.fcmp_unordered("!=", f.load(states, i), f.load(last, i))
        f.build.store(f.build.or_(f.build.load(differ, typ=INT), f.build.zext(other, INT)), differ)
    with f.build.if_then(f.build.icmp_signed("==", f.build.load(differ, typ=INT), INT(0)), likely=True):
        f.build.ret_void()
    f.add(problem, "failed", stepper.failed(f, problem))  # the solver starts to count at 0
    with f.build.if_else(going) as (again, first):
        with again:  # no step size is left to trust: the solver looks for one
            stepper.restart(f, problem, t, REAL(0.0))
            f.add(problem, "restarts", INT(1))
        with first:
            stepper.restart(f, problem, t, f.get(problem, "first_step"))
    f.put(problem, "started", INT(1))
    f.put(problem, "t", t)
    f.build.ret_void()


def _add_interval(module: Any, stepper: Stepper) -> None:
    f = FixedFunction(module, f"{stepper.prefix}_interval", INT32, [POINTER, POINTER, REAL, INT32])
    problem, memory, t_next, passed = f.arguments
    build = f.build
    values, states, last = (f.get(problem, name) for name in ("values", "states", "last"))
    step = f.get(problem, "step")
    bytes_ = build.mul(f.get(problem, "n"), INT(8))
    reached = build.alloca(REAL)
    start, again, go = (f.function.append_basic_block(name) for name in ("start", "again", "go"))

    f.outside(f"{stepper.prefix}_sync", VOID, [problem])
    build.cbranch(build.icmp_signed("!=", passed, INT32(0)), go, start)

    build.position_at_end(start)  # pass(-, STEP) at a step's start
    build.cbranch(build.icmp_unsigned("==", build.ptrtoint(step, INT), INT(0)), go, again)
    build.position_at_end(again)
    fired = f.call(step, INT, [memory, states])
    with build.if_then(build.icmp_signed("!=", fired, INT(0)), likely=False):
        f.put(memory, "which", build.sub(fired, INT(1)), RunMemory)
        build.ret(INT32(Ended.TERM.value))
    f.outside(f"{stepper.prefix}_sync", VOID, [problem])
    build.branch(go)

    build.position_at_end(go)
    moving = build.icmp_signed("==", f.get(problem, "stuck"), INT(0))
    f.put(problem, "suspect", build.select(moving, INT(-1), f.get(problem, "suspect")))
    flag = stepper.step(f, problem, t_next, reached)
    t = build.load(reached, typ=REAL)
    done = build.or_(build.icmp_signed("==", flag, INT32(TSTOP_RETURN)), build.fcmp_ordered(">=", t, t_next))
    t = build.select(done, t_next, t)
    flag = _watch_chatter(f, stepper, (problem, memory), t, _watch_progress(f, problem, t, flag))
    f.store(values, INT(T), t)
    f.put(problem, "t", t)
    scatter(f, problem, states)
    f.copy(last, states, bytes_)
    with build.if_then(build.icmp_signed("<", flag, INT32(0)), likely=False):
        f.put(memory, "which", build.sext(flag, INT), RunMemory)
        build.ret(INT32(Ended.SOLVER.value))
    dt = stepper.last_step(f, problem)
    f.store(values, INT(DT), dt)
    _record_step(f, memory, dt)
    with build.if_then(done):
        build.ret(INT32(Ended.RUNNING.value))
    stop = build.icmp_signed("!=", f.get(memory, "stop", RunMemory), INT32(0))
    with build.if_then(stop, likely=False):
        build.ret(INT32(Ended.STOPPED.value))
    build.branch(start)


def _watch_progress(f: FixedFunction, problem: Any, t: Any, flag: Any) -> Any:
    """Count steps that do not change t; too many of them make a failure of a success."""
    same = f.build.fcmp_ordered("==", t, f.get(problem, "t"))
    stuck = f.build.select(same, f.build.add(f.get(problem, "stuck"), INT(1)), INT(0))
    f.put(problem, "stuck", stuck)
    hopeless = f.build.icmp_signed(">", stuck, INT(STUCK_MOST))
    edge = f.build.icmp_signed(">=", f.get(problem, "suspect"), INT(0))
    reason = f.build.select(edge, INT32(STUCK_AT_EDGE_FLAG), INT32(STUCK_FLAG))
    return f.build.select(hopeless, reason, flag)


def _watch_chatter(f: FixedFunction, stepper: Stepper, run: tuple[Any, Any], t: Any, flag: Any) -> Any:
    """Make a failure of steps that fail about as often as they succeed and get nowhere."""
    build, (problem, memory) = f.build, run
    with build.goto_entry_block():  # this stands in a loop: an alloca here would eat the stack
        result = build.alloca(INT32)
    build.store(flag, result)
    steps = build.add(f.get(problem, "watch_steps"), INT(1))
    f.put(problem, "watch_steps", steps)
    with build.if_then(build.icmp_signed(">=", steps, INT(CHATTER_STEPS)), likely=False):
        failed = build.add(stepper.failed(f, problem), f.get(problem, "failed"))
        often = build.sub(failed, f.get(problem, "watch_failed"))
        far = build.fmul(f.get(memory, "comint", RunMemory), REAL(CHATTER_PART))
        near = build.fcmp_ordered("<", build.fsub(t, f.get(problem, "watch_t")), far)
        chatter = build.and_(near, build.icmp_signed(">=", often, INT(CHATTER_STEPS // 2)))
        good = build.icmp_signed(">=", flag, INT32(0))
        build.store(build.select(build.and_(chatter, good), INT32(CHATTER_FLAG), flag), result)
        f.put(problem, "watch_t", t)
        f.put(problem, "watch_failed", failed)
        f.put(problem, "watch_steps", INT(0))
    return build.load(result, typ=INT32)


def _record_step(f: FixedFunction, memory: Any, dt: Any) -> None:
    first = f.build.icmp_signed("==", f.get(memory, "steps", RunMemory), INT(0))
    f.add(memory, "steps", INT(1), RunMemory)
    for field, better in (("dt_least", "<"), ("dt_most", ">")):
        known = f.get(memory, field, RunMemory)
        other = f.build.fcmp_ordered(better, dt, known)
        f.put(memory, field, f.build.select(f.build.or_(first, other), dt, known), RunMemory)
