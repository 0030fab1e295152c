"""Messages about what is asked of a program after its run: fits, optima, steady states, data."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

MESSAGES: dict[str, Wording] = {
    "analysis-form": Wording(
        520,
        "{what}",
        "{remedy}",
        "What is asked of an analysis (fit, minimise, steady …) is not written as it has to be.",
    ),
    "analysis-failed": Wording(
        521,
        "{what}",
        "{remedy}",
        "An analysis was understood and begun, and came to no result: the text says at what.",
    ),
    "export-compiler": Wording(
        531,
        "{format} needs a C compiler: {reason}",
        "install gcc or clang (apt install gcc, xcode-select --install); --c writes the source alone",
    ),
    "export-refused": Wording(530, "{what} has no form in {format} here", "{remedy}"),
    "analysis-library": Wording(
        522, "{what} needs the library {library}", "pip install 'desire-tui[analysis]'"
    ),
    "data-empty": Wording(
        531,
        "there are no measurements in {file}: {what}",
        "names of columns in one line, numbers below: t, x",
    ),
    "data-ragged": Wording(
        532,
        "{file}: the number of entries in this line, {have}, is not that of the columns, {want}",
        "leave blank what is missing, or begin the line with # to leave it out",
    ),
    "data-cell": Wording(
        533,
        "'{entry}' in column {column} of {file} is no number",
        "correct it, leave it blank if it is missing, or begin the line with #",
    ),
    "data-library": Wording(
        534, "{file} needs the library {library}", "pip install 'desire-tui[data]', or save it as CSV"
    ),
}
