"""Messages about models of other programs that become Desire programs."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

MESSAGES: dict[str, Wording] = {
    "convert-part": Wording(
        560,
        "'{what}' is not converted: {reason}",
        "without it the program is another model; `desire convert --partial` writes what is left",
        "A part of another program's model has no counterpart here, or could not be read.",
    ),
    "convert-note": Wording(561, "{what}: {reason}", warning=True),
    "convert-renamed": Wording(
        562, "'{old}' is called '{new}' here: a Desire program cannot call it so", warning=True
    ),
    "convert-kind": Wording(
        563, "{path} is no model that can be converted", "XPPAUT's files end in .ode, those in SBML in .xml"
    ),
    "convert-library": Wording(564, "SBML needs the library {library}", "pip install 'desire-tui[convert]'"),
    "convert-unreadable": Wording(565, "{path} cannot be read as SBML: {reason}"),
}
