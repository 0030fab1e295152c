"""Facts about programs of the original [compatibility.md], and the programs that show each: three at least, of different shape."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Fact:
    """What programs of the original hold or expect; the shared program that shows it first; how its text shows; others."""

    title: str
    first: tuple[str, ...]
    form: str
    """A regular expression that each program's text holds (in several rows, `.` stays within one)."""
    programs: tuple[str, ...]
    """Below tests/programs, without `.src`."""
    wrong: str
    """A statement that is really wrong: a golden file in tests/messages quotes it above its caret."""
    command: str = ""
    """The same on the command line: a text in tests/session/test_older_spellings_as_commands.py."""


FACTS = (
    Fact("`_` joins the next row without a break", ("continuation_anywhere",), r"\w_ *\n *\w",
         ("script/joined_keywords", "script/continued_strings", "script/continued_definitions", "dynamic/continued_rows",
          "errors/continued_rows"), "y = 1.2_",
         "del_\\nta h = v"),
    Fact("`edit`, `ed`, `list`, `auto` with lines", ("edit_in_a_script",), r"\b(edit|ed|list) \d",
         ("script/edit_everywhere", "script/edit_as_a_variable", "script/named_lines"), "edit 210-",
         "edit 210-240,260 -- here"),
    Fact("`tdelay y = D, x, tau`", ("delay_with_commas",), r"delay \S+ = \w+ ?[,;]|delay y = late_",
         ("dynamic/delays_with_separators", "dynamic/separators_of_delays_and_tables", "dynamic/delays_under_line_numbers"), "tdelay y = D, x tau"),
    Fact("`delta h = v`, `UPDATE`, `LEARN`, `MAT d/dt`", ("older_updates",), r"\b(delta|UPDATE|LEARN|MAT d/dt)\b",
         ("vectors/older_updates_with_bounds", "script/updates_in_blocks", "dynamic/updates_of_states_and_views",
          "vectors/matrix_derivatives"), "delta h = v, 0, 3",
         "UPDATE h = 2*v; -4, 5"),
    Fact("`SHOW` alone, `SHOW *`", ("show_alone",), r"SHOW( \*|$| \|| -)",
         ("display/show_area", "display/show_sizes", "display/show_of_two_matrices"), "SHOW A,,3",
         "SHOW *"),
    Fact("either bracket opens a submodel's arguments", ("mixed_brackets",), r"\w\[[^])]*\)|\w\([^])]*\]",
         ("dynamic/invocations_in_either_bracket", "dynamic/mixed_brackets_nested",
          "vectors/invocations_of_arrays_in_either_bracket", "script/numbered_invocations"), "add[2, q, r)",
         "SUBMODEL add[a$, b$, c$)"),
    Fact("`note #210-230`", ("note_lines",), r"note ?# ?\d",
         ("script/note_lines_everywhere", "script/numbered_notes", "script/named_lines"), "note #210,,220",
         "note #220,240"),
    Fact("lines without numbers count 210, 220, …", ("jump_to_line",), r"(go to|restore|list) \d+",
         ("script/jumps_to_lines", "script/lines_by_number_in_blocks", "script/named_lines"), "go to 3",
         "list 230-240"),
    Fact("`CLEARN y = W*x; lrate, crit`", (), r"CLEA(_\n)?RN \w+ = \w(_\n)?\*",
         ("vectors/clearn_as_a_product", "vectors/clearn_as_a_product_conscience",
          "vectors/clearn_as_a_product_vigilance"), "CLEARN y = W*x; lrate"),
    Fact("settings never set read as 0", ("unset_settings",), r"NN|TMAX|ERMAX",
         ("dynamic/settings_read_as_zero", "script/settings_in_expressions", "script/settings_in_bodies",
          "dynamic/step_not_above_zero", "dynamic/stiff_rules_without_ermax", "dynamic/nn_one"), "DT = 0.001 | NN = 1.0E+300*1.0E+8 | drun",
         "x = TMAX + DT"),
    Fact("runs without d/dt that continue one another", ("rule_0_continued",), r"drun\s+(\w.*\n)*.*drun|next",
         ("dynamic/joint_without_derivatives", "dynamic/joint_of_sections", "dynamic/random_numbers_at_a_joint",
          "dynamic/joint_reads_again", "dynamic/joints_with_a_time_of_their_own"), "t = 0.5",
         "drun | drun"),
    Fact("a labelled run begins anew", ("labelled_runs",), r"drun [a-zA-Z]+",
         ("dynamic/labelled_runs_begin_anew", "dynamic/labelled_histories_of_steps",
          "dynamic/labelled_runs_take_subscripts_anew", "dynamic/labelled_runs_without_derivatives"), "drun second",
         "drun counted"),
    Fact("`P#` is row (trnc(iRow − 1) mod N) + 1", ("pattern_row",), r"\b\w#",
         ("vectors/pattern_rows_round", "vectors/row_behind_if", "errors/row_below_the_first",
          "vectors/pattern_rows_far_round"), "Vector x = 2*P#",
         "iRow = 3.5 | drun counted"),
    Fact("a target that overlays its operand", ("overlapping_vector",), r"\] ?\+ ?\w+\[.*= ?\w+",
         ("vectors/recurrent_forms", "vectors/recurrent_shift", "vectors/recurrent_in_a_submodel"), "Vector x = x{1}"),
    Fact("`term` at a joint", ("term_at_a_joint",), r"\bterm\b",
         ("dynamic/term_continued", "dynamic/term_in_a_fresh_run", "dynamic/term_made_true_by_the_script",
          "dynamic/term_that_grows_at_the_joint", "dynamic/billiard_ball", "dynamic/bouncing_ball_every_rule"), "term"),
    Fact("a state that is assigned, under rules 9–16", ("boundary_value",), r"^(.*\| )?\w+(\[\w+\])? = .*\n|irule",
         ("dynamic/boundary_moves", "dynamic/boundary_from_a_neighbour", "dynamic/boundary_scalar",
          "dynamic/boundary_fixed_steps", "dynamic/boundary_variable_steps", "dynamic/boundary_from_another_boundary"), "d/dt z = 3"),
    Fact("`disconnect`, `help`, `sh` with nothing there", ("forgiving_statements",), r"disconnect|help",
         ("script/forgiving_after_use", "script/forgiving_help", "script/forgiving_in_blocks"), "disconnect 2 3",
         "disconnect 3, 4"),
    Fact("quantities that are nan without harm", (), r"--\? warning 3",
         ("dynamic/gaps_in_curves", "dynamic/gaps_of_elements", "dynamic/gaps_of_tables",
          "dynamic/gaps_without_derivatives", "dynamic/gap_between_samples"), "d/dt x = x*x*x"),
    Fact("`write A` to the letter", (), r"--\| .*ARRAY +\(in ROW",
         ("script/write_shapes", "script/write_integer_matrix", "script/write_to_the_letter", "script/write_forms"), "write $",
         "write W"),
    Fact("`type` and `type #n` to the letter", (), r"--\| (-?\d\.\d{5}e[-+]\d\d)|type #",
         ("dynamic/type_five_columns", "dynamic/type_listing", "dynamic/type_of_two_runs", "dynamic/type_into_file",
          "dynamic/gaps_of_tables"), "type #2"),
    Fact("`%%n` in lower case", (), r"%%",
         ("script/hexadecimal_and_octal", "script/hexadecimal_in_blocks", "script/write_to_the_letter"), "write %%'x'",
         "write %%48879"),
    Fact("a `for` that makes no turn", ("loop_without_a_turn",), r"for \S+ = .* to ",
         ("script/loops_without_a_turn", "script/loops_that_end_before_they_begin", "script/for_ends"), "for i = 1, 10",
         "for k = 9.5 to 1 | next"),
    Fact("`dump` in columns, settings first", (), r"^\d* ?.*\bdu(_\n)?mp\b",
         ("script/dump_in_columns", "script/dump_in_a_procedure", "script/dump_after_clear"), "dump #",
         '"dump"'),
    Fact("CLEARN: ties, crit < 0, rates below 0, `#`", ("competitive_learning",), r"CLEARN|CLEA_",
         ("vectors/competitive_learning", "vectors/clearn_as_a_product", "vectors/conscience_second_best"), "CLEARN y = W(x) lrate crit"),
    Fact("CLEARN: crit = 0, conscience", ("conscience",), r"CLEARN",
         ("vectors/conscience_second_best", "vectors/clearn_as_a_product_conscience",
          "../../examples/networks/competitive_learning"), "CLEARN y = W(x) 0.5, 0"),
    Fact("CLEARN: crit > 0, vigilance", ("vigilance",), r"CLEARN",
         ("vectors/vigilance_fast", "vectors/clearn_as_a_product_vigilance", "../../examples/networks/vigilance"), "CLEARN v = W(x) 1, 1"),
    Fact("PLEARN", ("principal_components",), r"PLEARN",
         ("vectors/components_of_three", "vectors/principal_components", "vectors/components_of_one_row"), "PLEARN y = W*x lrate"),
    Fact("INTP", (), r"INTP",
         ("vectors/template_test", "vectors/templates_at_the_threshold", "vectors/principal_components"), "INTP y = W(x), thresh, 2"),
)  # fmt: skip
