"""All quantities of the session with their values; edit in place; ask for plots and sliders."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.message import Message
from textual.widgets import DataTable, Input

from desire_tui.panes.value_summary import shape_text, value_text

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from desire_tui.engine.values import Quantity, Values

ROWS_MAX = 400
"""More rows are not shown; the filter finds the others."""
NAME_CELLS_MAX, VALUE_CELLS = 16, 16


class QuantitiesPane(Vertical):
    """A table with a filter; Enter edits a value, `p` plots, `l` makes a slider."""

    DEFAULT_CSS = """
    QuantitiesPane Input { height: 1; border: none; padding: 0 1; background: $panel; }
    QuantitiesPane Input:focus { border: none; background: $boost; }
    QuantitiesPane #edit { display: none; background: $panel; color: $accent; }
    QuantitiesPane DataTable { height: 1fr; background: $surface; scrollbar-size-vertical: 1;
                               scrollbar-size-horizontal: 0; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("l", "slider", "Live slider", show=False),
        Binding("p", "plot", "Plot", show=False),
        Binding("slash", "filter", "Filter", show=False),
        Binding("escape", "done", "Done", show=False),
    ]

    class Edited(Message):
        """A value was typed: carry out `text` as a command."""

        def __init__(self, text: str) -> None:
            super().__init__()
            self.text = text

    def __init__(self) -> None:
        super().__init__(id="quantities")
        self._values: Values | None = None
        self._shown: dict[str, tuple[str, str]] = {}
        self._editing = ""

    def compose(self) -> ComposeResult:
        """Filter, table, field to edit in."""
        yield Input(placeholder="filter · Enter edits · p plots · l live slider", id="filter")
        yield DataTable(cursor_type="row", show_header=False, cell_padding=1)
        yield Input(id="edit")

    @property
    def table(self) -> DataTable[str]:
        """The table."""
        return self.query_one(DataTable)

    def show(self, values: Values) -> None:
        """Bring the table up to date; only what changed is drawn."""
        from desire_tui.engine.values import SYSTEM_VARIABLES

        self._values = values
        if not self.is_on_screen:
            return
        wanted = self.query_one("#filter", Input).value.casefold()
        rows: dict[str, tuple[str, str]] = {}
        own = (q for q in values if q.name not in SYSTEM_VARIABLES)
        system = (values.find(name) for name in SYSTEM_VARIABLES if name != "PI")
        for quantity in chain(own, (q for q in system if q is not None and values.is_defined(q))):
            if wanted in quantity.name.casefold():
                rows[quantity.name] = (value_text(values, quantity), shape_text(quantity))
            if len(rows) >= ROWS_MAX:
                break
        table = self.table
        if list(rows) != list(self._shown):
            row = table.cursor_row
            table.clear(columns=True)
            table.add_column("name", key="name", width=min(max(map(len, rows), default=4), NAME_CELLS_MAX))
            table.add_column("value", key="value", width=VALUE_CELLS)
            table.add_column("shape", key="shape")
            for name, (value, shape) in rows.items():
                table.add_row(name, value, shape, key=name)
            table.move_cursor(row=row)
        else:
            for name, cells in rows.items():
                if cells[0] != self._shown[name][0]:
                    table.update_cell(name, "value", cells[0])
        self._shown = rows

    @on(Input.Changed, "#filter")
    def _filter(self, event: Input.Changed) -> None:
        event.stop()
        if self._values is not None:
            self.show(self._values)

    def action_filter(self) -> None:
        """Move to the filter."""
        self.query_one("#filter", Input).focus()

    def action_done(self) -> None:
        """Leave the field."""
        self.query_one("#edit", Input).display = False
        self.table.focus()

    # ---------------------------------------------------------------------------------------------- editing

    @property
    def chosen(self) -> Quantity | None:
        """The quantity under the table's cursor."""
        if self._values is None or not self.table.row_count:
            return None
        names = list(self._shown)
        row = self.table.cursor_row
        return self._values.find(names[row]) if 0 <= row < len(names) else None

    @on(DataTable.RowSelected)
    def _edit(self, event: DataTable.RowSelected) -> None:
        event.stop()
        quantity = self.chosen
        if quantity is None or self._values is None:
            return
        self._editing = quantity.name
        field = self.query_one("#edit", Input)
        if quantity.shape:
            field.value = f"{quantity.name}[{','.join('1' for _ in quantity.shape)}] = "
        else:
            field.value = f"{quantity.name} = {value_text(self._values, quantity).replace('undefined', '')}"
        field.display = True
        field.focus()
        field.cursor_position = len(field.value)

    @on(Input.Submitted, "#edit")
    def _edited(self, event: Input.Submitted) -> None:
        event.stop()
        self.action_done()
        if event.value.strip() and not event.value.rstrip().endswith("="):
            self.post_message(self.Edited(event.value))

    # ---------------------------------------------------------------------------------------------- plotting

    class PlotRequested(Message):
        """A quantity is to be plotted on a page of its own."""

        def __init__(self, name: str) -> None:
            super().__init__()
            self.name = name

    def action_plot(self) -> None:
        """Plot the chosen quantity."""
        if (quantity := self.chosen) is not None:
            self.post_message(self.PlotRequested(quantity.name))

    class SliderRequested(Message):
        """A quantity is to have a slider."""

        def __init__(self, name: str) -> None:
            super().__init__()
            self.name = name

    def action_slider(self) -> None:
        """Ask for a slider for the chosen quantity."""
        if (quantity := self.chosen) is not None:
            self.post_message(self.SliderRequested(quantity.name))
