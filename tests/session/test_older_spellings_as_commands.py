"""What programs of the original hold is read on the command line too."""

from __future__ import annotations

import pytest

from desire_tui.engine.diagnostics import DesireError
from desire_tui.engine.session.permissions import Permissions
from desire_tui.engine.session.session import Session
from desire_tui.engine.source import Source
from tests.runtime.running import Kept, value

PROGRAM = """\
ARRAY h[2], v[2], W[2,2], P[2,1], p[1], y[2], g[2]
SUBMODEL add[a$, b$, c$) | c$ = a$ + b$ | end
v[1] = 3 | v[2] = -5 | k = 1
label again | k = k + _
1 | NN = 2
DYNAMIC
add[k, k, s) | s2 = s*t
label counted
Vector p = P# | n = n + 1 | store g = n
"""


@pytest.fixture
def session(tmp_path):
    kept = Kept()
    session = Session(kept, folder=tmp_path, permissions=Permissions(files=True))
    session.erun(Source(PROGRAM, "older.src"))
    session.kept = kept
    return session


def element(session, name, at=0):
    return session.values.cells[session.values.find(name).slot + at]


@pytest.mark.parametrize(
    "line",
    ["edit 210-220", "ed 210,230", "auto 210", "note #210-230", "edit 210-240,260 -- here", "disconnect 3, 4",
     "SHOW *", "SHOW", "if k = 2 then edit 210 | else ed 220 | proceed", "help nosuchpage"],
)  # fmt: skip
def test_commands_that_change_no_value(session, line):
    session.execute(line)
    assert value(session, "k") == 2


@pytest.mark.parametrize(
    ("line", "name", "found"),
    [
        ("delta h = v", "h", [3, -5]),
        ("UPDATE h = 2*v; -4, 5", "h", [5, -4]),
        ("for i = 1 to 3 | VECTR delta h = v; -100, 7 | next", "h", [7, -15]),
        ("Matrix W = 1", "W", [1, 0]),
        ("del_\nta h = v; 0_\n, 2", "h", [2, 0]),
        ("x = TMAX + DT | delta h = x*v", "h", [0, 0]),
    ],
)
def test_commands_that_do(session, line, name, found):
    session.execute(line)
    assert [element(session, name, 0), element(session, name, 1)] == found


def test_lists_show_lines_of_the_program(session):
    session.execute("list 230-240 | list 9999")
    assert session.kept.text == "230 v[1] = 3 | v[2] = -5 | k = 1\n240 label again | k = k + _\n1 | NN = 2\n"


def test_commands_about_lines_work_in_blocks_of_a_line(session):
    session.execute("for i = 1 to 2 | list 230 | if i = 2 then list 9999 | else edit 210 | proceed | next")
    assert session.kept.text == 2 * "230 v[1] = 3 | v[2] = -5 | k = 1\n"
    session.execute("while k < 4 | k = k + 1 | note #210 | help nosuchpage | end while")
    assert value(session, "k") == 4


def test_lines_are_copied_into_the_notebook(session, tmp_path):
    session.execute("notebook 'book.md'")
    session.execute("note #220,240")
    session.execute("notebook off")
    text = (tmp_path / "book.md").read_text(encoding="utf-8")
    assert (
        "220 SUBMODEL add[a$, b$, c$) | c$ = a$ + b$ | end\n240 label again | k = k + _\n1 | NN = 2\n" in text
    )
    assert "230" not in text


def test_output_is_the_original_s_to_the_letter(session):
    session.execute("write W | write %%48879; %%-2")
    assert session.kept.text == (
        "\nW[2,2]  : REAL ARRAY (in ROW major sequence)\n0.000000e+00   0.000000e+00   \n\n"
        "0.000000e+00   0.000000e+00   \n\nbeeffffe\n"
    )
    session.kept.text = ""
    session.execute("dump")
    assert session.kept.text.startswith(
        "t = 0                   DT = 0                  TMAX = 0                NN = 2\nMM = 0 "
    )


def test_a_loop_without_a_turn_leaves_its_start_value(session):
    session.execute("for k = 9.5 to 1 | next")
    assert value(session, "k") == 9.5


def test_runs_without_derivatives_continue_one_another(session):
    session.execute("NN = 3 | drun | drun")
    assert value(session, "t") == 5


def test_labelled_runs_begin_anew_and_take_the_row_asked_for(session):
    session.execute("P[1,1] = 4 | P[2,1] = 5 | n = 0 | iRow = 0.5 | drun counted")
    assert (element(session, "p"), element(session, "g"), value(session, "t")) == (4, 1, 2)
    session.execute("iRow = 3.5 | drun counted")  # row trnc(2.5) mod 2 + 1
    assert (element(session, "p"), element(session, "g"), value(session, "t")) == (4, 3, 3)
    session.execute("iRow = 2 | drun counted")
    assert element(session, "p") == 5


def test_pictures_show_sizes_until_show_says_colours(session):
    for line in ("SHOW *", "SHOW W", "SHOW v; 1", "SHOW | SHOW W"):
        session.execute(line)
    assert [page.shown[0].by_size for page in session.graphs] == [True, True, False]


def test_a_run_from_the_command_line_invokes_the_submodel(session):
    session.execute("k = 4 | drun")
    assert value(session, "s") == 8


@pytest.mark.parametrize(
    ("line", "code"),
    [("h[1)", 25), ("edit 210-", 62), ("note #", 62), ("delta h = v; 0", 33), ("SHOW h,,3", 14), ("SHOW k", 19),
     ("UPDATE nothing = v", 19), ("disconnect", 14)],
)  # fmt: skip
def test_what_is_really_wrong_is_said(session, line, code):
    with pytest.raises(DesireError) as caught:
        session.execute(line)
    assert caught.value.diagnostics[0].code == code
    assert value(session, "k") == 2
