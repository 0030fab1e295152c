"""Faults in what is done with a lowered segment: slices, dead code, the last sample, patterns, derivatives."""

from __future__ import annotations

from tests.mutants.anchors import Mutant, program


def _fault(old: str, new: str, *first: str) -> Mutant:
    return Mutant("passes", old, new, first)


PASSES = (
    # which statements a pass executes
    _fault('if comm or action.kind == "if":', "if True:", *program("dynamic/last_of_thinned")),
Mutant(
        "lowered",
        'return "step" if action.per_step else "point"',
        'return "point"',
        ("tests/passes/test_slices.py",),
    ),
    _fault("kept.append(with_bodies(action, _definitions(action.body), _definitions(action.orelse)))", "pass", "tests/passes/test_jacobian_pass.py"),
    _fault("without_dead_code(definitions + given.body + entries)", "without_dead_code(given.body + entries)", "tests/passes/test_jacobian_pass.py"),
    _fault("return without_dead_code(actions, kept_from_step_pass(actions))", "return without_dead_code(actions)", *program("dynamic/term_and_counter")),
    Mutant(
        "lowered",
        "action.persistent or count_draws(*expressions(action))",
        "action.persistent",
        ("tests/passes/test_slices.py",),
    ),
    Mutant(
        "lowered",
        "action.persistent or count_draws(*expressions(action))",
        "count_draws(*expressions(action))",
        ("tests/passes/test_slices.py",),
    ),
    Mutant(
        "lowered",
        "or (action.mask_slot is not None and isinstance(action, SetMat))",
        "",
        ("tests/passes/test_pattern_of_masks.py",),
    ),
    # the last sample
    _fault('(role(action) == "definition" and id(action) not in computed)', 'role(action) == "definition"', *program("dynamic/output_lag"), *program("dynamic/term_and_relay")),
    _fault("if _reads_any(action, changed): found.update", "if False:\n                found.update", *program("dynamic/term_and_counter")),
    _fault("kept.extend(catch_up(action.body, computed))", "pass", *program("dynamic/term_and_counter")),
    _fault( 'elif timing(action) != "step" and role(action) != "derivative":', 'elif role(action) == "definition":' , *program("dynamic/term_with_thinned_samples")),
    # which derivatives depend on which states
    _fault("self.run(action.body, certain=False) self.run(action.orelse, certain=False)",
           "self.run(action.body, certain=certain)\n                self.run(action.orelse, certain=certain)", "tests/passes/test_exact_jacobians.py"),
    _fault('first = b.first + by if b.kind == "diagonal" else b.first', "first = b.first", "tests/passes/test_differentiate.py"),
    _fault("| _spread(self.of(value.y), count)", "", "tests/passes/test_exact_jacobians.py"),
    # derivatives
    _fault("yield DotTerm(term.sign, term.left, moved)", "yield DotTerm(1.0, term.left, moved)", "tests/passes/test_exact_jacobians.py"),
    _fault("yield MatVec(matrix, value.rows, value.cols, value.transposed,",
           "yield MatVec(matrix, value.rows, value.cols, False,", "tests/passes/test_exact_jacobians.py"),
    _fault("yield SetVec( slot, action.count, value, action.where, action.mode, action.mask_slot, action.persistent )",
           "yield SetVec(slot, action.count, value, action.where, action.mode)", "tests/passes/test_exact_jacobians.py"),
    _fault(
        'isinstance(action, Guard) else role(action) == "effect": raise',
        "isinstance(action, Guard) else False:\n            raise",
        "tests/passes/test_differentiate.py",
    ),
    _fault("return plus(by_x, _table_derivative(", "return plus(None, _table_derivative(", "tests/passes/test_exact_jacobians.py"),
    _fault("for differentiator in differentiators: made += differentiator.tangent(action)",
           "for differentiator in differentiators[:0]:\n            made += differentiator.tangent(action)", "tests/passes/test_exact_jacobians.py"),
    _fault('return plus(base, times(op("comp", x[0], ZERO, op("mul", op("pow", *x), op("ln", x[0]))), d[1]))', "return base", "tests/passes/test_exact_jacobians.py"),
    # derivatives by parameters, and what moments do to them
    _fault('before, behind = self._moved("add", where), self._moved("sub", where)',
           'before, behind = self._moved("add", where), []', "tests/api/test_sensitive_runs.py"),
    _fault('moved = op("add", by_start or ZERO, op("mul", ticks, by_period or ZERO))',
           "moved = by_start or ZERO", "tests/api/test_sensitive_runs.py"),
    _fault('found.append(Set(shift, op("comp", is_first, Load(shift), displaced), where))',
           "found.append(Set(shift, displaced, where))", "tests/api/test_sensitive_runs.py"),
    _fault("passing = [event for mode in finder.modes for event in mode.events()]",
           "passing: list[Event] = []", "tests/api/test_sensitive_runs.py"),
    _fault("self.made.append(DelayedValue(source or Const(0.0), delayed.tau, delayed.where))",
           "self.made.append(DelayedValue(Const(0.0), delayed.tau, delayed.where))", "tests/api/test_sensitive_runs.py"),
    _fault('"sat": _factor(lambda x: op("rect", x))', '"sat": _zero', "tests/passes/test_exact_jacobians.py"),
    _fault('choose(op("sub", x[0], x[1]), d[0], d[1])', 'choose(op("sub", x[0], x[1]), d[1], d[0])', "tests/passes/test_exact_jacobians.py"),
    _fault('"recip": _divisor(lambda x: op("neg", _square(x)))', '"recip": _divisor(_square)', "tests/passes/test_exact_jacobians.py"),
    # regions of memory and intervals
    _fault("ends[-1] = max(ends[-1], slot + count)", "ends[-1] = slot + count", "tests/passes/test_exact_jacobians.py"),
    _fault("last = bisect_right(self.starts, end)", "last = bisect_left(self.starts, end)", "tests/passes/test_intervals.py"),
    _fault("return at >= 0 and self.ends[at] > slot", "return at >= 0 and self.ends[at] >= slot", "tests/passes/test_intervals.py"),
    # which steps end where samples are taken
    _fault("_set_outside(segment, conditions=True)", "_set_outside(segment)", "tests/taylor/test_events.py"),
    _fault("elif id(action) not in own:", "elif False:", "tests/taylor/test_events.py"),
    # terms of sums with constant factors
    _fault("Constant(Const(-constant.value.value), constant.slot, None)", "Constant(Const(constant.value.value), constant.slot, None)", "tests/taylor/test_coefficients.py"),
    _fault('term, factor if node.kind == "add" else self._negated(factor)', "term, factor", "tests/taylor/test_coefficients.py"),
)  # fmt: skip
