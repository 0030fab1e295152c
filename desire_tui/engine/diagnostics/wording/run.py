"""Messages of the run stage."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

_TMAX_PAGE = """A run lasts from t0 to t0 + TMAX. A segment with `d/dt` lines has no natural length: the
script must say it:

```desire
TMAX = 10 | DT = 0.01 | NN = 501
drun
```

Only segments without `d/dt` choose TMAX = NN - 1 by themselves."""

_FAULT_PAGE = """The run ended because a number became infinite or undefined. Everything up to that time was
kept: look at the curves. Usual causes: a division by zero, the square root or logarithm of a negative number,
a step DT too large for the rule (try a quarter of it, or `irule 4`), or a model whose solution really grows
without bound (stop it with `term`)."""

_LEARNING_HINT = "declare it: ARRAY y[n], h[n] with y the output; or use a criterion below 0"

_LEARNING_MORE = """With a criterion of 0 CLEARN multiplies the distance of each row by its element of h,
where the program counts wins (`Vectr delta h = y`); above 0 it marks committed rows there. h is the vector
that stands right after the output in the declarations, of the same length. With a criterion below 0 none
is needed."""

MESSAGES: dict[str, Wording] = {
    "tmax-missing": Wording(
        87,
        "TMAX is not set: how long shall the run last?",
        "set it before drun, for instance TMAX = 10",
        _TMAX_PAGE,
    ),
    "measured-apart": Wording(
        536,
        "no time of '{y}' is one of '{x}' too: points of both need values at the same times",
        "take two columns of one file",
    ),
    "measured-outside-run": Wording(
        537,
        "no point of '{name}' is drawn: it was measured from t = {first:g} to {last:g}, and the run goes "
        "from {begin:g} to {end:g}",
        "set t and TMAX so that the run covers the data, or shift their times",
        warning=True,
    ),
    "tmax-zero": Wording(
        87,
        "TMAX = {value:g}, but a run must last some time",
        "set TMAX to a number above 0, or below 0 to go backward in time",
        _TMAX_PAGE,
    ),
    "tolerance-negative": Wording(
        87, "{name} = {value:g} is no tolerance", "set {name} to 0 or above, or leave it out"
    ),
    "setting-not-positive": Wording(
        87,
        "{name} = {value:g} is not above 0, so that a run takes {taken:g}",
        "set {name} above 0, or leave it out",
        "A warning: the run goes on with what holds where the setting was never made. Settings never made"
        " read as 0, so that `DT = TMAX/(NN - 1)` in front of `NN = …` gives such a DT. A step that becomes 0"
        " or less *while a run goes on* is an error.",
        warning=True,
    ),
    "setting-not-finite": Wording(
        87, "{name} = {value:g} is no number for a run", "set {name} above 0, or leave it out"
    ),
    "setting-uncountable": Wording(
        87, "{name} = {value:g} is not a number of samples", "numbers of samples end at {most:g}"
    ),
    "time-unresolved": Wording(
        87,
        "t = {t:g} is too large for steps of {dt:.3g}: numbers near it are {gap:.3g} apart",
        "start at a smaller t, or make DT larger",
        "Numbers have 16 digits. A step that moves t by less than the last of them gives wrong times.",
    ),
    "table-falling": Wording(
        44,
        "breakpoint {place} of '{name}' is {value:g}, after {before:g}",
        "breakpoints must not fall from one to the next",
        "`func1` takes breakpoints from the first half of its table, values from the second.",
    ),
    "ermax-missing": Wording(
        87,
        "rule {rule} needs an error bound, but ERMAX is not set: a run takes {taken:g}",
        "set it before drun, for instance ERMAX = 1.0E-06",
        "This is a warning. 0.001 is coarse for most models.",
        warning=True,
    ),
    "checkn-out-of-range": Wording(
        93,
        "CHECKN = {value:g}, but the segment has states 1 to {order}",
        "CHECKN = 0 checks the relative error of all states",
    ),
    "dt-above-comint": Wording(
        110,
        "DT = {dt:g} is larger than COMINT = TMAX/(NN-1) = {comint:g}",
        "make DT or NN smaller, or leave out DT",
        "Samples are taken every COMINT; a step may not jump over one. Make DT a whole fraction of COMINT.",
    ),
    "variable-step-deadlock": Wording(
        94,
        "variable-step deadlock at t = {t:.6g}: state '{state}' differs by {difference:.3g} > ERMAX ="
        " {ermax:g} even with DT = {dt:.3g}",
        "make DTMIN smaller or ERMAX larger; end the run by `term` before a pole",
        "Rules 4, 7 and 8 halve DT until the test difference is below ERMAX, but never below DTMIN (DT/65536"
        " if it is not set). The difference that could not be reduced is in ERRMAX.",
    ),
    "time-stalled": Wording(
        87,
        "t stays at {t:.6g}: a step of DT = {dt:.3g} does not go forward",
        "DT must stay above 0, and large enough to change t",
    ),
    "time-stalled-by-state": Wording(
        87,
        "t stays at {t:.6g}: steps of DT = {dt:.3g}, which state '{state}' asks for, do not go forward",
        "a pole (end the run by `term` before it), a jump, or noise in its derivative; or ERMAX is too small",
    ),
    "no-headway": Wording(
        495,
        "rule {rule} makes no headway: t = {t:.6g} with DT = {dt:.3g} after {steps:,} steps, and {why};"
        " state '{state}' moves most",
        "{advice}",
        "The samples before are kept. Such a run would go on for hours or days.",
    ),
    "switch-chatters": Wording(
        477,
        "'{name}' switches to and fro at t = {t:.6g} with DT = {dt:.3g} and holds {held} up",
        "chatter: the solution slides along the switch, or events pile up: give it a dead zone or hysteresis",
    ),
    "noise-in-step": Wording(
        489,
        "a derivative depends on this random number, which is drawn anew at each stage of a step",
        "draw it behind `step`, SAMPLE or `every`, or use white(…): its size fits DT",
        "A warning: another DT is another process. Rules 4 and 7 to 16 cannot be used.",
        warning=True,
    ),
    "delay-backward": Wording(
        483,
        "a run backward does not know x at t - tau: it has yet to come to that earlier time",
        "run forward, with TMAX above 0. Backward, tau must be a constant of 0 or less: "
        "delay(x, -1) is x at t + 1, where the run has been",
    ),
    "events-too-fast": Wording(
        486,
        "this event came many times in hardly any time, at t = {t:.9g}",
        "let it rest: set it still in the block when it is slow, or stop the run by `term`",
        "Each time sets off the next one after a shorter while (a ball that bounces lower and lower), or"
        " at once (a switch without hysteresis).",
    ),
    "every-not-positive": Wording(
        487,
        "`every` {period} from {start} on: the period must be above 0, and both must be finite",
        "write every T, t0",
        "Both are taken as they are when the run starts.",
    ),
    "not-finite": Wording(
        3,
        "'{name}' became {what} at t = {t:.6g}",
        "the samples before are kept; a smaller DT or another rule may help",
        _FAULT_PAGE,
    ),
    "not-finite-part": Wording(
        3,
        "'{part}' is {cause} at t = {t:.6g}: '{name}' became {what}",
        "{advice}; the samples before are kept",
        _FAULT_PAGE,
    ),
    "sample-not-finite": Wording(
        3,
        "{names} became {what} at t = {t:.6g}: the run goes on, and the curve has a gap there",
        "test the divisor or the argument, if the gap is not meant",
        "A warning, given once. No derivative and no variable that keeps its value from pass to pass depends"
        " on such a number: its samples say nan or inf, the curve is interrupted, and the run goes on.",
        warning=True,
    ),
    "row-not-chosen": Wording(
        124,
        "iRow = {value:g} chooses no row",
        "iRow must be above 0: set iRow = 1, 2, … before drun, or in the segment",
    ),
    "no-template-left": Wording(
        232,
        "no template is left at t = {t:.6g}: the input is near none, and all rows are committed",
        "give the matrix more rows, or use a larger criterion",
    ),
    "learning-without-vector": Wording(
        475,
        "at t = {t:.6g} CLEARN has a criterion of 0 or more, and no vector to keep wins or committed rows in",
        _LEARNING_HINT,
        _LEARNING_MORE,
    ),
    "learning-needs-vector": Wording(
        475,
        "with a criterion of 0 or more CLEARN needs a vector of {rows} elements right after '{name}'",
        _LEARNING_HINT,
        _LEARNING_MORE,
    ),
    "stopped-by-user": Wording(301, "stopped by the user"),
    "delay-too-long": Wording(
        105,
        "the delay {tau:g} needs {needed} elements, but '{buffer}' has {count}",
        "declare it larger: ARRAY {buffer}[{needed}]",
        "A delay buffer keeps one value for each step (tdelay) or communication point (delay) of the delay.",
    ),
    "delay-negative": Wording(105, "the delay {tau:g} is no time to wait", "a delay must be 0 or more"),
    "delay-cut": Wording(
        482,
        "the delay {tau:g} is cut to {kept:g}: `{word}` delays by whole {what} of {interval:g}",
        "make it a multiple, or use the function delay(x, tau)",
        "A warning, given once for each line.",
        warning=True,
    ),
    "delay-variable-step": Wording(
        122,
        "tdelay needs a constant DT, but rule {rule} changes it",
        "use irule 1, 2, 3 or 5, or `delay`, which counts communication points",
    ),
    "too-many-samples": Wording(
        470,
        "NN = {nn} samples of {columns} variables need {gigabytes:.1f} GB; a run keeps at most {most:.1f} GB",
        "make NN smaller, or set MM to keep only every MM-th sample",
    ),
    "stash-missing": Wording(
        92, "there is no stash file {path}", "a run with a `stash` line writes it (but not `drun *`)"
    ),
    "stash-of-an-earlier-run": Wording(
        92,
        "what is recovered was stashed before the last run of that segment: `drun *` writes no stash file",
        "stash it by `drun`",
        warning=True,
    ),
    "stash-unreadable": Wording(92, "{path} is no stash file", "a run with a `stash` line writes a new one"),
    "stash-narrow": Wording(
        92,
        "{path} holds {found} variable(s), and {wanted} are to be recovered",
        "the k-th recovered variable takes the k-th stashed one",
    ),
}
