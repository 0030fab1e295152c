"""Faults in the native code: fusion, rerolling, strips, tables, random numbers, the run loop, steps, callbacks."""

from __future__ import annotations

from tests.mutants.anchors import Mutant, program


def _vector(old: str, new: str, *first: str) -> Mutant:
    return Mutant("codegen/vector", old, new, first)


def _scalar(old: str, new: str, *first: str) -> Mutant:
    return Mutant("codegen/scalar", old, new, first)


def _loop(old: str, new: str, *first: str) -> Mutant:
    return Mutant("codegen/loop", old, new, first)


def _taylor(old: str, new: str, *first: str) -> Mutant:
    return Mutant("codegen/taylor", old, new, first)


def _stiff(old: str, new: str, *first: str) -> Mutant:
    return Mutant("codegen/stiff", old, new, first)


CODEGEN = (
    # which array statements share a loop
    _vector("and not any_overlap(footprint.writes, total.elsewhere)", "", "tests/codegen/test_fusion.py"),
    _vector("and not any_overlap(footprint.elsewhere, total.writes)", "", "tests/codegen/test_fusion.py"),
    _vector("and not _partial_overlap(footprint.elementwise | footprint.writes, total.writes)", "", "tests/codegen/test_fusion.py"),
    _vector("and not _partial_overlap(footprint.writes, total.elementwise)", "", "tests/codegen/test_fusion.py"),
    _vector("return overwrites or _partial_overlap(footprint.writes, footprint.elementwise)",
            "return overwrites", "tests/codegen/test_fusion.py"),
    _vector("return overwrites or _partial_overlap(footprint.writes, footprint.elementwise)",
            "return _partial_overlap(footprint.writes, footprint.elementwise)", "tests/codegen/test_fusion.py"),
    # strips and elements
    _vector("icmp ult i64 {index}, {count}", "icmp ule i64 {index}, {count}", *program("vectors/shifts_beyond_the_end")),
    _vector("low, high = min(below, count), max(count - above, 0)", "low, high = min(below, count), count", *program("vectors/shifts_beyond_the_end")),
    _vector("-self.strip.active * self.prepared.per_element", "-self.lanes.width * self.prepared.per_element", "tests/codegen/test_random.py", *program("vectors/random_order")),
    _vector("(count - 1 - lane) * per_element", "(count - lane) * per_element", "tests/codegen/test_random.py"),
    _vector("lanes.choose(free, value, strip.fetch(self._own))", "lanes.choose(free, value, lanes.const(0.0))", *program("vectors/masked_matrix_keeps")),
    _vector("op(f\"select i1 {op(f'icmp slt i64 {rest}, 0')}, i64 {lifted}, i64 {rest}\")", "rest", *program("vectors/shifts_beyond_the_end")),
    # scalar statements as loops
    _scalar("a == b and type(a) is type(b) and (a != 0 or str(a) == str(b))", "a == b and type(a) is type(b)", "tests/codegen/test_minus_zero.py"),
    _scalar("operand != first and operand < first + count and first < operand + count",
            "operand > first and operand < first + count", "tests/codegen/test_rerolling.py"),
    _scalar("first <= slot < first + count for slot in operand", "first < slot < first + count for slot in operand", "tests/codegen/test_rerolled_reads.py"),
    _scalar('frozenset((*C_FUNCTIONS, "sinc", "sigmoid"))', "frozenset(())", "tests/codegen/test_rerolling.py"),
    _scalar("if any(slot <= s < slot + count", "if any(slot < s < slot + count", "tests/codegen/test_registers.py"),
    _scalar('f"or i1 {later}, {alone}"', 'f"or i1 {alone}, {alone}"', *program("dynamic/last_of_thinned")),
    _scalar("icmp ne i64 {lag}, {count}", "icmp ne i64 {lag}, -1", *program("dynamic/delay_of_a_whole_buffer")),
    # tables and random numbers
    Mutant("codegen/ir", "%k2 = call i64 @llvm.smin.i64(i64 %knext, i64 %m1)",
           "%k2 = call i64 @llvm.smin.i64(i64 %knext, i64 %n1)", (*program("dynamic/wide_and_tall_tables"),)),
    Mutant(".", "(_INVERSE, -_INVERSE * INCREMENT & MASK)", "(_INVERSE, INCREMENT)", ("tests/codegen/test_random.py",)),
    # points, samples, steps
    _loop('text.branch(text.op(f"or i1 {last}, {due}"), "sample"', 'text.branch(due, "sample"', *program("dynamic/last_of_thinned")),
    _loop('return lanes.compare("oge", self.storage.load(T), lanes.sub(end, slack))',
          'return lanes.compare("oge", self.storage.load(T), end)', *program("dynamic/end_within_rounding")),
    _loop("self.storage.keep_first_stage()", "pass", "tests/codegen/test_run_loop.py"),
    _loop('driver.put("t_base", here)', "pass", "tests/numerics"),
    _loop('limit = lanes.sub(self.driver.get("t_next"), slack)', 'limit = self.driver.get("t_next")', *program("dynamic/end_within_rounding")),
    _loop('driver.put("cut", "0")', "pass", *program("dynamic/cut_and_rejected_step")),
    _loop("lanes.compare('olt', dt, least)", "lanes.compare('ogt', dt, least)", *program("dynamic/least_step")),
    _loop('stuck = lanes.compare("olt", half', 'stuck = lanes.compare("ole", half', "tests/codegen/test_run_loop.py", "tests/numerics"),
    _loop('lanes.choose(lanes.compare("olt", doubled, most), doubled, most)', "doubled", "tests/numerics"),
    _loop('mine = text.op(f"icmp eq i64 {checked}, {number + 1}")',
          'mine = text.op(f"icmp eq i64 {checked}, {number}")', "tests/codegen/test_registers.py"),
    # stiff rules
    _stiff("return Ended.TERM synchronise(problem)", "return Ended.TERM", "tests/integration/test_stiff_runs.py"),
    _stiff("if first or size < memory.dt_least:", "if size < memory.dt_least:", "tests/integration/test_stiff_runs.py"),
    _stiff("problem.jacobian_calls += 1", "problem.jacobian_calls += 2", "tests/integration/test_both_back_ends.py"),
    _stiff("directions[seeds[i]] = 0.0", "directions[seeds[i]] = 1.0", "tests/integration/test_stiff_runs.py"),
    _stiff("largest[i] = size", "largest[i] = abs(y[i])", "tests/integration/test_both_back_ends.py"),
    _stiff("moved[seeds[i]] = y[seeds[i]]", "moved[seeds[i]] = moved[seeds[i]]", "tests/integration/test_both_back_ends.py"),
    _stiff("return GIVE_UP if problem.method == Matrix.PROGRAM else GO_BACK", "return GO_BACK",
           "tests/integration/test_stiff_runs.py"),
    # Taylor series
    _taylor('margin = text.op(f"mul i64 %p, {self.layout.reach}")', 'margin = text.op(f"mul i64 %p, {self.layout.reach - 1}")', "tests/taylor/test_long_arrays.py"),
    _taylor('gone = text.op(_smaller(text, str(abs(by)), "%m"))', 'gone = "0"', "tests/taylor/test_long_arrays.py"),
    _taylor("taken[i] = width + lane.at", "taken[i] = lane.at", "tests/taylor/test_coefficients.py"),
    _taylor("if exponent not in _ROOTS:", "if exponent is None:", "tests/taylor/test_coefficients.py"),
    _taylor("lanes.mul_add(lanes.const(2.0), total, lanes.mul(middle, other))", "lanes.add(total, lanes.mul(middle, other))", "tests/taylor/test_coefficients.py"),
    _taylor("self.kept | {d.number for d in derivatives if isinstance(d, Series)}", "self.kept | set(derivatives)", "tests/taylor/test_long_arrays.py"),
)  # fmt: skip
