"""The exact formats of `write`, files, console input."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.interpreter.stand_in import RecordingHost, error_of, run


@pytest.mark.parametrize(
    ("script", "text"),
    [
        ("write 1/3", "0.333333\n"),
        ("write", "\n"),
        ("write 'a', 1, 2; 'b'", "a\t1\t2b\n"),
        ("write 'one ';\nwrite 'line'", "one line\n"),
        ("write 'x',\nwrite 2", "x\t2\n"),
        ("write 1234567, 0.00001, -5", "1.23457e+06\t1e-05\t-5\n"),
        ("INTEGER i | i = 1234567 | write i, i + i", "1234567\t2469134\n"),
        ("COMPLEX z | z = 1.5 - j*2 | write z", "1.5 + j*( -2)\n"),
        ("write $65; $66", "AB\n"),
        ("write %12918, %%12918", "31166\t3276\n"),
        ("write %%(-1)", "ffff\n"),
        ('write "it\'s"', "it's\n"),
        ("kk = 7 | write kk; ' runs'", "7 runs\n"),
        ("write 2 > 1", None),
    ],
)
def test_write(script, text):
    if text is None:
        assert error_of(script)[0] in {10, 33}
    else:
        assert run(script).text == text


def test_arrays_are_written_five_in_a_line_and_row_by_row():
    host = run("ARRAY A[2,6]\nfor i = 1 to 2 | for k = 1 to 6 | A[i,k] = -i*k/8 | next | next\nwrite A")
    rows = [[f"{-i * k / 8:12.6e}   " for k in range(1, 7)] for i in (1, 2)]
    body = "".join("".join(row[:5]) + "\n" + row[5] + "\n\n" for row in rows)
    assert host.text == "\nA[2,6]  : REAL ARRAY (in ROW major sequence)\n" + body


def test_vectors_and_whole_numbers_have_no_line_behind_them():
    host = run("ARRAY v[2]\nv[1] = -1.5\nwrite v")
    assert host.text == "\nv[2]  : REAL ARRAY (in ROW major sequence)\n-1.500000e+00   0.000000e+00   \n"
    host = run("INTEGER K[2,2]\nK[1,2] = -12\nwrite K")
    heading = "\nK[2,2]  : INTEGER ARRAY  (in ROW major sequence)\n"
    assert host.text == heading + "     0      -12   \n\n     0        0   \n\n"


def test_a_long_array_comes_in_pieces_and_can_be_broken_off():
    host = run("ARRAY x[20000]\nwrite x")
    assert host.text.count("\n") == 2 + 20000 / 5
    assert len(host.written) > 3


def test_files_keep_their_numbers(tmp_path):
    host = run(
        "ARRAY A[2,2]\ndata 1.5,-2,1/3,4E-9\nread A\nconnect 'numbers' as output 3\n"
        "write ##3, A | write ##3, PI | write #3, 'text'; 5\ndisconnect 3\n"
        "ARRAY B[2,2]\nconnect 'numbers' as input 4 | input #4, B, p\ndisconnect 4",
        folder=tmp_path,
    )
    assert (host["B"] == host["A"]).all()
    assert host["p"] == 3.141592653589793
    assert (tmp_path / "numbers.dat").read_text().endswith("text5\n")


def test_machine_readable_arrays_are_lines_and_values_alone(tmp_path):
    run(
        "ARRAY A[2,2], v[3]\nconnect 'raw' as output 3\nwrite ##3, 1, A, v, 7\nwrite ##3, v\n"
        "write ##3, v; v;\nwrite ##3, 8\ndisconnect 3",
        folder=tmp_path,
    )
    v = "0\t0\t0\n"
    assert (tmp_path / "raw.dat").read_text() == f"1\t0\t0\n0\t0\n{v}7\n{v}{v}{v}8\n"


def test_input_files_may_hold_expressions_with_any_separator(tmp_path):
    (tmp_path / "in.txt").write_text("1, 2*3\t4\n\n5 6 7\n sqrt(16)\n")
    host = run("ARRAY x[7]\nconnect 'in.txt' as input 2\ninput #2, x", folder=tmp_path)
    assert host["x"].tolist() == [1, 6, 4, 5, 6, 7, 4]


def test_channels_0_and_1_append_and_others_do_not(tmp_path):
    for _ in range(2):
        run("connect 'a' as output 1 | connect 'b' as output 2\nwrite #1, 5 | write #2, 6", folder=tmp_path)
    assert (tmp_path / "a.dat").read_text() == "5\n5\n"
    assert (tmp_path / "b.dat").read_text() == "6\n"


@pytest.mark.parametrize(
    ("script", "code", "piece"),
    [
        ("connect 'f' as output 11", 50, "connect 'f' as output 11"),
        ("connect 'f' as output 2 | connect 'g' as output 2", 30, "connect 'g' as output 2"),
        ("write #5, 1", 63, "write #5, 1"),
        ("connect 'f' as output 2 | input #2, x", 64, "input #2, x"),
        ("connect 'nothing' as input 2", 38, "connect 'nothing' as input 2"),
        ("connect 'no/such/f' as output 2", 11, "connect 'no/such/f' as output 2"),
        ("connect '' as output 2", 34, "connect '' as output 2"),
    ],
)
def test_channel_errors(tmp_path, script, code, piece):
    assert error_of(script, folder=tmp_path) == (code, piece)


def test_reading_past_the_end_and_nonsense(tmp_path):
    (tmp_path / "in.dat").write_text("1\n")
    assert error_of("connect 'in' as input 2\ninput #2, x, y", folder=tmp_path)[0] == 18
    (tmp_path / "in.dat").write_text("hello there\n")
    assert error_of("connect 'in' as input 2\ninput #2, x", folder=tmp_path)[0] == 18


def test_console_input_prompts_and_asks_again():
    host = RecordingHost()
    host.answers = ["2*", "y", "2*3", "7, 8"]
    host.run("ARRAY A[2]\ninput x, A")
    assert host["x"] == 6
    assert host["A"].tolist() == [7, 8]
    assert host.text == "x ? x ? x ? A ? "
    assert len(host.warnings) == 2


def test_input_is_broken_off_by_an_exclamation_mark():
    assert error_of("input x", "!") == (197, "input x")
    assert error_of("input x") == (18, "input x")


def test_dump_lists_scalars_then_arrays():
    host = run("alpha = 2.5 | ARRAY v[2] | v[1] = 1\nINTEGER n | n = 12345678\ndump")
    settings = [
        "t",
        "DT",
        "TMAX",
        "NN",
        "MM",
        "ERMAX",
        "ERMIN",
        "DTMAX",
        "DTMIN",
        "CHECKN",
        "iRow",
        "scale",
        "PI",
    ]
    assert [word for word in host.text.split("alpha")[0].split() if word[0].isalpha()] == settings
    assert host.text.split("\n")[4] == "alpha = 2.5             n = 12345678"
    assert host.text.index("scale = 1") < host.text.index("v[2]  : REAL ARRAY")


def test_notes_and_shell_and_commands_go_to_the_host():
    host = run("x = 3 | note 'x is '; x\nsh ls\nsnapshot 'f.png'\ndisplay N14 | display W 10,20")
    assert host.calls == [
        ("note", "x is 3"), ("shell", "ls"), ("command", "snapshot", "f.png"),
        ("display", "N", 14), ("display", "W", 10, 20),
    ]  # fmt: skip


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=8))
def test_machine_readable_files_keep_every_bit(tmp_path, numbers):
    host = RecordingHost(tmp_path)
    host.load("")
    host.execute(f"ARRAY x[{len(numbers)}], y[{len(numbers)}]")
    host["x"][:] = numbers
    host.execute("connect 'bits' as output 2 | write ##2, x | disconnect 2")
    host.execute("connect 'bits' as input 2 | input #2, y | disconnect 2")
    assert host["y"].tolist() == numbers


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=8))
def test_machine_readable_scalars_keep_every_bit(tmp_path, numbers):
    host = RecordingHost(tmp_path)
    host.load("")
    for number in numbers:
        host.values.assign(host.values.scalar("x").slot, number)
        host.execute("connect 'bits' as output 2 | write ##2, x | disconnect 2")
        host.execute("connect 'bits' as input 2 | input #2, y | disconnect 2")
        assert host["y"] == number
