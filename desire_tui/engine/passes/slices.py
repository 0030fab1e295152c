"""Which statements a pass with given flags must execute (language.md 8.2).

A pass is described by COMM (at a communication point) and STEP (at a step's start). Dead code is left
out (`dead_code`). `Guard` remains for `if` and `sample` only; `out` and `step` are resolved.
"""

from __future__ import annotations

from operator import is_
from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.cancellation import cancellation_point
from desire_tui.engine.lowered.effects import count_draws, expressions, role, timing
from desire_tui.engine.lowered.statements import Deriv, DerivVec, Guard, Set
from desire_tui.engine.lowered.walk import simple_actions, with_bodies
from desire_tui.engine.passes.dead_code import without_dead_code
from desire_tui.engine.passes.final_sample import catch_up, kept_from_step_pass

if TYPE_CHECKING:
    from collections.abc import Iterable

    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.engine.lowered.statements import Action

Actions = tuple["Action", ...]


def full_pass(segment: Segment) -> Actions:
    """COMM and STEP: everything, in order.

    Without `d/dt` OUT code leaves the joint of a continued run out, where it ran in the run before.
    """
    return _resolve(segment.body, comm=True, step=True, joints=segment.order > 0)


def step_slice(segment: Segment) -> Actions:
    """STEP without COMM: the start of a step inside a communication interval."""
    actions = _resolve(segment.body, comm=False, step=True)
    return without_dead_code(actions, kept_from_step_pass(actions))


def derivative_slice(segment: Segment) -> Actions:
    """Neither flag: the later stages of a step."""
    return without_dead_code(_resolve(segment.body, comm=False, step=False))


def inner_slices(segment: Segment) -> tuple[Actions, Actions]:
    """Return `derivative_slice` and `step_slice`, one and the same where nothing is done at steps alone."""
    stage, step = (_resolve(segment.body, comm=False, step=step) for step in (False, True))
    always = kept_from_step_pass(step)
    live = without_dead_code(stage)
    same = not always and len(stage) == len(step) and all(map(is_, stage, step))
    return live, live if same else without_dead_code(step, always)


def without_derivatives(actions: Actions) -> Actions:
    """Leave derivatives out of a pass: a solver computes its own. What draws random numbers stays."""
    kept: list[Action] = []
    for action in actions:
        if isinstance(action, Guard):
            body, orelse = without_derivatives(action.body), without_derivatives(action.orelse)
            kept.append(with_bodies(action, body, orelse))
        elif not isinstance(action, Deriv | DerivVec) or count_draws(*expressions(action)):
            kept.append(action)
    return tuple(kept)


def final_sample_pass(segment: Segment) -> Actions:
    """COMM without STEP, after `term` fired between communication points: see `final_sample`."""
    return catch_up(segment.body, kept_from_step_pass(_resolve(segment.body, comm=False, step=True)))


def jacobian_pass(segment: Segment, stride: int) -> Actions:
    """Return the JACOBIAN segment and what it uses; J[i, k] goes to `slot` + i·stride + k."""
    given = segment.jacobian
    assert given is not None
    definitions = _definitions(_resolve(segment.body, comm=False, step=False))
    where = segment.states[0].where
    entries = tuple(Deriv(number, entry.value, where) for number, entry in enumerate(given.entries))
    helpers = without_dead_code(definitions + given.body + entries)[: -len(entries) or None]
    return helpers + tuple(
        Set(given.slot + entry.row * stride + entry.column, entry.value, where) for entry in given.entries
    )


def acts_at_steps(segment: Segment) -> bool:
    """Whether a pass at a step's start inside an interval does anything but compute derivatives."""
    return not is_pure(_resolve(segment.body, comm=False, step=True))


def is_pure(actions: Actions) -> bool:
    """Whether statements only compute: nothing is remembered, drawn or ended."""
    return all(role(action) != "effect" for action in simple_actions(actions))


def _definitions(actions: Actions) -> Actions:
    kept: list[Action] = []
    for action in actions:
        cancellation_point()
        if isinstance(action, Guard):
            kept.append(with_bodies(action, _definitions(action.body), _definitions(action.orelse)))
        elif role(action) == "definition":
            kept.append(action)
    return tuple(kept)


def _resolve(actions: Iterable[Action], *, comm: bool, step: bool, joints: bool = True) -> Actions:
    """Return what a pass must execute; `joints`: OUT code runs at the joint of two runs too."""
    runs = {"always": True, "point": comm, "step": step}
    kept: list[Action] = []
    for action in actions:
        cancellation_point()
        if not isinstance(action, Guard):
            if runs[timing(action)]:
                kept.append(action)
            continue
        match action.kind:
            case "out" if comm and not joints:
                body = _resolve(action.body, comm=comm, step=step, joints=joints)
                if body:
                    kept.append(Guard("sample", body, action.where))
            case "out" | "step":
                if comm if action.kind == "out" else step:
                    kept.extend(_resolve(action.body, comm=comm, step=step, joints=joints))
            case "if" | "sample":
                if comm or action.kind == "if":
                    body = _resolve(action.body, comm=comm, step=step, joints=joints)
                    orelse = _resolve(action.orelse, comm=comm, step=step, joints=joints)
                    if body or orelse:
                        kept.append(with_bodies(action, body, orelse))
            case _:
                assert_never(action.kind)
    return tuple(kept)
