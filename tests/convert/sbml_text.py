"""SBML as text, for tests: models in a line for each part, written by libSBML."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import libsbml


class Sbml:
    """A model under construction; formulas are in libSBML's notation (`k*S1`, `time`, `piecewise(…)`)."""

    def __init__(self, level: int = 3, version: int = 1) -> None:
        import libsbml  # a tenth of what importing all tests takes

        self.document = libsbml.SBMLDocument(level, version)
        self.model = self.document.createModel()
        self.model.setId("m")

    @property
    def text(self) -> str:
        import libsbml

        return libsbml.writeSBMLToString(self.document)

    def compartment(self, name: str, size: float | None = 1.0, **more: object) -> Sbml:
        one = self.model.createCompartment()
        one.setId(name)
        one.setConstant(bool(more.get("constant", True)))
        one.setSpatialDimensions(more.get("dimensions", 3))
        if size is not None:
            one.setSize(size)
        return self

    def species(self, name: str, compartment: str = "c", **more: float | bool | str) -> Sbml:
        one = self.model.createSpecies()
        one.setId(name)
        one.setCompartment(compartment)
        one.setBoundaryCondition(bool(more.get("boundary", False)))
        one.setConstant(bool(more.get("constant", False)))
        one.setHasOnlySubstanceUnits(bool(more.get("amounts_only", False)))
        if "amount" in more:
            one.setInitialAmount(float(more["amount"]))
        if "concentration" in more:
            one.setInitialConcentration(float(more["concentration"]))
        if "factor" in more:
            one.setConversionFactor(str(more["factor"]))
        return self

    def parameter(self, name: str, value: float | None = None, *, constant: bool = True) -> Sbml:
        one = self.model.createParameter()
        one.setId(name)
        one.setConstant(constant)
        if value is not None:
            one.setValue(value)
        return self

    def reaction(self, name: str, scheme: str, rate: str, **local: float) -> Sbml:
        """Add a reaction such as `2 A + B -> n:C`; `n:` names the stoichiometry."""
        one = self.model.createReaction()
        one.setId(name)
        one.setReversible(False)
        one.setFast(False)
        for side, create in zip(scheme.split("->"), (one.createReactant, one.createProduct), strict=True):
            for term in filter(None, (part.strip() for part in side.split("+"))):
                found = re.fullmatch(r"(?:(\w+):)?([\d.]+\s+)?(\w+)", term)
                assert found is not None, term
                reference = create()
                reference.setSpecies(found[3])
                reference.setConstant(found[1] is None)
                if found[1]:
                    reference.setId(found[1])
                if found[2] or not found[1]:
                    reference.setStoichiometry(float(found[2] or 1))
        law = one.createKineticLaw()
        for key, value in local.items():
            parameter = law.createLocalParameter() if self.document.getLevel() == 3 else law.createParameter()
            parameter.setId(key)
            parameter.setValue(value)
        law.setMath(_math(rate))
        return self

    def assignment(self, name: str, formula: str) -> Sbml:
        one = self.model.createAssignmentRule()
        one.setVariable(name)
        one.setMath(_math(formula))
        return self

    def rate(self, name: str, formula: str) -> Sbml:
        one = self.model.createRateRule()
        one.setVariable(name)
        one.setMath(_math(formula))
        return self

    def algebraic(self, formula: str) -> Sbml:
        self.model.createAlgebraicRule().setMath(_math(formula))
        return self

    def initially(self, name: str, formula: str) -> Sbml:
        one = self.model.createInitialAssignment()
        one.setSymbol(name)
        one.setMath(_math(formula))
        return self

    def function(self, name: str, formula: str) -> Sbml:
        one = self.model.createFunctionDefinition()
        one.setId(name)
        one.setMath(_math(formula))
        return self

    def event(self, name: str, when: str, then: dict[str, str], **more: object) -> Sbml:
        one = self.model.createEvent()
        one.setId(name)
        one.setUseValuesFromTriggerTime(bool(more.get("values_then", True)))
        trigger = one.createTrigger()
        trigger.setMath(_math(when))
        trigger.setInitialValue(bool(more.get("initial", True)))
        trigger.setPersistent(bool(more.get("persistent", True)))
        if "delay" in more:
            one.createDelay().setMath(_math(str(more["delay"])))
        if "priority" in more:
            one.createPriority().setMath(_math(str(more["priority"])))
        for target, formula in then.items():
            assignment = one.createEventAssignment()
            assignment.setVariable(target)
            assignment.setMath(_math(formula))
        return self


def _math(formula: str) -> libsbml.ASTNode:
    import libsbml

    node = libsbml.parseL3Formula(formula)
    assert node is not None, libsbml.getLastParseL3Error()
    return node
