"""What stands behind a graph's own curves, drawn once: a run that a slider makes anew leaves it as it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.data_classes import dataclass

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.graph.curve import Curve
    from desire_tui.engine.outputs.braille_canvas import Canvas
    from desire_tui.engine.outputs.clip_marks import ClipMarks


@dataclass(frozen=True)
class Backdrop:
    """A canvas with finished curves, and the marks of where they leave it."""

    curves: dict[Curve, int]
    """How many samples of each are drawn."""
    look: tuple[object, ...]
    """Everything else that decides how they are drawn."""
    patterns: NDArray[np.uint8]
    colors: NDArray[np.uint8]
    clipped: ClipMarks

    @classmethod
    def taken(
        cls, canvas: Canvas, curves: dict[Curve, int], look: tuple[object, ...], clipped: ClipMarks
    ) -> Backdrop:
        """Keep what stands on a canvas."""
        return cls(dict(curves), look, canvas.patterns.copy(), canvas.colors.copy(), clipped.copy())

    def fits(self, canvas: Canvas, curves: list[Curve], look: tuple[object, ...]) -> bool:
        """Whether drawing these curves on this canvas would make the same."""
        return (
            canvas.patterns.shape == self.patterns.shape
            and look == self.look
            and list(self.curves) == curves
            and all(curve.count == count for curve, count in self.curves.items())
        )

    def put(self, canvas: Canvas) -> None:
        """Draw it on an empty canvas."""
        canvas.patterns[:] = self.patterns
        canvas.colors[:] = self.colors
