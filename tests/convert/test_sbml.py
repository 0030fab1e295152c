"""SBML converted and run, against exact solutions: one test for each group of the semantic test suite's tags."""

from __future__ import annotations

from math import acosh, asinh, atan, atanh, cosh, exp, factorial, sinh, tan

import pytest

import desire_tui
from desire_tui.convert.conversion import Conversion, convert
from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.source import Source
from tests.convert.sbml_text import Sbml


def converted(model: Sbml | str) -> Conversion:
    return convert(Source(model if isinstance(model, str) else model.text, "model.xml"))


def at(model: Sbml | str, end: float, *names: str) -> list[float]:
    """Return quantities at a time, by the converted program run up to it."""
    conversion = converted(model)
    assert conversion.complete, conversion.problems
    renamed = {p.facts["old"]: p.facts["new"] for p in conversion.problems if p.key == "convert-renamed"}
    wanted = [str(renamed.get(name, name)) for name in names]
    run = desire_tui.load(conversion.text).run(t=(0, end), record=wanted, check=True)
    return [float(run[name][-1]) for name in wanted]


def decay(**species: float | bool) -> Sbml:
    """A -> B with the rate constant 0.5 in a compartment of 2."""
    start = species or {"concentration": 3.0}
    return (
        Sbml().compartment("c", 2).species("A", **start)
        .species("B", amount=0, amounts_only=start.get("amounts_only", False))
        .parameter("k", 0.5)
    )  # fmt: skip


def test_concentrations_in_a_compartment_that_is_not_1():
    """Rates are amounts in a unit of time: with k·A·c the concentration falls as exp(-k·t)."""
    left = 3 * exp(-1)
    assert at(decay().reaction("J", "A -> B", "k*A*c"), 2, "A", "B") == pytest.approx(
        [left, 3 - left], rel=1e-6
    )
    # without the compartment the amount changes by k·[A]: half as fast
    assert at(decay().reaction("J", "A -> B", "k*A"), 2, "A") == pytest.approx([3 * exp(-0.5)], rel=1e-6)


def test_amounts():
    """An initial amount of 3 is a concentration of 1.5; with hasOnlySubstanceUnits the name is the amount."""
    assert at(decay(amount=3.0).reaction("J", "A -> B", "k*A*c"), 2, "A") == pytest.approx(
        [1.5 * exp(-1)], rel=1e-6
    )
    only = decay(amount=3.0, amounts_only=True).reaction("J", "A -> B", "k*A")
    assert at(only, 2, "A", "B") == pytest.approx([3 * exp(-1), 3 - 3 * exp(-1)], rel=1e-6)
    by_concentration = decay(concentration=3.0, amounts_only=True).reaction("J", "A -> B", "k*A")
    assert at(by_concentration, 2, "A") == pytest.approx([6 * exp(-1)], rel=1e-6)
    sizeless = Sbml().compartment("c", None, dimensions=0).species("A", amount=4).parameter("k", 0.5)
    assert at(sizeless.reaction("J", "A ->", "k*A"), 2, "A") == pytest.approx([4 * exp(-1)], rel=1e-6)


def test_stoichiometries_local_parameters_boundary_and_constant_species():
    model = (
        Sbml().compartment("c").species("A", amount=1).species("B", amount=0)
        .species("X", amount=2, boundary=True).species("K", amount=3, boundary=True, constant=True)
        .parameter("k", 99).reaction("J", "2 A + X + K -> 3 B", "k*A*X*K", k=0.1)
    )  # fmt: skip
    left = exp(-2 * 0.1 * 2 * 3)
    assert at(model, 1, "A", "B", "X", "K") == pytest.approx([left, 1.5 * (1 - left), 2, 3], rel=1e-6)


def test_stoichiometries_that_are_assigned():
    model = (
        Sbml().compartment("c").species("A", amount=1).species("B", amount=0).parameter("n", 2)
        .reaction("J", "A -> m:B", "0.5").initially("m", "n + 1")
    )  # fmt: skip
    assert at(model, 1, "A", "B") == pytest.approx([0.5, 1.5], rel=1e-6)
    varying = (
        Sbml().compartment("c").species("A", amount=1).species("B", amount=0)
        .reaction("J", "A -> m:B", "0.5").assignment("m", "1 + time")
    )  # fmt: skip
    assert at(varying, 2, "B") == pytest.approx([0.5 * (2 + 2)], rel=1e-6)


def test_conversion_factors():
    model = Sbml().compartment("c").parameter("f", 4).species("A", amount=0, factor="f")
    assert at(model.reaction("J", "-> A", "0.5"), 1, "A") == pytest.approx([2], rel=1e-6)


