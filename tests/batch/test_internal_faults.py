"""A fault of ours, at whatever stage, is a result: nothing is raised, no traceback is shown, status 1."""

from __future__ import annotations

import importlib
import json

import pytest

import desire_tui
from tests.batch.command_line import desire

PROGRAM = "TMAX = 1 | DT = 0.1 | NN = 11\nwrite 'begun'\ndrun\nDYNAMIC\nd/dt x = 1\ndispt x\n"
STAGES = {
    "parse": "desire_tui.engine.syntax.parse:lines_and_runs",
    "structure": "desire_tui.engine.structure.structure:check_jumps",
    "lower": "desire_tui.engine.lowering.segments:_lower_statement",
    "compile": "desire_tui.engine.codegen.backend:NativeBackend.model",
    "plan": "desire_tui.engine.runtime.defaults:Defaults.plan",
    "run": "desire_tui.engine.codegen.native_model:NativeModel.advance",
    "sample": "desire_tui.engine.runtime.simulator:_note",
    "listing": "desire_tui.engine.session.type_output:TypeOutput.block",
    "graph": "desire_tui.engine.graph.pages:GraphPages.begin_run",
    "results": "desire_tui.engine.outputs.results:run_data",
}
FAULTS = [
    KeyError("the key"),
    IndexError("out of range"),
    MemoryError(),
    RecursionError("too deep"),
    TypeError("a\nb"),
]


def broken(place, fault):
    """Return what to replace, and by what."""
    module, _, name = place.partition(":")
    owner = importlib.import_module(module)
    *parents, name = name.split(".")
    for parent in parents:
        owner = getattr(owner, parent)
    assert hasattr(owner, name), place

    def fails(*_args, **_settings):
        raise fault

    return owner, name, fails


@pytest.mark.parametrize("place", STAGES.values(), ids=STAGES)
@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: type(fault).__name__)
def test_in_python(monkeypatch, capfd, place, fault):
    monkeypatch.setattr(*broken(place, fault))
    text = f"{PROGRAM}-- {place} {type(fault).__name__}\n"  # one that was run before begins at its drun
    result = desire_tui.run(text)
    assert result.status == "failed"
    problem = result.problems[-1]
    if not isinstance(fault, MemoryError | RecursionError):  # these may be the program's own
        assert problem.message.startswith("internal error while ")
        assert type(fault).__name__ in problem.message
    assert problem.hint
    assert "Traceback" not in "".join(capfd.readouterr())


@pytest.mark.parametrize("place", [*STAGES.values(), "desire_tui.batch.output_files:OutputFiles.write"])
def test_on_the_command_line(monkeypatch, tmp_path, place):
    monkeypatch.setattr(*broken(place, KeyError("the key")))
    (tmp_path / "p.src").write_text(PROGRAM)
    status, _, err = desire("run", "p.src", "--json", "o.json", "--csv", "o.csv", cwd=tmp_path)
    assert status == 1, err
    assert "error 474: internal error while" in err
    if "output_files" not in place:
        assert json.loads((tmp_path / "o.json").read_text())["status"] == "failed"
