"""A quantity plotted on demand: key, command line, arrays, elements, what the run did not record."""

from __future__ import annotations

import numpy as np

from desire_tui.actions.graph_actions import NOT_CHARTED

from .conftest import OSCILLATOR, desktop

PROGRAM = """\
ARRAY a[5], M[2,3], big[9,4] | STATE y[2]
for i = 1 to 5 | a[i] = i*i | next
M[2,3] = 7
TMAX = 6 | DT = 0.001 | NN = 301
irule 3
x = 1 | w = 1 | y[1] = 1
drun
DYNAMIC
d/dt x = v
d/dt v = -w*x
energy = x*x + v*v
double = 2*x
Vectr d/dt y = -y
dispt x
"""


def curves(desk):
    page = desk.app.session.graph
    return {curve.name: curve.samples() for curve in page.curves}


async def test_p_in_the_quantities_pane_plots_the_chosen_variable_of_the_last_run(program):
    async with desktop(program(OSCILLATOR), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        run_page = desk.app.session.graph
        await desk.press("alt+q")
        desk.app.quantities.query_one("#filter").value = "v"
        await desk.pilot.pause()
        desk.app.quantities.table.focus()
        await desk.press("p")
        await desk.idle()
        page = desk.app.session.graph
        assert page is not run_page
        assert page.caption == "v vs. t"
        t, v = curves(desk)["v"]
        assert np.abs(v + np.sin(t)).max() < 1e-4
        assert page.frame.top >= 1 >= page.frame.top / 1.2  # as high as the curve needs
        assert len(desk.app.session.runs) == 1
        desk.app.graph.tick()
        assert desk.app.graph.page is page


async def test_what_the_run_did_not_record_is_recorded_by_making_it_again(program):
    async with desktop(program(PROGRAM), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        session = desk.app.session
        before = session.values.saved()
        await desk.line("graph double")
        await desk.idle()
        t, double = curves(desk)["double"]
        assert len(t) == 301
        assert np.abs(double - 2 * np.cos(t)).max() < 1e-4
        await desk.line("graph y[1]")
        await desk.idle()
        t, decay = curves(desk)["y[1]"]
        assert np.abs(decay - np.exp(-t)).max() < 1e-4
        after = session.values.saved()
        for (_, one), (_, other) in zip(before.numbers, after.numbers, strict=True):
            assert np.array_equal(one, other)
        assert len(session.runs) == 1


async def test_arrays_are_plotted_over_their_index(program):
    async with desktop(program(PROGRAM), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.line("graph a")
        await desk.idle()
        index, values = curves(desk)["a"]
        assert list(index) == [1, 2, 3, 4, 5]
        assert list(values) == [1, 4, 9, 16, 25]
        assert (desk.app.session.graph.frame.left, desk.app.session.graph.frame.right) == (1, 5)
        await desk.line("a[1] = 100")
        await desk.idle()
        assert curves(desk)["a"][1][0] == 1  # the page keeps what was plotted
        await desk.line("graph M")
        await desk.idle()
        assert list(curves(desk)) == ["M[1]", "M[2]"]
        assert list(curves(desk)["M[2]"][1]) == [0, 0, 7]
        await desk.line("graph big")
        await desk.idle()
        assert desk.app.session.graph.shown[0].columns == 4


async def test_what_cannot_be_plotted_is_said(program):
    async with desktop(program(PROGRAM), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        pages = len(desk.app.session.graphs)
        for name, why in ("w", "constant"), ("nobody", "unknown"), ("a[6]", "unknown"), ("x[1]", "unknown"):
            await desk.line(f"graph {name}")
            await desk.idle()
            said = [note.message for note in desk.app._notifications]
            assert NOT_CHARTED[why].format(name=name) in said
            assert len(desk.app.session.graphs) == pages


async def test_before_a_run_and_after_a_change_there_is_nothing_to_plot(program):
    async with desktop(program(PROGRAM), size=(120, 40)) as desk:
        await desk.line("q = 3")
        await desk.idle()
        assert desk.app.session.plot_quantities("q") == ("no run", "q")
        await desk.press("f5")
        await desk.idle()
        desk.app.editor.front.text = PROGRAM.replace("2*x", "3*x")
        await desk.press("f2")
        await desk.idle()
        assert desk.app.session.plot_quantities("double") == ("changed", "double")
        assert desk.app.session.plot_quantities("x") == ("shown", "x")


async def test_the_next_run_starts_a_page_of_its_own(program):
    async with desktop(program(OSCILLATOR.replace("drun", "display 2\ndrun")), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.line("graph v")
        await desk.idle()
        chart = desk.app.session.graph
        await desk.press("f5")
        await desk.idle()
        assert [c.name for c in chart.curves] == ["v"]
        assert desk.app.session.graph is not chart


async def test_measured_points_beside_a_quantity(program, tmp_path):
    (tmp_path / "m.csv").write_text("t,seen\n0,1\n3,-1\n")
    async with desktop(program("data 'm.csv'\n" + OSCILLATOR), size=(120, 40)) as desk:
        await desk.press("f5")
        await desk.idle()
        await desk.line("graph x, seen")
        await desk.idle()
        found = desk.app.session.graph
        assert [(c.name, c.measured) for c in found.curves] == [("x", False), ("seen", True)]
        assert found.caption == "x, seen vs. t"
        assert desk.app.session.plot_quantities("seen") == ("shown", "seen")
        assert desk.app.session.graph.frame.right == 3
