"""A program's own names come before the words that expectations know."""

from __future__ import annotations

from tests.programs.runner import faults_of_program

PROGRAM = """\
peak = 1 | at = 2 | calls = 3 | rejected = 5 | least = 6
NN = 3
drun
--? run 1: peak = 1
--? run 1: at + calls + rejected + least = 16
--? run 1: list(steps) = [7, 14, 21]
--? run 1: count = 21
--? run 1: ended = 'tmax'
--? run 1: points = 3
--? run 1: most = 4
--? t = 3
DYNAMIC
steps = 7*t | count = steps
dispt steps
"""


def test_a_programs_own_names_are_not_hidden(tmp_path):
    (fault,) = faults_of_program(PROGRAM, tmp_path)
    assert "most = 4" in fault
