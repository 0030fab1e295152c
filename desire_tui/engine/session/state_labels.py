"""What states are called: `x`, and elements of arrays one by one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from desire_tui.engine.values import Values


def state_labels(values: Values) -> dict[int, str]:
    """Return the names of all states by their slots."""
    labels = dict[int, str]()
    for quantity in values:
        if quantity.is_state and not quantity.shape:
            labels[quantity.slot] = quantity.name
        elif quantity.is_state:
            for number, place in enumerate(np.ndindex(quantity.shape)):
                label = f"{quantity.name}[{','.join(str(k + 1) for k in place)}]"
                labels[quantity.slot + number] = label
    return labels