def test_rules_in_any_order_and_initial_assignments_through_them():
    model = (
        Sbml().compartment("c").parameter("z", constant=False).parameter("y", constant=False)
        .parameter("x", 1, constant=False).parameter("p", 7).species("S", amount=1, boundary=True)
        .assignment("z", "2*y").assignment("y", "x + 1").rate("x", "-x*p").rate("S", "S")
        .initially("x", "q*3").parameter("q").initially("q", "z0 + 1").parameter("z0", 1).initially("p", "z/14")
    )  # fmt: skip
    # q = 2, x = 6, y = 7, z = 14, p = 1
    assert at(model, 1, "x", "z", "S") == pytest.approx(
        [6 * exp(-1), 2 * (6 * exp(-1) + 1), exp(1)], rel=1e-6
    )


def test_a_compartment_that_grows_thins_what_is_in_it():
    """Amounts stay: what reacts by k·A·c, what does not, and what has only amounts."""
    model = (
        Sbml().compartment("c", 2, constant=False).species("A", concentration=3).species("I", amount=4)
        .species("N", amount=5, amounts_only=True).parameter("k", 0.5)
        .rate("c", "1").reaction("J", "A ->", "k*A*c")
    )  # fmt: skip
    assert at(model, 2, "c", "A", "I", "N") == pytest.approx([4, 6 * exp(-1) / 4, 1, 5], rel=1e-6)
    by_rule = (
        Sbml().compartment("c", 1, constant=False).species("I", concentration=4).assignment("c", "1 + time")
    )
    assert at(by_rule, 3, "I") == pytest.approx([1], rel=1e-6)


def test_functions_piecewise_and_time():
    model = (
        Sbml().compartment("c").function("f", "lambda(a, b, a*g(b))").function("g", "lambda(t, t^2)")
        .parameter("x", 0, constant=False).rate("x", "f(2, time) + piecewise(1, time < 1, 0)")
    )  # fmt: skip
    assert at(model, 2, "x") == pytest.approx([2 * 8 / 3 + 1], rel=1e-4)


def test_uncommon_functions():
    formulas = {
        "root(3, 8)": 2, "log(2, 8)": 3, "log10(1000)": 3, "factorial(5)": factorial(5),
        "quotient(-7, 2)": -3, "rem(-7, 2)": -1, "max(1, 5, 3)": 5, "min(4, 2, 3)": 2, "sec(0)": 1,
        "cot(1)": 1/tan(1), "csch(1)": 1/sinh(1), "sech(1)": 1/cosh(1), "arcsinh(1)": asinh(1),
        "arccosh(2)": acosh(2), "arctanh(0.5)": atanh(0.5), "arccot(2)": atan(0.5), "arccoth(2)": atanh(0.5),
        "arcsech(0.5)": acosh(2), "arccsch(0.5)": asinh(2), "xor(1 < 2, 2 < 1)": 1, "implies(1 < 2, 2 < 1)": 0,
        "piecewise(1, (1 < 2) && (2 < 3), 0)": 1, "exponentiale": exp(1), "avogadro/6.02214179e23": 1,
        "ceil(1.2) + floor(-1.2)": 0, "abs(-3)": 3, "ln(exponentiale)": 1, "2^-1": 0.5,
    }  # fmt: skip
    model = Sbml(3, 2)
    for k, formula in enumerate(formulas):
        model.parameter(f"p{k}", constant=False).assignment(f"p{k}", formula)
    assert at(model, 1, *(f"p{k}" for k in range(len(formulas)))) == pytest.approx(list(formulas.values()))


def test_derivatives_in_formulas():
    model = Sbml(3, 2).compartment("c").parameter("x", 1, constant=False).rate("x", "-2*x")
    model.parameter("y", constant=False).assignment("y", "rateOf(x)")
    assert at(model, 1, "y") == pytest.approx([-2 * exp(-2)], rel=1e-6)


def test_delays():
    """x' = -x(t - 1) from 1: at 2 it is -0.5."""
    model = Sbml().compartment("c").parameter("x", 1, constant=False).rate("x", "-delay(x, 1)")
    assert at(model, 2, "x") == pytest.approx([-0.5], abs=1e-5)


def counting(*events: tuple, end: float = 10.0, **kinds: object) -> list[float]:
    """Return x (which rises as t from 0, from k where an event sets it) and n at the end."""
    model = Sbml().compartment("c").parameter("x", 0, constant=False).parameter("n", 0, constant=False)
    model.rate("x", "1")
    for k, (when, then, *more) in enumerate(events):
        model.event(f"E{k}", when, then, **(more[0] if more else kinds))
    return at(model, end, "x", "n")


def test_events_and_what_they_set():
    assert counting(("x > 3", {"x": "0", "n": "n + 1"})) == pytest.approx([1, 3], rel=1e-6)
    # all values are taken before the first is assigned
    assert counting(("time > 4.5", {"x": "n", "n": "x"})) == pytest.approx([5.5, 4.5], rel=1e-6)
    assert counting(("eq(time, 4.5)", {"x": "0"}))[0] == pytest.approx(5.5, rel=1e-6)
    assert counting(("(x > 3) && (time > 4.5)", {"n": "x"}))[1] == pytest.approx(4.5, rel=1e-6)
    assert counting(("(x > 3) || (time > 4.5)", {"n": "x"}))[1] == pytest.approx(3, rel=1e-6)
    assert counting(("!(x < 3)", {"n": "x"}))[1] == pytest.approx(3, rel=1e-6)


