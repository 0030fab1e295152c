"""Messages about studies: what varies, what is kept, what does not fit."""

from __future__ import annotations

from desire_tui.engine.diagnostics.wording.entry import Wording

MESSAGES: dict[str, Wording] = {
    "study-form": Wording(
        510,
        "{what}",
        "{remedy}",
        "What varies in a study, what is drawn or what is kept of a run is not written as it has to be.",
    ),
    "study-twice": Wording(510, "'{name}' is given twice", "give it in one place"),
    "study-empty": Wording(511, "a study of no runs: {what}", "{remedy}"),
    "study-too-large": Wording(
        512,
        "{runs} run(s) of {numbers} number(s) each take {size}; {where} has {free} left",
        "{remedy}",
    ),
    "study-store": Wording(
        513,
        "{path} holds another study: {what}",
        "write to another folder, or remove this one to begin anew",
    ),
    "study-store-there": Wording(
        513, "{path} is there already", "--resume goes on with it; another name keeps both; or remove it"
    ),
    "study-cluster": Wording(
        514,
        "the cluster's scheduler {address} cannot be reached: {reason}",
        "what is stored stays: --resume goes on",
    ),
    "study-no-run": Wording(
        515, "the script came to its end without a run to keep '{text}' of", "a study needs a drun"
    ),
    "study-computed": Wording(
        517,
        "'{name}' is computed here in every run, whatever value it is given",
        "{remedy}",
        "A study gives values to parameters and to what states begin with. What the DYNAMIC segment computes "
        "before it reads it has no value of its own: all runs would be the same.",
    ),
    "study-library": Wording(516, "{what} needs the library {library}", "pip install 'desire-tui[study]'"),
}
