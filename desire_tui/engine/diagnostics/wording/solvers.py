"""Messages of the stiff rules: CVODE, Jacobians."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

_AT = "at t = {t:.6g} with DT = {dt:.3g}, state '{state}'"

MESSAGES: dict[str, Wording] = {
    "solver-missing": Wording(
        460,
        "rules 9 to 13 and 16 need the SUNDIALS library, which could not be loaded: {reason}",
        "install scikit-sundae 1.2.0, or use rules 14, 15 (stiff systems) or 0 to 8, which need nothing",
        "Rules 9 to 13 and 16 are SUNDIALS' own. Where it is missing, because scikit-sundae has no"
        " package for the machine (Linux on ARM), rules 14 and 15 run on a solver of this program, with a"
        " dense matrix.",
    ),
    "solver-version": Wording(
        461,
        "rules 9 to 13 and 16 need SUNDIALS {wanted}, found {found}",
        "install scikit-sundae 1.2.0, or use rules 14, 15 (stiff systems) or 0 to 8, which need nothing",
    ),
    "no-series": Wording(
        540,
        "rule 17 follows Taylor series, and {what} has none",
        "use {instead}",
        "Rule 17 derives the solution's Taylor series from the equations. Kinks, relations, `if` and tables"
        " of one argument are taken apart at the places where they switch; what is drawn at random, delayed"
        " or remembered from the pass before has no series.",
    ),
    "solver-gave-up": Wording(
        220,
        f"rule {{rule}} got nowhere {_AT}",
        "a pole, or a division by what falls to 0: end the run by `term` before it; or try another rule",
    ),
    "solver-too-accurate": Wording(
        221,
        f"rule {{rule}} cannot reach this accuracy {_AT}",
        "make ERMAX larger: doubles carry about 16 digits",
    ),
    "solver-error-test": Wording(
        222,
        f"the error test of rule {{rule}} failed again and again {_AT}",
        "look for a pole, which `term` can stop at, and for random numbers or a relay in the right-hand side",
        "Stop the run with `term` before a solution that grows without bound. A relay that holds a"
        " solution on its jump needs a dead zone; noise belongs behind `step` or `SAMPLE`.",
    ),
    "solver-corrector": Wording(
        223,
        f"the corrector of rule {{rule}} did not converge {_AT}",
        "rules 13 to 15 suit stiff problems; look at the JACOBIAN segment if there is one, try a smaller DT",
    ),
    "solver-corrector-part": Wording(
        223,
        "the corrector of rule {rule} did not converge: '{part}' is {cause} at t = {t:.6g}",
        "{advice}; the samples before are kept",
    ),
    "solver-derivative-part": Wording(
        226,
        "a derivative is not a number: '{part}' is {cause} at t = {t:.6g}",
        "{advice}; the samples before are kept",
    ),
    "solver-singular": Wording(
        224,
        f"rule {{rule}} met a singular matrix {_AT}",
        "look at the JACOBIAN segment, or use rule 15, which finds the matrix itself",
    ),
    "solver-linear": Wording(
        225,
        f"the linear equations of rule {{rule}} could not be solved {_AT}",
        "look at the JACOBIAN segment, or use rule 15, which finds the matrix itself",
    ),
    "solver-derivative": Wording(
        226,
        f"a derivative is not a number {_AT}",
        "look for a division by zero, a root or logarithm of a negative number, or an overflow",
    ),
    "solver-too-close": Wording(
        227,
        f"rule {{rule}} cannot make a step that small {_AT}",
        "COMINT or DT is too small compared with t",
    ),
    "solver-broken": Wording(
        228,
        f"rule {{rule}} stopped with SUNDIALS' flag {{flag}} {_AT}",
    ),
    "jacobian-missing": Wording(
        229,
        "the segment's JACOBIAN assigns no element of an array",
        "declare `ARRAY J[{n},{n}]` in the script and assign J[i,k] after JACOBIAN",
    ),
    "jacobian-shape": Wording(
        230,
        "'{name}' must be {n} by {n} for {n} state(s), but it is {shape}",
        "states count in the order of their d/dt lines, a vector state by its elements",
    ),
    "jacobian-wrong": Wording(
        462,
        "J[{row},{column}] is {given:.6g} but the derivative of d/dt {state} by {by} is {found:.6g} here",
        "states count in the order of their d/dt lines; rule 15 needs no JACOBIAN",
        warning=True,
    ),
    "jacobian-differs": Wording(
        462,
        "J[{row},{column}] is {given:.6g} but the derivative of d/dt {state} by {by} is {exact:.6g}"
        " at {place}",
        "states count in the order of their d/dt lines; without JACOBIAN rule 14 finds its elements itself",
        warning=True,
    ),
    "corrector-slow": Wording(
        496,
        "rule {rule} tried in vain {rejected:,} times in {steps:,} steps: its corrector did not converge",
        "a stiff model: use rule 14, which may need a hundredth of them; else look for a relay or a jump",
        "A warning, given once. Rules 9 and 13 substitute, 12 and 16 keep the diagonal: that converges"
        " only while steps are short beside the fastest of the couplings, long after anything moves so"
        " fast.",
        warning=True,
    ),
    "jacobian-not-diagonal": Wording(
        463,
        "rule {rule} keeps only the Jacobian's diagonal, but it is far from diagonal: results may be wrong",
        "use rule {better}, or compare with it",
        warning=True,
    ),
}
