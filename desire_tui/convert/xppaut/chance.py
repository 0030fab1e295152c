"""Markov chains: `markov z 2` and the rows of its rates."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.convert.model import MarkovProcess
from desire_tui.convert.xppaut.declarations import braced

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.convert.xppaut.building import Building

STATES_MOST = 50


def processes(building: Building) -> Iterator[MarkovProcess]:
    """Yield the chains; a table of rates may stand in any number of lines below the chain's."""
    declarations = building.declarations
    for place, one in enumerate(declarations):
        if one.kind != "markov":
            continue
        words = one.right.split("{", 1)[0].split()
        count = int(words[1]) if len(words) > 1 and words[1].isdigit() else 0
        if not 2 <= count <= STATES_MOST:
            building.refuse(one.line, f"a chain has 2 to {STATES_MOST} states")
            continue
        cells = braced(one.right)
        for row in declarations[place + 1 :]:
            if row.kind != "matrix row" or len(cells) >= count * count:
                break
            cells.extend(braced(row.line.text))
            building.used.append(row)
        if len(cells) != count * count:
            building.refuse(
                one.line, f"{count * count} rates in braces should follow, there are {len(cells)}"
            )
            continue
        rates = [
            [building.formula(cells[i * count + k], one.line) for k in range(count)] for i in range(count)
        ]
        yield MarkovProcess(building.spelling[words[0].lower()], rates, comment=one.line.comment)
