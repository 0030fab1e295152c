"""A study on the desktop: begun by a line, its charts on pages of the display, paused, stopped, saved."""

from __future__ import annotations

from .conftest import desktop

LINE = """a = 1 | x = 0 | DT = 0.01 | TMAX = 1 | NN = 11
drun
DYNAMIC
d/dt x = a
dispt x
"""


async def over(desk):
    await desk.until(lambda: not desk.app.studies.is_going)


async def test_a_study_from_its_line_to_its_file(program, tmp_path):
    async with desktop(program(LINE, "line.src")) as desk:
        await desk.line("study --sample a=uniform(0,1) --runs 60 --seed 7 --keep x@0:1:0.5, top=x[end]")
        await over(desk)
        assert "Study of line.src: 60 of 60 runs, 0 failed" in desk.output
        first, second = list(desk.app.session.graphs)[-2:]
        assert desk.app.graph.page is second
        assert [curve.name for curve in second.curves] == ["5 %", "25 %", "median", "75 %", "95 %"]
        assert first.title() == "top of 60 runs"
        assert not desk.app.graph.work_row.display
        await desk.line("study chart scatter top a")
        page = desk.app.graph.page
        assert page.label == "top vs. a"
        x, y = page.curves[0].samples()
        assert len(x) == 60
        assert abs(x - y).max() < 1e-12
        await desk.line("study --over aa=1:2:2 --keep x[end]")  # refused: the study before it stays
        await over(desk)
        await desk.line("study chart cumulated top")
        assert "There is no study" not in desk.output
        await desk.line("study save out.csv")
        await desk.until((tmp_path / "out.csv").exists)
        assert len((tmp_path / "out.csv").read_text().splitlines()) == 61
        for _ in range(2):
            await desk.line("study save out.zarr")
            await desk.until((tmp_path / "out.zarr" / "top").exists)
        await desk.until(lambda: "out.zarr: it is there already" in desk.output)


async def test_a_study_is_paused_goes_on_and_is_stopped(program):
    async with desktop(program(LINE.replace("DT = 0.01", "DT = 0.00001"), "line.src")) as desk:
        await desk.line("study --sample a=uniform(0,1) --runs 1000000 --keep x[end]")
        studies = desk.app.studies
        await desk.until(lambda: studies.progress is not None)
        await desk.line("study pause")
        assert desk.app.graph.work_row.display
        assert "paused" in str(desk.app.graph.work_row.content)
        await desk.line("study --over a=1:2:2 --keep x[end]")
        assert "A study goes on" in desk.output
        await desk.line("study pause")
        assert studies.is_paused
        for _ in range(2):
            await desk.line("study go")
            assert not studies.is_paused
        await desk.line("study stop")
        await over(desk)
        assert 0 < studies.progress.made < 1_000_000
        assert "of 1,000,000 runs" in desk.output


async def test_what_is_wrong_with_a_study_is_said(program):
    async with desktop(program(LINE, "line.src")) as desk:
        await desk.line("study --ovr a=1:2:2")
        assert "did you mean --over?" in desk.output
        await desk.line("study --over aa=1:2:2 --keep x[end]")
        await over(desk)
        assert "aa" in desk.output.splitlines()[-2] + desk.output.splitlines()[-1]
        await desk.line("study --over a=1:2:2 --keep x[end] -o results.txt")
        assert "results.txt is no file for a study" in desk.output
        await desk.line("study stop")
        assert "There is no study" in desk.output
        await desk.line("study --over a=1:2:2 --keep x[end]")
        await over(desk)
        await desk.line("study chart histogramm")
        assert "did you mean histogram?" in desk.output
        await desk.line("study chart fan")
        assert "x[end] is one number of a run" in desk.output
