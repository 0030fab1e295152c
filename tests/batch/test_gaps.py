"""What is inf or nan in a run that goes on: samples, files, pictures and the text plot show a gap."""

from __future__ import annotations

import json
from io import BytesIO, StringIO

import numpy as np
import pytest
from click.testing import CliRunner

import desire_tui
from desire_tui.cli import main
from desire_tui.engine.outputs.csv_file import write_csv
from desire_tui.engine.outputs.json_file import as_json
from desire_tui.engine.outputs.npz_file import write_npz

PROGRAMS = {
    "dispt": "TMAX = 4 | DT = 0.5 | NN = 5\ndrun\nDYNAMIC\nd/dt x = 1\ny = 1/(x - 2)\nz = sqrt(2 - x)\ndispt y, z\nstash y\n",
    "dispxy": "TMAX = 4 | DT = 0.5 | NN = 5\ndrun\nDYNAMIC\nd/dt x = 1\ny = 1/(x - 2)\nz = sqrt(2 - x)\ndispxy z, y\n",
    "DISPXY": "NN = 5 | t = 0\ndrun\nDYNAMIC\ny = 1/(t - 2)\nz = sqrt(2 - t)\nDISPXY z, y\ntype y, z\n",
}
Y = [-0.5, -1, np.inf, 1, 0.5]
Z = [2**0.5, 1, 0, np.nan, np.nan]


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("kind", PROGRAMS)
def test_samples_and_files(kind, backend, tmp_path):
    (tmp_path / "gaps.src").write_text(PROGRAMS[kind])
    result = desire_tui.run(tmp_path / "gaps.src", backend=backend)
    assert result.status == "done"
    assert [(p.code, p.severity) for p in result.problems] == [(3, "warning"), (3, "warning")]
    curves = {curve.name: curve.values for curve in result.runs[0].curves}
    for name, expected in (("y", Y), ("z", Z)):
        np.testing.assert_allclose(curves[name], expected, rtol=1e-15)
    text, archive = StringIO(), BytesIO()
    write_csv(result.runs, text)
    head, *rows = (line.split(",") for line in text.getvalue().splitlines())
    np.testing.assert_array_equal([float(row[head.index("z")]) for row in rows], curves["z"])
    shown = json.loads(as_json(result))["runs"][0]["curves"]
    assert next(c["values"][3:] for c in shown if c["name"] == "z") == ["nan", "nan"]
    write_npz(result, archive)
    archive.seek(0)
    np.testing.assert_array_equal(np.load(archive)["1/y"], curves["y"])


@pytest.mark.parametrize("kind", PROGRAMS)
def test_pictures_and_the_text_plot(kind, tmp_path):
    file = tmp_path / "gaps.src"
    file.write_text(PROGRAMS[kind])
    picture = tmp_path / "gaps.png"
    result = CliRunner().invoke(main, ["run", str(file), "--plot", "--png", str(picture)])
    assert result.exit_code == 0, result.output
    assert picture.stat().st_size
    assert "gaps.src · run 1 · fitted" in result.output
