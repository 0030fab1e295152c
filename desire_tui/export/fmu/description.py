"""modelDescription.xml: what a simulation environment is told of the FMU (FMI 3.0, section 2.4)."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from desire_tui.api.settings import slot_of
from desire_tui.engine.session.state_labels import state_labels
from desire_tui.engine.values import SYSTEM_VARIABLES, T
from desire_tui.export.fmu.hooks import is_continuous

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.export.c.model_file import ModelFile

DERIVATIVES = 1_000_000_000
"""Value reference of the first state's derivative; as in glue.c."""


class Description:
    """The file's variables, in the order in which importers show them. Inputs have been checked.

    `steps`: it steps by the program's rule, and so offers co-simulation.
    """

    def __init__(
        self, file: ModelFile, identifier: str, token: str, inputs: Sequence[str], *, steps: bool
    ) -> None:
        self._steps = steps
        self._file, self._identifier, self._token, self._inputs = file, identifier, token, inputs
        self._variables = ET.Element("ModelVariables")
        self._structure = ET.Element("ModelStructure")
        self._known: set[int] = set()

    def xml(self) -> bytes:
        """Return the file."""
        plan, file = self._file.run.plan, self._file
        root = ET.Element("fmiModelDescription", {
            "fmiVersion": "3.0", "modelName": self._identifier,
            "instantiationToken": self._token, "generationTool": "Desire in a terminal",
            "variableNamingConvention": "structured",
        })  # fmt: skip
        once = {"modelIdentifier": self._identifier, "canBeInstantiatedOnlyOncePerProcess": "true"}
        if is_continuous(file.run.segment):
            ET.SubElement(root, "ModelExchange", once)
        if self._steps:
            ET.SubElement(root, "CoSimulation", {**once, "canHandleVariableCommunicationStepSize": "true"})
        ET.SubElement(root, "DefaultExperiment", {
            "startTime": repr(plan.t0), "stopTime": repr(plan.t0 + plan.t_max), "stepSize": repr(plan.comint),
        })  # fmt: skip
        self._fill()
        root.append(self._variables)
        root.append(self._structure)
        ET.indent(root)
        return bytes(ET.tostring(root, encoding="utf-8", xml_declaration=True))

    def _fill(self) -> None:
        file, layout = self._file, self._file.layout
        self._variable("time", layout.offset(T, 1), causality="independent", variability="continuous")
        names = state_labels(file.run.values)
        shown = {column.slot for column in file.segment.columns}
        outputs, unknown, derivatives = [], [], []
        for number, slot in enumerate(file.slots):
            at = layout.offset(slot, 1)
            causality = "output" if slot in shown else "local"
            self._variable(names[slot], at, causality, "continuous", "exact", file.run.values.cells[slot])
            outputs += [at] if slot in shown else []
            derivatives.append((names[slot], at, DERIVATIVES + number))
        for name, value in file.run.parameters.items():
            found = slot_of(name, file.run.instance)
            if found is None or name in SYSTEM_VARIABLES:
                continue
            is_input = name in self._inputs
            causality, variability = ("input", "continuous") if is_input else ("parameter", "tunable")
            initial = None if is_input else "exact"
            self._variable(name, layout.offset(found, 1), causality, variability, initial, value)
        for column in file.segment.columns:
            at = layout.offset(column.slot, 1)
            if at not in self._known:
                self._variable(column.name, at, "output", "continuous", "calculated")
                outputs.append(at)
                unknown.append(at)
        for name, at, reference in derivatives:
            self._variable(f"der({name})", reference, "local", "continuous", "calculated", derivative=at)
        for kind, references in (
            ("Output", outputs),
            ("ContinuousStateDerivative", [reference for *_, reference in derivatives]),
            ("InitialUnknown", [*unknown, *(reference for *_, reference in derivatives)]),
        ):
            for reference in references:
                ET.SubElement(self._structure, kind, {"valueReference": str(reference)})

    def _variable(
        self, name: str, reference: int, causality: str, variability: str, initial: str | None = None,
        start: float | None = None, *, derivative: int | None = None,
    ) -> None:  # fmt: skip
        if reference in self._known:
            return
        self._known.add(reference)
        facts = {
            "name": name,
            "valueReference": str(reference),
            "causality": causality,
            "variability": variability,
        }
        if initial is not None:
            facts["initial"] = initial
        if start is not None:
            facts["start"] = repr(start)
        if derivative is not None:
            facts["derivative"] = str(derivative)
        ET.SubElement(self._variables, "Float64", facts)
