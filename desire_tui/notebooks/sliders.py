"""`%%desire --sliders a=0..5`: a model whose parameters are moved by hand."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.outputs.run_plot import run_png

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from desire_tui.api.model import Model
    from desire_tui.engine.outputs.run import Run
    from desire_tui.notebooks.cell_options import SliderRange

_STEPS = 100


class SliderPanel:
    """Sliders, the last run and its picture. `run` is None until one has come to its end."""

    def __init__(
        self,
        model: Model,
        ranges: Sequence[SliderRange],
        settings: Mapping[str, float],
        record: Sequence[str],
    ) -> None:
        import ipywidgets

        self.model, self._settings, self._record = model, dict(settings), tuple(record)
        self.run: Run | None = None
        known = {**model.states, **model.parameters, **settings}
        self.sliders: dict[str, Any] = {
            one.name: ipywidgets.FloatSlider(
                value=min(max(known.get(one.name, one.least), one.least), one.most),
                min=one.least, max=one.most, step=one.step or (one.most - one.least) / _STEPS,
                description=one.name, readout_format=".4g",
            )
            for one in ranges
        }  # fmt: skip
        self.picture = ipywidgets.Image(format="png")
        self.text = ipywidgets.HTML()
        self._all = ipywidgets.VBox([*self.sliders.values(), self.picture, self.text])
        for slider in self.sliders.values():
            slider.observe(self._moved, names="value")

    def _moved(self, _: object) -> None:
        try:
            self.update()
        except DesireError as error:
            self.text.value = f"<pre>{escape(str(error))}</pre>"

    def update(self) -> None:
        """Make the run with the sliders as they stand. DesireError: it cannot begin."""
        values = {name: slider.value for name, slider in self.sliders.items()}
        run = self.model.run(set={**self._settings, **values}, record=self._record)
        self.run = run
        self.picture.value = run_png((run,))
        message = str(run.error) if run.error is not None else run.summary
        self.text.value = f"<pre>{escape(message)}</pre>"

    def _repr_mimebundle_(self, **arguments: Any) -> Any:
        return self._all._repr_mimebundle_(**arguments)
