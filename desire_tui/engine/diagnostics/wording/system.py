"""Messages about files, permissions and the session."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

MESSAGES: dict[str, Wording] = {
    "out-of-memory": Wording(40, "no room for {elements} more numbers", "make the arrays smaller, or clear"),
    "memory-exhausted": Wording(
        40, "the machine's memory is full", "smaller arrays, fewer samples (NN, MM), or fewer runs"
    ),
    "internal-error": Wording(
        474,
        "internal error while {what}: {reason}",
        "a fault of this program, not of yours: please report it, with the program that shows it",
    ),
    "fast-code-missing": Wording(
        474,
        "internal error while fast code was made: {reason}",
        "the numbers are right, runs take longer; please report it, with the program that shows it",
        warning=True,
    ),
    "check-incomplete": Wording(
        476,
        "checked up to line {line} only: the text takes too long to check while you type",
        "the run, and `desire check`, look at all of it",
        warning=True,
    ),
    "check-too-long": Wording(
        476,
        "not checked while you type: the text has more than {most} characters",
        "the run, and `desire check`, look at all of it",
        warning=True,
    ),
    "no-program": Wording(215, "there is no program to run", "type one into an editor tab, or load one"),
    "no-dynamic-segment": Wording(
        215, "there is no DYNAMIC program segment", "add a line DYNAMIC and a model below it"
    ),
    "no-such-segment": Wording(
        215, "there is no DYNAMIC program segment '{label}'", "add a line `label {label}` behind DYNAMIC"
    ),
    "go-without-stop": Wording(43, "nothing to continue: the script is not at a STOP", "start it with zz"),
    "go-after-edit": Wording(43, "the program was changed since it stopped", "start it again with zz"),
    "program-missing": Wording(38, "there is no file {path}", "check its name and folder"),
    "file-unreadable": Wording(38, "cannot read {path}: {reason}"),
    "file-binary": Wording(38, "{path} is not a text file", "a Desire program is plain text"),
    "file-unwritable": Wording(
        106, "cannot write {path}: {reason}", "does its folder exist, and is there room?"
    ),
    "notebook-lost": Wording(
        106,
        "the notebook {path} cannot be written any more ({reason}): it is off",
        "notebook 'other.md' begins another",
    ),
    "notebook-vanished": Wording(
        473, "the notebook {path} was removed: a new one begins in its place", warning=True
    ),
    "picture-kind": Wording(34, "cannot draw {path}", "end the name with .png, .svg or .pdf"),
    "no-graph": Wording(471, "there is no graph yet", "run a program with dispt, dispxy or DISPXY first"),
    "graph-missing": Wording(
        471,
        "there is no graph for {files}",
        "a graph is made by dispt, dispxy, DISPXY, plot or SHOW",
        warning=True,
    ),
    "no-run": Wording(472, "there is no run yet", "start one with zz or drun"),
    "command-elsewhere": Wording(
        402, "'{word}' works in the desktop only", "start the desktop with `desire`"
    ),
    "no-help": Wording(403, "there is no help page about '{topic}'", "`help` alone lists the pages"),
    "compare-form": Wording(
        404, "compare what?", "for instance: compare rule 4, compare DT 0.001, compare rule 14 ERMAX 1.0E-08"
    ),
    "compare-nothing": Wording(
        405, "the last run shows nothing to compare", "add a dispt, dispxy or type line"
    ),
    "compare-changed": Wording(
        406, "the program or its quantities are others since the last run", "run it again, then compare"
    ),
    "compare-not-integrated": Wording(
        407,
        "{what} cannot be compared: the last run {why}",
        "compare another rule, or a run with d/dt lines",
    ),
    "compare-failed": Wording(
        408, "with {setting} the run does not come to its end: {reason}", "the run before stays as it was"
    ),
    "set-unknown": Wording(
        409, "'{setting}' is set from outside, but the program has no '{name}'", "look for a slip in the name"
    ),
    "record-unknown": Wording(
        409, "'{name}' is to be recorded, but the program does not have it", "look for a slip in the name"
    ),
    "initial-unknown": Wording(
        409,
        "a start is given for '{name}', but the program has no such state",
        "its states are {states}",
    ),
    "equations-missing": Wording(
        491, "the program has no d/dt, so no right-hand side", "drun segments with d/dt lines have one"
    ),
    "equations-impure": Wording(
        491,
        "the derivatives are no function of t and the states alone: they depend on {what}",
        "Model.run runs such programs",
    ),
    "set-array": Wording(
        409, "'{name}' is set from outside like a scalar, but is an array", "set its elements: {name}[1]"
    ),
    "set-no-array": Wording(
        409, "'{setting}' is set from outside, but '{name}' is no array", "set it without subscripts"
    ),
    "shell-refused": Wording(
        450,
        "the program wants to run the shell command `{command}`, which is not allowed",
        "if you trust it: desire run --allow-shell",
    ),
    "file-refused": Wording(
        451,
        "the program wants to {mode} {path}, {reason}: that is not allowed",
        "if you trust it: desire run --allow-write (for reading, too)",
    ),
    "errors-not-reached": Wording(
        412, "{count} error(s) stand where the program did not come", "desire check lists them", warning=True
    ),
    "time-limit": Wording(490, "stopped after {seconds:g} second(s), the limit given"),
}
