"""What `glue.c` asks of a run, in C: a pass for what is stale, steps to a time, all as at the start."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.lowered.effects import count_draws, expressions
from desire_tui.engine.lowered.statements import Assignment, Guard
from desire_tui.engine.lowered.walk import simple_actions, walk_actions
from desire_tui.engine.passes.slices import full_pass, is_pure
from desire_tui.export.c.expressions import number

if TYPE_CHECKING:
    from desire_tui.engine.lowered.segment import Segment
    from desire_tui.export.c.model_file import ModelFile

_WITHOUT_STATES = """static double *state(size_t i)
{
    (void)i;
    return v;
}

static double derivative(size_t i)
{
    (void)i;
    return 0.0;
}

static int run_to(double t_next)
{
    q_t = t_next;
    begin_point();
    return fired >= 0;
}
"""
_STATES = """static double *state(size_t i)
{
    return v + place_of[i];
}

static double derivative(size_t i)
{
    return k[0][i];
}
"""


def is_continuous(segment: Segment) -> bool:
    """Whether a pass only computes, as model exchange wants: it remembers, draws and ends nothing."""
    actions = full_pass(segment)
    return (
        segment.order > 0
        and is_pure(actions)
        and not any(isinstance(a, Guard) and a.kind == "sample" for a in walk_actions(actions))
        and not any(isinstance(a, Assignment) and a.persistent for a in simple_actions(actions))
        and not any(count_draws(*expressions(a)) for a in simple_actions(actions))
    )


def hooks(file: ModelFile, token: str) -> str:
    """Return the functions, to stand behind the file's text."""
    stage = "k[0]" if file.tableau is not None else "dx"
    pure = is_continuous(file.run.segment) or file.tableau is None
    compute = f"full_pass({stage});" if pure else f"derivative_pass({stage});"
    lines = [
        f'#define TOKEN "{token}"',
        "",
        f"static void compute_pass(void)\n{{\n    {compute}\n}}",
        "",
        f"static void begin_point(void)\n{{\n    fired = -1;\n    full_pass({stage});\n    point++;\n}}",
        "",
        f"static void reset_run(void)\n{{\n{_reset(file)}}}",
        "",
    ]
    if file.tableau is None:
        return "\n".join([*lines, _WITHOUT_STATES])
    return "\n".join([*lines, _STATES, _run_to(file)])


def _reset(file: ModelFile) -> str:
    used = file.statements.used
    lines = []
    if file.tableau is not None and not file.has_variable_steps:
        lines += ["step_count = 0;", "t_base = START;", f"dt_base = {number(file.run.plan.dt)};"]
    elif file.tableau is not None:
        lines.append("still_count = 0;")
    if "counters" in used:
        lines.append("memset(counters, 0, sizeof counters);")
    if {"ran", "gauss"} & used:
        lines.append(f"random_state = {file.run.random}u;")
    if file.renews:
        lines.append("late_dt = 0.0, late_hold = 0;")
    return "".join(f"    {line}\n" for line in lines)


def _run_to(file: ModelFile) -> str:
    """Return the function that steps to a time; fixed steps are made shorter so that one ends there."""
    fixed = f"""    const double span = t_next - q_t, count = ceil(span / {number(file.run.plan.dt)} - 1e-9);
    t_base = q_t;
    dt_base = q_DT = span / (count > 1.0 ? count : 1.0);
    step_count = 0;
"""
    late = "        renew_in_interval();\n" if file.renews else ""
    return f"""static int run_to(double t_next)
{{
    int came;
{"" if file.has_variable_steps else fixed}    derivative_pass(k[0]);
    while ((came = step(t_next)) == INSIDE) {{
        if (!is_finite())
            return -1;
        fired = -1;
        step_pass(k[0]);
        if (fired >= 0) {{
            final_pass(k[0]);
            return 1;
        }}
{late}    }}
    if (came != REACHED || !is_finite())
        return -1;
    q_t = t_next;
    begin_point();
    return fired >= 0;
}}
"""
