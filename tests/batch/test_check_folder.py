"""`desire check FOLDER`: all programs below it, and a summary by kind of problem."""

from __future__ import annotations

from desire_tui.batch.check_files import check_files


def test_programs_below_a_folder_and_a_summary(tmp_path, capsys):
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "again").symlink_to(tmp_path)
    (tmp_path / "a.src").write_text("write zork\nwrite x + 1\n")
    (tmp_path / "deep" / "b.SRC").write_text("y = 2*zork\n")
    (tmp_path / "deep" / "good.src").write_text("y = 2\n")
    (tmp_path / "deep" / "picture.src").write_bytes(b"\x00\x01\x02")
    (tmp_path / "deep" / "latin.src").write_bytes(b"-- \xe9t\xe9\ny = 2\n")
    (tmp_path / "gone.src").symlink_to(tmp_path / "nothing")
    (tmp_path / "notes.txt").write_text("no program")
    assert check_files([str(tmp_path)]) == 1
    out, err = capsys.readouterr()
    assert out.splitlines() == [
        "programs: 5, with errors: 3",
        "programs  places  problem",
        "       2       3  error 200: undefined variable '…'",
        "       1       1  error 38: … is not a text file",
    ]
    assert err.index("a.src:1:7") < err.index("b.SRC:1:7")


def test_warnings_alone_are_no_failure(tmp_path, capsys):
    text = "TMAX = 1\ndrun L\nDYNAMIC\nOUT\nlabel L\nd/dt x = 1\nlabel L\nd/dt x = 2\n"
    (tmp_path / "a.src").write_text(text)
    assert check_files([str(tmp_path)]) == 0
    assert check_files([str(tmp_path / "a.src")]) == 0
    assert "warning 79" in capsys.readouterr().err
