"""Finds actions of the command table by the words of their description, and by those of other programs."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from desire_tui.commands import Command

SYNONYMS = {
    "run.start": "execute simulate go compute",
    "run.accept": "compile check",
    "run.pause": "stop interrupt break halt",
    "run.end": "stop abort kill cancel terminate quit",
    "run.trace": "debug debugger step",
    "run.breakpoint": "debug debugger stop",
    "run.live": "slider parameter knob interactive vary",
    "run.live_write": "slider parameter save set apply",
    "run.report": "statistics steps time info",
    "file.open": "load read import recent",
    "file.save": "write store keep",
    "file.examples": "samples demo library models",
    "file.quit": "exit leave close",
    "edit.find": "search grep",
    "edit.replace": "substitute rename",
    "edit.fix": "quick fix spelling typo correct mend did you mean",
    "edit.fold": "collapse expand hide expectations tests",
    "edit.duplicate": "copy repeat",
    "edit.goto": "jump",
    "edit.complete": "autocomplete intellisense suggest",
    "graph.fit": "autoscale auto scale autorange whole",
    "graph.log": "logarithmic decades semilog loglog scale axis",
    "graph.equal": "aspect ratio square orbit circle round",
    "graph.reset": "autoscale home unzoom",
    "graph.zoom_in": "magnify enlarge scale",
    "graph.zoom_out": "shrink scale",
    "graph.read": "cursor crosshair values measure coordinates",
    "graph.legend": "legend names",
    "graph.older": "history previous",
    "graph.snapshot": "png svg pdf image picture export save figure print",
    "graph.picture": "image kitty sixel",
    "graph.export": "csv table data spreadsheet excel save",
    "graph.chart": "plot draw array",
    "graph.overlay": "compare superimpose",
    "view.copy_graph": "csv data clipboard spreadsheet excel",
    "view.history": "history earlier commands again repeat recall lines",
    "view.copy_output": "clipboard console",
    "view.quantities": "variables parameters states inspect watch values",
    "view.problems": "errors warnings diagnostics",
    "view.theme": "colours colors dark light appearance",
    "view.wider": "resize split column grow",
    "view.narrower": "resize split column shrink",
    "view.higher": "resize split row grow taller",
    "view.lower": "resize split row shrink",
    "view.even": "reset layout splits default",
    "view.maximize": "full screen zoom pane",
    "view.jump": "labels letters focus go",
    "help.keys": "shortcuts keyboard bindings cheat sheet",
    "help.config": "settings preferences options",
    "help.tour": "introduction tutorial welcome",
}
"""Words that people of other programs look for."""


def is_described(command: Command, query: str) -> bool:
    """Whether each word of a query begins a word of an action's description or synonyms."""
    words = re.findall(
        r"[\w+]+",
        f"{command.title} {command.help} {' '.join(command.words)} {SYNONYMS.get(command.id, '')}".casefold(),
    )
    wanted = query.casefold().split()
    return bool(wanted) and all(any(word.startswith(part) for word in words) for part in wanted)
