"""All messages together: numbers, tone, and that a test produces every one of them."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from desire_tui.engine.diagnostics import Diagnostic
from desire_tui.engine.diagnostics.wording import all_wordings
from tests.messages.test_messages import FILES, spoken

ROOT = Path(__file__).parents[2]
ELSEWHERE = {
    "no-headway": "tests/integration/test_headway.py::test_runs_without_end_are_errors",
    "data-empty": "tests/interpreter/test_data_file.py::test_files_without_measurements",
    "data-ragged": "tests/interpreter/test_data_file.py::test_everything_that_is_wrong_at_once",
    "data-cell": "tests/interpreter/test_data_file.py::test_everything_that_is_wrong_at_once",
    "data-library": "tests/interpreter/test_data_file.py::test_excel_without_its_library",
    "initial-unknown": "tests/api/test_model.py::test_states_and_quantities_that_are_not_there_are_named",
    "record-unknown": "tests/api/test_model.py::test_states_and_quantities_that_are_not_there_are_named",
    "equations-missing": "tests/api/test_equations.py::test_derivatives_that_are_no_function_of_t_and_the_states",
    "equations-impure": "tests/api/test_equations.py::test_derivatives_that_are_no_function_of_t_and_the_states",
    "graph-missing": (
        "tests/batch/test_headless.py::test_without_a_graph_data_are_written_and_pictures_are_a_warning"
    ),
    "solver-corrector-part": (
        "tests/session/test_fault_place.py::test_a_corrector_that_met_a_root_of_a_negative_number_says_so"
    ),
    "solver-derivative": (
        "tests/session/test_fault_place.py::test_of_a_large_model_no_copy_is_kept_and_the_solver_speaks"
    ),
    "no-help": "tests/messages/test_machine_messages.py::test_a_help_page_that_is_not_there",
    "line-too-long": "tests/syntax/test_limits.py::test_hostile_text_gets_a_message_at_once",
    "too-many-lines": "tests/messages/test_machine_messages.py::test_submodels_that_become_too_many_lines",
    "no-program": "tests/messages/test_machine_messages.py::test_no_program",
    "out-of-memory": "tests/messages/test_machine_messages.py::test_no_room_for_an_array",
    "array-too-large": "tests/messages/test_machine_messages.py::test_an_array_beyond_the_machine",
    "memory-exhausted": "tests/messages/test_machine_messages.py::test_memory_that_ends_in_the_middle",
    "cannot-read": "tests/messages/test_machine_messages.py::test_a_channel_that_cannot_be_read",
    "cannot-write": "tests/messages/test_machine_messages.py::test_a_channel_whose_disk_is_full",
    "solver-error-test": "tests/messages/test_machine_messages.py::test_what_the_stiff_solver_gives_up_with",
    "solver-corrector": "tests/messages/test_machine_messages.py::test_what_the_stiff_solver_gives_up_with",
    "solver-singular": "tests/messages/test_machine_messages.py::test_what_the_stiff_solver_gives_up_with",
    "solver-linear": "tests/messages/test_machine_messages.py::test_what_the_stiff_solver_gives_up_with",
    "solver-too-close": "tests/messages/test_machine_messages.py::test_what_the_stiff_solver_gives_up_with",
    "solver-broken": "tests/messages/test_machine_messages.py::test_what_the_stiff_solver_gives_up_with",
    "solver-missing": "tests/integration/test_without_sundials.py::test_other_rules_say_what_is_missing",
    "solver-version": "tests/integration/test_sundials.py::test_another_version_is_refused",
    "stopped-by-user": "tests/runtime/test_run_control.py::test_pause_resume_and_end",
    "go-after-edit": "tests/runtime/test_run_control.py::test_go_after_an_edit_is_refused",
    "notebook-lost": "tests/session/test_notebook.py::test_a_disk_that_fills_up_costs_the_notebook_not_the_run",
    "notebook-vanished": "tests/session/test_notebook.py::test_a_file_that_vanishes_begins_anew_and_says_so",
    "internal-error": "tests/batch/test_internal_faults.py::test_in_python",
    "fast-code-missing": "tests/codegen/test_background_faults.py::test_the_user_is_told_once",
    "check-incomplete": "tests/check/test_time_limit.py::test_a_check_that_is_stopped_tells_what_it_found_and_where_it_stopped",
    "check-too-long": "tests/app/test_live_check.py::test_a_text_that_is_not_checked_is_said",
    "errors-not-reached": "tests/batch/test_unreached_errors.py::test_a_warning_counts_what_was_not_reached",
    "time-limit": "tests/batch/test_headless.py::test_timeout_is_status_3",
    "set-unknown": "tests/batch/test_headless.py::test_a_setting_the_program_has_no_use_for",
    "set-array": "tests/batch/test_headless.py::test_a_setting_the_program_has_no_use_for",
    "set-no-array": "tests/batch/test_headless.py::test_a_setting_the_program_has_no_use_for",
    "program-missing": "tests/batch/test_headless.py::test_files_that_are_no_programs",
    "file-unreadable": "tests/batch/test_headless.py::test_files_that_are_no_programs",
    "study-form": "tests/studies/test_forms.py::test_what_cannot_be_kept",
    "study-twice": "tests/studies/test_forms.py::test_what_varies_twice",
    "study-empty": "tests/studies/test_forms.py::test_studies_of_no_runs",
    "study-too-large": "tests/studies/test_study.py::test_a_study_too_large_for_the_machine_is_refused_with_its_size",
    "study-store": "tests/studies/test_stores.py::test_another_study_does_not_go_on_with_a_store",
    "study-store-there": "tests/studies/test_stores.py::test_another_study_does_not_go_on_with_a_store",
    "study-cluster": "tests/studies/test_cluster.py::test_a_scheduler_that_is_not_there",
    "study-library": "tests/studies/test_study.py::test_a_library_that_is_missing_is_said_first",
    "study-computed": "tests/studies/test_settable.py::test_what_the_segment_computes_anyway_is_refused",
    "study-no-run": "tests/studies/test_study.py::test_a_script_without_a_run",
    "analysis-form": "tests/analysis/test_request.py::test_mistakes_are_told_at_their_place",
    "export-compiler": "tests/export/test_fmu.py::test_without_a_compiler_it_is_said",
    "export-refused": "tests/export/test_c.py::test_all_that_has_no_form_is_named_at_once",
    "analysis-failed": "tests/analysis/test_spectrum.py::test_a_run_of_few_samples_says_nothing",
    "analysis-library": "tests/analysis/test_front_ends.py::test_a_library_that_is_missing_is_named",
    "convert-part": (
        "tests/convert/test_command.py::test_what_is_missing_keeps_a_program_back_unless_it_is_asked_for"
    ),
    "convert-note": "tests/convert/test_command.py::test_options_without_a_meaning_are_listed_and_methods_told",
    "convert-renamed": "tests/convert/test_command.py::test_a_converted_program_runs_and_writes_its_samples",
    "convert-library": "tests/convert/test_sbml.py::test_without_the_library_its_extra_is_named",
    "convert-unreadable": "tests/convert/test_sbml.py::test_files_that_are_no_sbml",
    "convert-kind": "tests/convert/test_command.py::test_files_that_are_no_models",
    "file-binary": "tests/batch/test_headless.py::test_files_that_are_no_programs",
}
"""Messages that no program text alone produces, and the tests that do."""


@pytest.mark.parametrize("key", sorted(all_wordings()))
def test_sentence(key: str) -> None:
    wording = all_wordings()[key]
    assert wording.code > 0 or wording.message.endswith("here"), "only a second place needs no number"
    assert wording.message
    assert not wording.message.endswith("."), "one sentence, no full stop"
    assert Diagnostic(key).message, "it can be said without facts, as summaries do"
    assert not re.search(r"\b(illegal|invalid)\b", wording.message), "say what is wrong, not that it is"


def test_every_message_is_produced_by_a_golden_file() -> None:
    produced = frozenset[str]().union(*(spoken(path)[1] for path in FILES))
    known = all_wordings().keys()
    assert not sorted(known - produced - ELSEWHERE.keys()), "worded, but no file shows it"
    assert not sorted(ELSEWHERE.keys() & produced), "a file shows it: no need for another test"
    assert ELSEWHERE.keys() <= known


def test_a_problem_is_a_warning_where_its_wording_says_so() -> None:
    """`compare` takes warnings about settings for errors: it would compare with another run."""
    found = frozenset[tuple[str, str]]().union(*(spoken(path)[2] for path in FILES if path.stem != "compare"))
    wrong = [
        (key, severity) for key, severity in found if (severity == "warning") != all_wordings()[key].warning
    ]
    assert not wrong


@pytest.mark.parametrize("key", sorted(ELSEWHERE))
def test_the_other_tests_are_there(key: str) -> None:
    path, _, name = ELSEWHERE[key].partition("::")
    tree = ast.parse((ROOT / path).read_text("utf-8"))
    assert name in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
