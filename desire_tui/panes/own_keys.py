"""The keys that panes have for themselves, under the headings of the key sheet."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.panes.graph_pane import GraphPane
from desire_tui.panes.quantities_pane import QuantitiesPane
from desire_tui.panes.slider import Slider

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from textual.binding import BindingType

OWN_KEYS: Mapping[str, Sequence[BindingType]] = {
    "while the graph has the focus": GraphPane.BINDINGS,
    "on a slider": Slider.BINDINGS,
    "in the quantities": QuantitiesPane.BINDINGS,
}
