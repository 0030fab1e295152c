"""FMUs in another's hands: fmpy reads, checks and simulates what was exported."""

from __future__ import annotations

import os
from zipfile import ZipFile

import numpy as np
import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.source import Source
from desire_tui.export.fmu.content import content
from desire_tui.export.formats import Export

SPRING = """k = 4 | r = 0.2 | u = 0 | x = 1 | v = 0 | TMAX = 5 | DT = 0.001 | NN = 501 | irule {rule} | ERMAX = 1e-8
drun
DYNAMIC
force = u - k*x - r*v
d/dt x = v
d/dt v = force
OUT
energy = 0.5*(v*v + k*x*x)
dispt x, force, energy
"""
COUNTER = """x = 1 | n = 0 | m = 0 | TMAX = 1 | DT = 0.01 | NN = 11
drun
DYNAMIC
d/dt x = -x
n = n + 1
SAMPLE 2
m = m + 1
dispt x, m
"""


@pytest.fixture
def fmpy():
    """Fmpy is imported where it is used: it takes longer than all of the test modules' own text."""
    import fmpy
    import fmpy.validation

    return fmpy


@pytest.fixture
def exported(tmp_path):
    def made(text, **settings):
        path = tmp_path / "spring.fmu"
        path.write_bytes(content(Export(Source(text, "a spring.src"), **settings)))
        return str(path)

    return made


def exact(t, k=4.0, r=0.2):
    """Return x of the free spring from x = 1 at rest."""
    w = np.sqrt(k - r * r / 4)
    return np.exp(-r / 2 * t) * (np.cos(w * t) + r / 2 / w * np.sin(w * t))


@pytest.mark.parametrize("rule", [3, 4])
def test_it_is_valid_and_gives_the_solution(fmpy, exported, rule):
    path = exported(SPRING.format(rule=rule))
    assert fmpy.validation.validate_fmu(path) == []
    found = fmpy.simulate_fmu(path, fmi_type="CoSimulation", stop_time=5.0, output_interval=0.05)
    assert found["x"] == pytest.approx(exact(found["time"]), abs=1e-6)
    t, w = found["time"], np.sqrt(4.0 - 0.01)
    speed = -4.0 / w * np.exp(-0.1 * t) * np.sin(w * t)
    assert found["force"] == pytest.approx(-4.0 * exact(t) - 0.2 * speed, abs=1e-5)
    assert found["energy"][0] == 2.0
    assert np.all(np.diff(found["energy"]) <= 1e-9)


def test_other_solvers_exchange_the_model(fmpy, exported):
    path = exported(SPRING.format(rule=3))
    found = fmpy.simulate_fmu(path, fmi_type="ModelExchange", stop_time=5.0, relative_tolerance=1e-8)
    assert found["x"] == pytest.approx(exact(found["time"]), abs=1e-5)


def test_parameters_starts_and_inputs(fmpy, exported):
    path = exported(SPRING.format(rule=3), inputs=("u",), settings={"r": 0.0})
    given = np.array([(0.0, 8.0), (5.0, 8.0)], dtype=[("time", float), ("u", float)])
    found = fmpy.simulate_fmu(
        path, fmi_type="CoSimulation", stop_time=5.0, output_interval=0.05, start_values={"k": 16.0, "x": 0.0},
        input=given,
    )  # fmt: skip
    assert found["x"] == pytest.approx(0.5 * (1.0 - np.cos(4.0 * found["time"])), abs=1e-6)


def test_what_counts_is_for_co_simulation_alone(fmpy, exported):
    path = exported(COUNTER)
    assert fmpy.validation.validate_fmu(path) == []
    description = fmpy.read_model_description(path)
    assert description.modelExchange is None
    found = fmpy.simulate_fmu(path, stop_time=1.0, output_interval=0.1)
    assert found["x"] == pytest.approx(np.exp(-found["time"]), abs=1e-4)
    assert found["m"].tolist() == [0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]


def test_a_stiff_model_is_exchanged_whatever_its_rule(fmpy, exported):
    """d/dt y = -1000 (y - cos t) - sin t keeps to cos t; the program's rule 14 is not in C."""
    path = exported("""y = 1 | TMAX = 3 | DT = 0.001 | NN = 31 | irule 14 | ERMAX = 1e-6
drun
DYNAMIC
d/dt y = -1000*(y - cos(t)) - sin(t)
dispt y
""")
    assert fmpy.validation.validate_fmu(path) == []
    assert fmpy.read_model_description(path).coSimulation is None
    found = fmpy.simulate_fmu(path, stop_time=3.0, relative_tolerance=1e-8)
    assert found["y"] == pytest.approx(np.cos(found["time"]), abs=1e-5)


def test_source_and_description_are_in_it(exported):
    with ZipFile(exported(SPRING.format(rule=3))) as archive:
        names = archive.namelist()
        assert {
            "modelDescription.xml",
            "sources/model.c",
            "sources/glue.c",
            "sources/buildDescription.xml",
        } < {*names}
        assert b'modelIdentifier="a_spring"' in archive.read("modelDescription.xml")


def test_an_input_that_is_no_parameter():
    with pytest.raises(DesireError) as error:
        content(Export(Source(SPRING.format(rule=3), "s.src"), inputs=("x", "w")))
    told = [problem.message for problem in error.value.diagnostics]
    assert told == [
        "'x' is no parameter, which an input has to be",
        "'w' is no parameter, which an input has to be",
    ]


def test_without_a_compiler_it_is_said(monkeypatch, tmp_path):
    monkeypatch.setitem(os.environ, "PATH", str(tmp_path))
    with pytest.raises(DesireError) as error:
        content(Export(Source(SPRING.format(rule=3), "s.src")))
    assert error.value.diagnostics[0].message.startswith("an FMU needs a C compiler")
