"""Faults in what surrounds the code of a segment: the reference back end, defaults, delays, runs, integration."""

from __future__ import annotations

from tests.mutants.anchors import Mutant, program


def _reference(old: str, new: str, *first: str) -> Mutant:
    return Mutant("reference", old, new, first)


def _runtime(old: str, new: str, *first: str) -> Mutant:
    return Mutant("runtime", old, new, first)


def _solver(old: str, new: str, *first: str) -> Mutant:
    return Mutant("integration", old, new, first)


RUNS = (
    # the reference back end
    _reference("if (last or memory.point % memory.every == 0)", "if (memory.point % memory.every == 0)", *program("dynamic/last_of_thinned")),
    _reference("if not fresh and (at < 0 or lag == count):", "if not fresh and at < 0:", *program("dynamic/delay_of_a_whole_buffer")),
    _reference("np.where(mask != 0.0, new, target)", "np.where(mask != 0.0, new, 0.0)", *program("vectors/masked_matrix_keeps")),
    _reference("len(target) - 1 - int(np.argmax(new[::-1]))", "int(np.argmax(new))", "tests/reference/test_arrays.py"),
    _reference("lands = cut = False", "lands = False", *program("dynamic/cut_and_rejected_step")),
    _reference("cells[DT] if memory.steps == 0 else min(memory.dt_least, cells[DT])",
               "min(memory.dt_least, cells[DT])", "tests/integration/test_solver_counts.py"),
    _reference("total += sign * float(", "total += float(", "tests/reference/test_arrays.py"),
    # defaults of a run
    _runtime("abs(t_max) / dt * (1 + ROUNDING) + 1.0", "abs(t_max) / dt + 1.0", *program("dynamic/nn_within_rounding")),
    _runtime("least / 65536", "least / 8", "tests/runtime/test_plan_defaults.py"),
    _runtime("self._supplied.pop(slot, None)", "pass", *program("dynamic/default_made_ones_own", "dynamic/dtmax_made_ones_own")),
    _runtime("if dt is not None and dt == self._steps.left:", "if False:", *program("dynamic/dt_left_by_rule", "dynamic/dt_between_runs")),
    # delays
    _runtime("yield from _lines(action.body, before.copy())", "yield from _lines(action.body, before)", *program("dynamic/delay_time_under_if")),
    _runtime("whole(records, 0, line.count)", "whole(records, 0, line.count - 1)", *program("dynamic/delay_of_a_whole_buffer")),
    _runtime("tau / interval + ROUNDING", "tau / interval", *program("dynamic/delay_time_under_if")),
    # runs and what connects them
    _runtime("every + 1][::2]", "every + 1][1::2]", "tests/runtime/test_pictures.py"),
    _runtime("[*kept, newest] if sample % record.picture_every else kept", "kept", "tests/runtime/test_pictures.py"),
    _runtime("positions.points -= 1", "pass", *program("dynamic/last_of_thinned")),
    _runtime("values.cells[T] if sampled else nan", "values.cells[T]", "tests/runtime/test_after_a_failed_run.py"),
    _runtime("(first, max(length, slot + count - first))", "(first, slot + count - first)", *program("dynamic/reset_of_overlaid_states")),
    _runtime("self.positions = None if start is None", "if start is None", *program("dynamic/get_after_reset")),
    _runtime("self.positions = known if key is None else None", "self.positions = known", *program("dynamic/labelled_runs_begin_anew")),
    _runtime("inf if above else nan", "nan", *program("original/term_at_a_joint")),
    # rules and solvers
    _solver("test=_row(6, 1, -4, 2, 1)", "test=_row(6, 1, -3, 1, 1)", "tests/integration/test_tableaus.py"),
    _solver("_BIAS_DOWN, _BIAS_SAME, _BIAS_UP = 6.0, 6.0, 10.0", "_BIAS_DOWN, _BIAS_SAME, _BIAS_UP = 6.0, 6.0, 6.0", "tests/integration/test_bdf.py"),
    _solver("if s.order == 1 and s.steps > 1:", "if s.order == 1 and s.steps > 2:", "tests/integration/test_bdf.py"),
    _solver("_FACTORS_SERVE_STEPS = 20", "_FACTORS_SERVE_STEPS = 21", "tests/integration/test_solver_counts.py"),
    _solver("serve = 1 if s.doubt > DOUBT_FROM else JACOBIAN_SERVES_STEPS", "serve = 1 if s.doubt > DOUBT_FROM else JACOBIAN_SERVES_STEPS - 1", "tests/integration/test_bdf.py"),
    _solver("s.doubt = min(s.doubt + DOUBT_FAILURE, DOUBT_MOST)", "s.doubt = 0", "tests/integration/test_singularities.py"),
    _solver("_ADAMS_MATRIX = Convergence(6e-2, MATRIX_CONVERGENCE)", "_ADAMS_MATRIX = Convergence(1e-1, 1e-1)", "tests/integration/test_singularities.py"),
    _solver("_ITERATION = Convergence(7e-2, 2e-2, ITERATION_DOUBT_FROM)", "_ITERATION = Convergence(1e-1, 1e-1, ITERATION_DOUBT_FROM)", "tests/integration/test_pulsed_models.py"),
    _solver("s.rate = max(_RATE_FORGETS * s.rate, now / before)", "s.rate = now / before", "tests/integration/test_bdf.py"),
    _solver("scale = 2.0 / (1.0 + ratio)", "scale = 1.0", "tests/integration/test_bdf.py"),
    _solver("if tests >= 2: s.ratio", "if tests > 2:\n            s.ratio", "tests/integration/test_solver_counts.py"),
    _solver('Linear("band", lower=lower, upper=upper)', 'Linear("band", lower=upper, upper=lower)', "tests/integration/test_band_shapes.py"),
    _solver("if width <= max(self.count // n, 8):", "if width <= max(self.count // n, 8) + 8:", "tests/integration/test_band_shapes.py"),
    _solver("for block in range(1, s.block_count):", "for block in range(2, s.block_count):", "tests/taylor/test_long_arrays.py"),
    _solver("s.base_rest[i] = s.rest[i] size =", "s.base_rest[i] = 0.0\n            size =", "tests/taylor/test_long_arrays.py"),
    _solver("most = max(most, abs(s.y[i])) s.most", "pass\n    s.most", "tests/taylor/test_runs.py"),
    # events between the steps of rules 9 to 17
    _solver("if part[0] == 0.0: count += 1", "if part[0] == 0.0:\n        count += 0", "tests/taylor/test_events.py"),
    _solver("left = s.left if found == 0 else min(left, s.left)", "left = s.left", "tests/taylor/test_events.py"),
    _runtime("m.left = min(m.left, left) if found != 0 else left", "m.left = left", "tests/taylor/test_events.py"),
    _runtime("m.left = max(m.left, place)", "pass", "tests/taylor/test_events.py"),
    _runtime("m.fell[i] = s.right", "m.fell[i] = -1.0", "tests/taylor/test_events.py"),
    _runtime("soon = t_next stop", "pass\n    stop", "tests/integration/test_moments_natively.py"),
)  # fmt: skip
