"""What is around the passes in the C file: numbers, sums of derivatives, samples, the run, `main`."""

from __future__ import annotations

from textwrap import dedent
from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass
from desire_tui.export.c import rule as steps
from desire_tui.export.c.expressions import number

if TYPE_CHECKING:
    from desire_tui.engine.integration.tableaus import Tableau
    from desire_tui.export.c.layout import Layout
    from desire_tui.export.run import ExportedRun

_NUMBERS_A_LINE = 6


@dataclass(frozen=True)
class ModelParts:
    """What the file is made of, besides its passes. `used`: what of the library is called."""

    run: ExportedRun
    rule: int
    tableau: Tableau | None
    layout: Layout
    used: frozenset[str]
    slots: tuple[int, ...]
    checked: int
    renews: bool
    counters: int

    @property
    def has_variable_steps(self) -> bool:
        """Whether the rule controls its step."""
        return self.tableau is not None and self.tableau.variable

    def heading(self) -> str:
        """Return the comment and the includes."""
        plan = self.run.plan
        step = f"DT = {plan.dt:g}" if not self.has_variable_steps else f"ERMAX = {plan.error_max:g}"
        name = self.run.source.file_name.replace("*/", "* /")
        samples = f"{plan.nn} samples from t = {plan.t0:g} on"
        return dedent(f"""\
            /* {name}: irule {self.rule}, {step}, {samples}.
             *
             * Made by Desire (desire export --c). Compile: cc -std=c99 -O2 -ffp-contract=off FILE.c -lm
             * The program writes the samples as CSV; exit status 0: it came to its end, 1: it did not.
             */
            #include <math.h>
            #include <stdint.h>
            #include <stdio.h>
            """)

    def state_of_run(self) -> str:
        """Return the numbers at the start, what is constant in the run, the run's variables."""
        plan, layout = self.run.plan, self.layout
        numbers = [number(value) for value in layout.initial()]
        lines = [", ".join(numbers[k : k + _NUMBERS_A_LINE]) for k in range(0, len(numbers), _NUMBERS_A_LINE)]
        table = ",\n    ".join(lines)
        given = {
            "START": number(plan.t0), "SPAN": number(plan.t_max), "COMINT": number(plan.comint),
            "POINTS": str(plan.nn), "EVERY": str(plan.every), "ORDER": str(len(self.slots)),
        }  # fmt: skip
        if self.tableau is not None and self.tableau.variable:
            given |= {
                "DT_MAX": number(plan.dt_max), "DT_MIN": number(plan.dt_min),
                "ERROR_MAX": number(plan.error_max), "ERROR_MIN": number(plan.error_min),
                "ERROR_ONE": number(plan.error_one), "CHECKED": str(self.checked),
            }  # fmt: skip
        parts = [
            f"static double v[{layout.size}] = {{\n    {table}\n}};",
            *(f"#define {k} {t}" for k, t in given.items()),
            "",
        ]
        if "counters" in self.used:
            parts.append(f"static long counters[{max(self.counters, 1)}];")
        if {"ran", "gauss"} & self.used:
            parts.append(f"static uint64_t random_state = {self.run.random}u;")
        parts.append("static long point;\nstatic int fired = -1;")
        if self.tableau is None:
            parts.append("static double *const dx = 0;\n")
            return "\n".join(parts)
        parts.append(f"static double k[{self.tableau.stages}][ORDER];")
        if not self.tableau.variable:
            parts.append(
                f"static long step_count;\nstatic double t_base = START, dt_base = {number(plan.dt)};"
            )
        else:
            parts.append("static int still_count;")
        if self.renews:
            parts.append("static double late_dt;\nstatic long late_hold;")
        parts.append("enum { REACHED, INSIDE, ENDED, NOT_FINITE, DEADLOCK, STALLED };\n")
        return "\n".join(parts)

    def integration(self) -> str:
        """Return what moves states: sums of derivatives, the step."""
        tableau = self.tableau
        if tableau is None:
            return ""
        offsets = ", ".join(str(self.layout.offset(slot, 1)) for slot in self.slots)
        parts = [dedent(f"""\
            static const int place_of[ORDER] = {{ {offsets} }};

            static void get_states(double *x)
            {{
                for (int i = 0; i < ORDER; i++)
                    x[i] = v[place_of[i]];
            }}

            static void set_states(const double *x0, double h, double (*row)(int))
            {{
                for (int i = 0; i < ORDER; i++)
                    v[place_of[i]] = x0[i] + h * row(i);
            }}

            static int is_finite(void)
            {{
                for (int i = 0; i < ORDER; i++)
                    if (!isfinite(v[place_of[i]]))
                        return 0;
                return 1;
            }}
            """), steps.rows(tableau, renews=self.renews)]  # fmt: skip
        if tableau.variable:
            parts.append(steps.DIFFERENCE)
            if self.renews:
                parts.append(steps.renewal_in_interval())
            parts.append(steps.variable_step(tableau, renews=self.renews))
        else:
            parts.append(steps.fixed_step(tableau))
        return "\n".join(parts)

    def loop(self) -> str:
        """Return the run: communication points, and steps between them."""
        renew = "            renewal_pass(k[0]);\n" if self.has_variable_steps else ""
        late = "                renew_in_interval();\n" if self.renews else ""
        look = "1" if self.has_variable_steps else "++looked % 1024 == 0"
        return f"""/* Communication points, and steps between them. */
    static int run(void)
    {{
        long looked = 0;
        int came;
        (void)looked;
        for (;;) {{
            int is_last;
            if (point && !is_finite())
                return NOT_FINITE;
            fired = -1;
            full_pass(k[0]);
            is_last = fired >= 0 || q_t >= START + SPAN - 1e-9 * q_DT;
            if (is_last || point % EVERY == 0)
                sample();
            point++;
            if (is_last)
                return ENDED;
            {{
                const double t_next = START + (double)point * COMINT;
    {renew}            while ((came = step(t_next)) == INSIDE) {{
                    if (({look}) && !is_finite())
                        return NOT_FINITE;
                    fired = -1;
                    step_pass(k[0]);
                    if (fired >= 0) {{
                        final_pass(k[0]);
                        sample();
                        return ENDED;
                    }}
    {late}            }}
                if (came != REACHED)
                    return came;
            }}
        }}
    }}
    """


def sample(columns: list[tuple[str, str]]) -> str:
    """Return what writes the first line and a sample."""
    heads = ",".join(["t", *(name for name, _ in columns)])
    quoted = heads.replace("\\", "\\\\").replace('"', '\\"')
    values = "".join(f",\n           {place}" for _, place in columns)
    formats = ",".join(["%.17g"] * (1 + len(columns)))
    return dedent(f"""\
        static void heading(void)
        {{
            puts("{quoted}");
        }}

        static void sample(void)
        {{
            printf("{formats}\\n", q_t{values});
        }}
        """)


LOOP_OF_POINTS = """/* Communication points; nothing is integrated. */
enum { ENDED };

static int run(void)
{
    for (;;) {
        int is_last;
        fired = -1;
        full_pass(dx);
        is_last = fired >= 0 || point >= POINTS - 1;
        if (is_last || point % EVERY == 0)
            sample();
        point++;
        if (is_last)
            return ENDED;
        q_t = START + (double)point * COMINT;
    }
}
"""

MAIN = """#ifndef DESIRE_LIBRARY
int main(void)
{
    heading();
    if (run() != ENDED) {
        fprintf(stderr, "the run ended at t = %g: a state is no number, or steps became too small\\n", q_t);
        return 1;
    }
    return 0;
}
#endif
"""
