"""`%%desire` in a kernel: the notebook of the documentation, its pictures, a graph that grows, mistakes."""

from __future__ import annotations

import base64
import io
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
NOTEBOOK = ROOT / "docs" / "notebook.ipynb"
LONG = "k = 1 | x = 1 | TMAX = 1E9 | DT = 0.001 | NN = 1000001\ndrun\nDYNAMIC\nd/dt x = v\nd/dt v = -k*x\ndispt x"
INTERRUPT = """
import os, signal
from desire_tui.notebooks.live_graph import LiveGraph

def grow(self, runs, own=LiveGraph.grow):
    LiveGraph.grow = own
    os.kill(os.getpid(), signal.SIGINT)

LiveGraph.grow = grow
"""
"""The next cell is interrupted while it runs."""
SHOW_AT_ONCE = """
from desire_tui.notebooks import live_graph

live_graph.INTERVAL_SECONDS = 0.01
"""
"""The graph of a short run grows too."""
MORE = {
    "interrupt": INTERRUPT,
    "interrupted": f"%%desire\n{LONG}",
    "interrupt one": INTERRUPT,
    "one run interrupted": f"%%desire --record v\n{LONG}",
    "show at once": SHOW_AT_ONCE,
    "grows": f"%%desire --timeout 1\n{LONG}",
    "one run grows": f"%%desire --timeout 1 --record v\n{LONG}",
    "console": "%%desire\nwrite 'hello'\nx = 1",
    "failing": "%%desire\nTMAX = 1\ndrun\nDYNAMIC\nd/dt x = y",
    "failing slider": "%%desire --sliders k=0..1\nTMAX = 1\ndrun\nDYNAMIC\nd/dt x = k + y",
    "option": "%%desire --recrod x\nx = 1",
    "setting": "%%desire --set k\nk = 1",
    "name": "%%desire --name 3x\nk = 1",
    "range": "%%desire --sliders k=5..0\nk = 1",
    "unknown parameter": "%%desire --sliders q=0..1\nTMAX = 1 | k = 1\ndrun\nDYNAMIC\nd/dt x = k",
}


@pytest.fixture(scope="module")
def executed():
    import nbclient
    import nbformat

    class Listening(nbclient.NotebookClient):
        """Counts how often each cell's displays were drawn anew."""

        def process_message(self, msg, cell, cell_index):
            if msg["msg_type"] == "update_display_data":
                self.updates[cell_index] = self.updates.get(cell_index, 0) + 1
            return super().process_message(msg, cell, cell_index)

    notebook = nbformat.read(NOTEBOOK, 4)
    count = len(notebook.cells)
    notebook.cells += [nbformat.v4.new_code_cell(text) for text in MORE.values()]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(ROOT))
        client = Listening(notebook, timeout=120, allow_errors=True)
        client.updates = {}
        client.execute()
    more = dict(zip(MORE, notebook.cells[count:], strict=True))
    updates = {name: client.updates.get(count + place, 0) for place, name in enumerate(MORE)}
    return notebook, notebook.cells[:count], more, updates


def pictures(cell):
    """Return a cell's pictures as arrays."""
    from matplotlib.image import imread

    found = [output.data["image/png"] for output in cell.outputs if "image/png" in output.get("data", {})]
    return [imread(io.BytesIO(base64.b64decode(data))) for data in found]


def problem(cell):
    """Return what a cell shows of its error, all of it."""
    (output,) = (output for output in cell.outputs if output.output_type == "error")
    return "\n".join(output.traceback)


def test_the_notebook_of_the_documentation_runs(executed):
    import nbformat

    _, cells, _, _ = executed
    shipped = nbformat.read(NOTEBOOK, 4).cells
    for cell, before in zip(cells, shipped, strict=True):
        if cell.cell_type != "code":
            continue
        kinds = [output.output_type for output in cell.outputs]
        assert ("error" in kinds) == ("raises-exception" in cell.metadata.get("tags", ())), cell.source
        assert kinds == [output.output_type for output in before.outputs], cell.source
        assert len(pictures(cell)) == len(pictures(before)), cell.source


def test_its_pictures_show_curves(executed):
    _, cells, _, _ = executed
    found = [picture for cell in cells if cell.cell_type == "code" for picture in pictures(cell)]
    assert len(found) == 4
    for picture in found:
        shades = picture[..., :3].max(axis=2) - picture[..., :3].min(axis=2)
        assert (shades > 0.3).sum() > 500, "coloured pixels"


def test_sliders_move_the_model(executed):
    notebook, _, _, _ = executed
    states = notebook.metadata.widgets["application/vnd.jupyter.widget-state+json"]["state"].values()
    sliders = {
        s["state"]["description"]: s["state"]["value"]
        for s in states
        if s["model_name"] == "FloatSliderModel"
    }
    assert (sliders["mu"], sliders["x"]) == (3.0, 0.1)
    images = [state["buffers"][0]["data"] for state in states if state["model_name"] == "ImageModel"]
    assert base64.b64decode(images[0]).startswith(b"\x89PNG")


def test_a_graph_grows_while_the_program_runs(executed):
    _, _, more, updates = executed
    for name in ("grows", "one run grows"):
        assert updates[name] >= 1, "was there before the end"
        assert len(pictures(more[name])) == 1
        assert "error 490: stopped after 1 second" in problem(more[name])


def test_console_text_is_the_cells(executed):
    (output,) = executed[2]["console"].outputs
    assert (output.name, output.text) == ("stdout", "hello\n")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("failing", "cell:5:10: error 200: undefined variable 'y'\n    d/dt x = y\n             ^"),
        ("interrupted", "stopped"),
        ("one run interrupted", "stopped"),
        ("failing slider", "cell:5:14: error 200: undefined variable 'y'"),
        ("option", "%%desire has no option '--recrod'; did you mean --record?"),
        ("setting", "%%desire --set k: write NAME=NUMBER"),
        ("name", "--name 3x: that cannot be the name"),
        ("range", "--sliders k=5..0: k needs a range that rises"),
        ("unknown parameter", "the program has no 'q'"),
    ],
)
def test_a_mistake_is_shown_with_its_place_and_without_traceback(executed, name, text):
    shown = problem(executed[2][name])
    assert text in shown
    assert "Traceback" not in shown
    assert "File " not in shown


def test_numbers_of_the_notebook(executed):
    _, cells, _, _ = executed
    text = next(c for c in cells if c.source.startswith("result.runs")).outputs[0].data["text/plain"]
    assert "402.9" in text
    rows = np.array([cell.cell_type == "code" for cell in cells])
    assert rows.sum() >= 8