def test_events_at_the_start():
    assert counting(("x < 1", {"n": "5"}), initial=True)[1] == 0
    assert counting(("x < 1", {"n": "5"}), initial=False)[1] == 5


def test_events_with_delays():
    assert counting(("time > 2", {"n": "x"}), delay="1.5")[1] == pytest.approx(2, rel=1e-6)
    assert counting(("time > 2", {"n": "x"}), delay="1.5", values_then=False)[1] == pytest.approx(
        3.5, rel=1e-6
    )
    gone = ("(time > 2) && (time < 3)", {"n": "7"})
    assert counting(gone, delay="1.5", persistent=True)[1] == 7
    assert counting(gone, delay="1.5", persistent=False)[1] == 0
    assert counting(gone, delay="0.5", persistent=False)[1] == 7


def test_priorities():
    first, last = ("time > 2", {"n": "1"}, {"priority": "5"}), ("time > 2", {"n": "2"}, {"priority": "-3"})
    assert counting(first, last)[1] == 2
    assert counting(last, first)[1] == 2
    # values are those from before both, unless the event says that they are not
    double = {"n": "2*n + 1"}
    assert counting(("time > 2", {"n": "5"}, {"priority": "9"}), ("time > 2", double))[1] == 1
    late = {"values_then": False}
    assert counting(("time > 2", {"n": "5"}, {"priority": "9"}), ("time > 2", double, late))[1] == 11


def test_events_on_compartments_and_amounts():
    model = (
        Sbml().compartment("c", 2, constant=False).species("A", concentration=3).species("B", concentration=1)
        .event("E", "time > 1", {"c": "4"}).event("F", "time > 2", {"B": "7"})
    )  # fmt: skip
    assert at(model, 3, "A", "B") == pytest.approx([1.5, 7], rel=1e-6)


def test_levels_1_and_2():
    """Level 2 has stoichiometries as formulas, level 1 formulas as text."""
    two = (
        Sbml(2, 4).compartment("c", 2).species("A", concentration=1).species("B", concentration=0)
        .parameter("n", 3).reaction("J", "A -> B", "k*A*c", k=0.5)
    )  # fmt: skip
    reference = two.model.getReaction(0).getProduct(0)
    reference.unsetStoichiometry()
    import libsbml

    reference.createStoichiometryMath().setMath(libsbml.parseL3Formula("n - 1"))
    assert at(two, 2, "A", "B") == pytest.approx([exp(-1), 2 * (1 - exp(-1))], rel=1e-6)
    one = Sbml(1, 2).compartment("c", 1).species("A", amount=1).parameter("k", 0.5)
    assert at(one.reaction("J", "A ->", "k*A"), 2, "A") == pytest.approx([exp(-1)], rel=1e-6)


def test_names_of_the_model_and_of_desire():
    model = Sbml().compartment("c").parameter("t", 2).parameter("DT", 3).parameter("_x", 1, constant=False)
    assert at(model.rate("_x", "t*DT*time"), 1, "_x") == pytest.approx([4], rel=1e-6)


@pytest.mark.parametrize(
    ("written", "reason"),
    [
        (lambda: Sbml().compartment("c").parameter("x", constant=False).algebraic("x - 1"), "algebraic equations"),
        (lambda: Sbml().compartment("c").parameter("x", constant=False).assignment("x", "factorial(time)"), "factorial"),
        (lambda: Sbml().parameter("x", constant=False).assignment("x", "time").event("E", "(x == 1) || (x > 2)", {}),
         "two quantities are equal at moments"),
        (lambda: Sbml().parameter("x", constant=False).event("E", "time > 1", {"x": "1"}, priority="x"), "a priority"),
    ],
)  # fmt: skip
def test_what_cannot_be_converted_is_named_with_its_line(written, reason):
    model = written()
    errors = [problem for problem in converted(model).problems if problem.severity == "error"]
    assert len(errors) == 1
    assert reason in errors[0].message
    assert errors[0].line is not None
    tag = model.text.splitlines()[errors[0].line - 1]
    assert any(word in tag for word in ("algebraicRule", "assignmentRule", "event"))


def test_files_that_are_no_sbml():
    for text, reason in (
        ("<a></a>", "SBML XML document"),
        ("<sbml>", ""),
        ("<?xml version='1.0'?><html/>", ""),
    ):
        with pytest.raises(DesireError) as error:
            converted(text)
        assert error.value.number == 565
        assert reason in error.value.message


def test_rules_that_wait_for_each_other():
    model = Sbml().parameter("a", constant=False).parameter("b", constant=False)
    with pytest.raises(DesireError, match="these wait for each other: a → b → a"):
        converted(model.assignment("a", "b").assignment("b", "a"))


def test_without_the_library_its_extra_is_named(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "libsbml", None)
    with pytest.raises(DesireError) as error:
        convert(Source("<sbml/>", "model.xml"))
    assert error.value.hint == "pip install 'desire-tui[convert]'"
