"""A program from standard input has no folder of its own: every file is asked for, so refused."""

from __future__ import annotations

import pytest

from tests.batch.command_line import desire


@pytest.mark.parametrize(("flags", "status"), [([], 1), (["--allow-write"], 0)])
def test_files_of_a_program_from_a_pipe(tmp_path, flags, status):
    text = "connect 'out' as output 2\nwrite #2, 1\n"
    found, _, err = desire("run", *flags, "-", cwd=tmp_path, text_in=text)
    assert found == status
    assert (tmp_path / "out.dat").exists() == (not status)
    assert ("error 451" in err) == bool(status)
