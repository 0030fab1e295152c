"""The explicit rules in C: one step from t, written from the rows of `integration.tableaus`."""

from __future__ import annotations

from textwrap import indent
from typing import TYPE_CHECKING

from desire_tui.engine.integration.tableaus import CHANGE, LATE_HOLD, LATE_PARTS, STILL_MOST, whole_multiples
from desire_tui.export.c.expressions import number

if TYPE_CHECKING:
    from desire_tui.engine.integration.tableaus import Row, Tableau

_STEP = "    "


def move(row: Row, h: str) -> str:
    """Return the statement that puts states to x0 + h * the sum of a row's multiples of derivatives."""
    denominator, _ = whole_multiples(row)
    part = h if denominator == 1 else f"{h} / {number(float(denominator))}"
    return f"set_states(x0, {part}, {_row_name(row)});"


def _row_name(row: Row) -> str:
    return "row_" + "_".join(str(n).replace("-", "m") for n in whole_multiples(row)[1]) if row else "row_0"


def rows(tableau: Tableau, *, renews: bool) -> str:
    """Return the functions that add up derivatives, one for each row."""
    wanted = [
        *tableau.a[1:],
        tableau.b,
        *([tableau.test] if tableau.test else []),
        *([CHANGE] if renews else []),
    ]
    found: dict[str, str] = {}
    for row in wanted:
        terms = []
        for stage, multiple in enumerate(whole_multiples(row)[1]):
            if multiple == 0:
                continue
            k = f"k[{stage}][i]"
            terms.append(
                k if multiple == 1 else f"-{k}" if multiple == -1 else f"{number(float(multiple))} * {k}"
            )
        found[_row_name(row)] = (
            f"static double {_row_name(row)}(int i)\n{{\n    return {' + '.join(terms)};\n}}\n"
        )
    return "\n".join(found.values())


def stages(tableau: Tableau, time: str) -> str:
    """Return the passes behind the first; `time` is the text of a stage's time with `{c}`."""
    lines = []
    for stage in range(1, tableau.stages):
        lines += [
            move(tableau.a[stage], "h"),
            f"q_t = {time.format(c=number(float(tableau.c[stage])))};",
            f"derivative_pass(k[{stage}]);",
        ]
    return "\n".join(lines)


def fixed_step(tableau: Tableau) -> str:
    """Return the function that makes a step of DT, and tells whether it has reached the next point."""
    change = ""
    if tableau.rule.dt_may_change:
        change = """if (q_DT != dt_base) {
    if (!(q_t + q_DT > q_t))
        return STALLED;
    t_base = q_t;
    dt_base = q_DT;
    step_count = 0;
}
"""
    body = f"""{change}const double h = dt_base;
double x0[ORDER];
get_states(x0);
{stages(tableau, "t_base + ((double)step_count + {c}) * h")}
{move(tableau.b, "h")}
step_count++;
q_t = t_base + (double)step_count * h;
return q_t >= t_next - 1e-9 * h ? REACHED : INSIDE;"""
    return f"static int step(double t_next)\n{{\n{indent(body, _STEP)}\n}}\n"


def variable_step(tableau: Tableau, *, renews: bool) -> str:
    """Return the function that tries, judges, halves or doubles a step."""
    assert tableau.test is not None
    held = f"""const int held = late_hold > 0;
late_hold = late_hold > 0 ? late_hold - 1 : 0;
if (error < ERROR_MIN && !cut && !held) {{
    if (2.0 * q_DT < late_dt)
        late_hold = {LATE_HOLD};
    else
        late_dt = 0.0;
    q_DT = 2.0 * q_DT < DT_MAX ? 2.0 * q_DT : DT_MAX;
}}"""
    plain = "if (error < ERROR_MIN && !cut)\n    q_DT = 2.0 * q_DT < DT_MAX ? 2.0 * q_DT : DT_MAX;"
    body = f"""const double here = q_t, left = t_next - here;
const int cut = q_DT > left * (1.0 + 1e-9);
int lands = q_DT >= left * (1.0 - 1e-9), is_first = 1;
double h = lands ? left : q_DT, error, x0[ORDER];
get_states(x0);
for (;;) {{
{indent(stages(tableau, "here + {c} * h"), _STEP)}
    error = difference(x0, h / {number(float(whole_multiples(tableau.test)[0]))}, {_row_name(tableau.test)});
    if (!(error > ERROR_MAX))
        break;
    h = 0.5 * h;
    if (h < DT_MIN) {{
        set_states(x0, 0.0, {_row_name(tableau.test)});
        q_t = here;
        q_ERRMAX = error;
        return DEADLOCK;
    }}
    q_DT = h;
    lands = is_first = 0;
}}
still_count = lands || here + h > here ? 0 : still_count + 1;
if (still_count >= {STILL_MOST} || !(lands || h > 0.0))
    return STALLED;
{move(tableau.b, "h")}
q_t = lands ? t_next : here + h;
{held if renews else plain}
return lands ? REACHED : INSIDE;"""
    body = body.replace("&& !cut", "&& !(cut && is_first)")
    return f"static int step(double t_next)\n{{\n{indent(body, _STEP)}\n}}\n"


def renewal_in_interval() -> str:
    """Return the function that makes the first derivative anew behind a step's start."""
    body = f"""double x0[ORDER], change, least, wanted;
get_states(x0);
for (int i = 0; i < ORDER; i++)
    k[1][i] = k[0][i];
step_renewal_pass(k[0]);
change = difference(x0, q_DT, {_row_name(CHANGE)});
if (change > ERROR_MAX) {{
    least = SPAN / {number(float(LATE_PARTS))} < q_DT ? SPAN / {number(float(LATE_PARTS))} : q_DT;
    wanted = q_DT * (ERROR_MAX / change);
    late_dt = q_DT > late_dt ? q_DT : late_dt;
    q_DT = wanted < least ? least : wanted;
    late_hold = {LATE_HOLD};
}}"""
    return f"static void renew_in_interval(void)\n{{\n{indent(body, _STEP)}\n}}\n"


DIFFERENCE = """/* The largest test difference, relative to |x| + 1; with CHECKN that state's, absolute. */
static double difference(const double *x0, double h, double (*row)(int))
{
    double largest = 0.0;
    int i;
    if (CHECKED > ORDER)
        return 0.0;
    if (CHECKED) {
        const double d = fabs(h * row(CHECKED - 1));
        return isnan(d) ? 0.0 : d;
    }
    for (i = 0; i < ORDER; i++) {
        const double d = fabs(h * row(i)) / (fabs(x0[i]) + ERROR_ONE);
        if (d > largest)
            largest = d;
    }
    return largest;
}
"""
