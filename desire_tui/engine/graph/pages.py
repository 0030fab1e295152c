"""The pages: which graph a run, a plot or a SHOW goes to, and the last ones to page back through."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.graph.axes import AXIS_WORDS
from desire_tui.engine.graph.curve import Curve, Frame
from desire_tui.engine.graph.measured_curve import measured_curve, without_known
from desire_tui.engine.graph.model import Graph, ShownArray
from desire_tui.engine.graph.settings import DisplaySettings
from desire_tui.engine.integration.rules import DUMMY
from desire_tui.engine.runtime.run_record import RunRecord

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.lowered.segment import Picture, SampleRequest

PAGES_MAX = 32
PAGES_BYTES_MAX = 1 << 28
"""Samples of runs of earlier programs that pages show; the oldest pages' are thinned."""
THINNED_ROWS = 10_000
THINNED = " (thinned)"


class GraphPages:
    """The display: its settings and its last pages. Changed on the session's thread, read from any."""

    def __init__(self) -> None:
        self.settings = DisplaySettings()
        self.pages: list[Graph] = []
        self.pages_max = PAGES_MAX
        self._made = 0
        self.program = ""
        """File name of the program that runs."""
        self._fresh = True  # the next run starts a page whatever `display` says

    def __iter__(self) -> Iterator[Graph]:
        return iter(list(self.pages))

    def __len__(self) -> int:
        return len(self.pages)

    @property
    def current(self) -> Graph | None:
        """The newest page."""
        return self.pages[-1] if self.pages else None

    def begin_program(self, name: str = "") -> None:
        """`erun`: settings as at the start; the program's first run gets a new page."""
        self.program = name
        self.settings = DisplaySettings()
        self._fresh = True

    def limit_memory(self) -> None:
        """Thin the oldest pages' runs where all together take too much. For runs that only pages hold."""
        held, seen = 0, set[RunRecord]()
        for page in reversed(self.pages):
            shown = {curve.record for curve in page.curves}
            shown |= {picture.record for picture in page.shown if picture.record is not None}
            held += sum(record.bytes for record in shown - seen)
            seen |= shown
            if held > PAGES_BYTES_MAX and shown and not page.caption.endswith(THINNED):
                for record in shown:
                    record.thin(THINNED_ROWS)
                page.caption += THINNED
                page.erased += 1

    def display(self, mode: str, args: Sequence[float], scale: float, *, at_once: bool = False) -> bool:
        """Carry out a `display` statement; returns whether a page changed.

        `at_once`: what is said of fitting and axes holds for the newest page too.
        """
        self.settings.apply(mode, args)
        if at_once and self.current is not None and (mode == "fit" or mode in AXIS_WORDS):
            if mode == "fit":
                self.current.fit = "asked"
            else:
                self.current.set_axes(self.current.axes.changed(mode))
            return True
        if mode in ("A", "B"):
            self._open_plot(scale, nonnegative=mode == "B")
            return True
        if mode == "F" and self.current is not None:
            self.current.erase()
            return True
        return False

    def name(self, part: str, text: str, *, at_once: bool = False) -> bool:
        """Give the following graphs a `title`, `xlabel` or `ylabel`; returns whether a page changed.

        The program's newest page gets it too if it has none yet, or with `at_once`.
        """
        self.settings.texts[part] = text
        page = self.current
        if page is None or (not at_once and (self._fresh or page.texts.get(part))):
            return False
        page.texts[part] = text
        return True

    def plot(self, x: float, y: float, color: int | None, scale: float) -> None:
        """Put a point on the interpreter plot, opening one (`display A`) if there is none."""
        page = self.current
        if page is None or page.frame.kind != "plot":
            page = self._open_plot(scale, nonnegative=False)
        page.points.add(x, y, self.settings.curve_color(0) if color is None else color % 16)

    def show(
        self, name: str, values: NDArray[np.float64], columns: int, scale: float, *, by_size: bool = False
    ) -> None:
        """Put a picture of an array on a page of its own."""
        page = self._page(Frame("picture", 0.0, 1.0, 0.0, 1.0, scale), name)
        page.shown.append(ShownArray(name, max(columns, 1), scale, values, by_size=by_size))

    def begin_run(
        self,
        record: RunRecord,
        pictures: Sequence[Picture] = (),
        *,
        program: str = "",
        has_scale: bool = True,
        ahead: int | None = None,
    ) -> Graph | None:
        """Put a run's curves on a new page, or with `display 2` on the current one. None: nothing to show.

        `program` is its file's name. `has_scale`: the program, not the start value, decides the scale.
        `ahead`: so many runs follow, if that is known.
        """
        self.program = program or self.program
        request = next((r for r in record.requests if r.kind != "type"), None)
        if self.settings.mode == 0:
            return None
        if request is None:
            return self._begin_pictures(record, pictures) if pictures else None
        frame = run_frame(record, request)
        page = self.current
        if self._fresh or self.settings.mode == 1 or page is None:
            page = self._page(frame, "")
        self._fresh = False
        page.frame, page.caption, page.program = frame, caption(request), self.program
        self._apply_settings(page)
        page.fit = "asked" if self.settings.fit else "no" if has_scale else "unset"
        page.begin_run(list(self._curves(record, request, frame)), ahead)
        self._add_pictures(page, record, pictures)
        return page

    def end_runs(self) -> Graph | None:
        """Give the runs of the newest page their final colours; returns the page if that changed it."""
        page = self.current
        return page if page is not None and page.end_runs() else None

    def compare(self, records: Sequence[RunRecord]) -> Graph | None:
        """Show runs of one segment over each other on a page of their own, each in other colours.

        None where they have no graph, or the display is off. The next run starts another page.
        """
        pages = [(record, next((r for r in record.requests if r.kind != "type"), None)) for record in records]
        page, first = None, 0
        fit = self.current.fit if self.current is not None else "no"
        for record, request in pages:
            if request is None or self.settings.mode == 0:
                return None
            if page is None:
                page = self._page(run_frame(record, request), caption(request))
                page.fit = fit
            curves = list(self._curves(record, request, page.frame, first))
            page.curves.extend(without_known(curves, page.curves))
            first = len(page.curves)
        self._fresh = True
        return page

    def show_curves(self, frame: Frame, text: str, curves: Iterable[Curve]) -> Graph:
        """Show curves on a page of their own. The next run starts another page."""
        page = self._page(frame, text)
        page.fit = "asked"
        page.curves.extend(curves)
        self._fresh = True
        return page

    def _curves(
        self, record: RunRecord, request: SampleRequest, frame: Frame, first_color: int = 0
    ) -> Iterator[Curve]:
        first = 1 + record.first_column(request)
        names = [column.name for column in request.columns]
        joined = record.rule != DUMMY or request.kind == "dispt"
        if request.kind == "dispt":
            pairs = [(-1, i) for i in range(len(names))]
        elif request.kind == "dispxy":
            pairs = [(0, i) for i in range(1, len(names))]
        else:
            pairs = [(i, i + 1) for i in range(0, len(names) - 1, 2)]
        for number, (x, y) in enumerate(pairs):
            color = self.settings.curve_color(first_color + number)
            yield Curve(
                name=names[y], x_name="t" if x < 0 else names[x], color=color, own_color=color, record=record,
                y_column=first + y, x_column=0 if x < 0 else first + x, frame=frame,
                thickness=self.settings.thickness, joined=joined,
                dash=self.settings.curve_dash(first_color + number),
            )  # fmt: skip
        for number, points in enumerate(record.points, len(pairs)):
            yield measured_curve(points, frame, self.settings.curve_color(first_color + number))

    def _begin_pictures(self, record: RunRecord, pictures: Sequence[Picture]) -> Graph:
        frame = Frame("picture", 0.0, 1.0, 0.0, 1.0, record.scale)
        page = self._page(frame, ", ".join(p.name for p in pictures))
        self._add_pictures(page, record, pictures)
        return page

    def _add_pictures(self, page: Graph, record: RunRecord, pictures: Sequence[Picture]) -> None:
        for number, picture in enumerate(pictures):
            columns = max(picture.columns, 1)
            by_size = self.settings.by_size if picture.by_size is None else picture.by_size
            page.shown.append(
                ShownArray(picture.name, columns, record.scale, None, record, number, by_size=by_size)
            )

    def _open_plot(self, scale: float, *, nonnegative: bool) -> Graph:
        return self._page(Frame("plot", 0.0 if nonnegative else -scale, scale, -scale, scale, scale), "")

    def _page(self, frame: Frame, text: str) -> Graph:
        self._made += 1
        page = Graph(self._made, frame, text, program=self.program)
        self._apply_settings(page)
        self.pages.append(page)
        del self.pages[: -self.pages_max]
        return page

    def _apply_settings(self, page: Graph) -> None:
        page.net, page.white = self.settings.net_color, self.settings.white
        page.texts.update(self.settings.texts)
        page.has_own_colors, page.axes = self.settings.own_colors, self.settings.axes
        page.thickness, page.has_keys = self.settings.thickness, not self.settings.one_color


def run_frame(record: RunRecord, request: SampleRequest) -> Frame:
    """Return the frame of a run's graph: t0 … t0 + TMAX or -scale … scale, by -scale … scale."""
    scale = abs(record.scale) or 1.0
    if request.kind == "dispt":
        return Frame("dispt", *record.time_range, -scale, scale, scale)
    assert request.kind != "type"
    return Frame(request.kind, -scale, scale, -scale, scale, scale)


def caption(request: SampleRequest) -> str:
    """Return the caption: `x, y vs. t`."""
    names = [column.name for column in request.columns]
    pairs = [(points.x.name if points.x is not None else "t", points.y.name) for points in request.points]
    if request.kind == "dispt":
        return f"{', '.join([*names, *(y for _, y in pairs)])} vs. t"
    if request.kind == "dispxy":
        x = names[0] if names else pairs[0][0]
        return f"{', '.join([*names[1:], *(y for _, y in pairs)])} vs. {x}"
    pairs = [*zip(names[::2], names[1::2], strict=False), *pairs]
    return ", ".join(f"{y} vs. {x}" for x, y in pairs)
