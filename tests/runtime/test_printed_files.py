"""What `type #n`, `write #n` and `dump #n` put into files, to the letter: other programs read them by column."""

from __future__ import annotations

import pytest

import desire_tui

PROGRAMS = {
    "type": (
        (
            "connect 'list' as output 4\nt = 0 | TMAX = 2 | NN = 3 | DT = 0.5 | irule 2\ndrun\ndisconnect 4\nDYNAMIC\n"
            "d/dt x = -1\ntype #4, x\n"
        ),
        "t,   x\n0.00000e+00    0.00000e+00 \n1.00000e+00   -1.00000e+00 \n2.00000e+00   -2.00000e+00 \n",
    ),
    "type of two runs": (
        (
            "connect 'list' as output 2\nNN = 2\ndrun\ndrun\ndisconnect 2\nDYNAMIC\nx = 1e-7*t\ny = 1/(t - 2)\n"
            "type #2, x, y\n"
        ),
        (
            "t,   x,y\n"
            "1.00000e+00    1.00000e-07  -1.00000e+00 \n"
            "2.00000e+00    2.00000e-07           inf \n"
            "t,   x,y\n"
            "2.00000e+00    2.00000e-07           inf \n"
            "3.00000e+00    3.00000e-07   1.00000e+00 \n"
        ),
    ),
    "type between texts": (
        (
            "connect 'list' as output 10\nNN = 2 | t = -100\nwrite #10, 'before'\ndrun\nwrite #10, 'behind'; %%171\n"
            "disconnect 10\nDYNAMIC\ncube = t*t*t\ntype #10, cube\n"
        ),
        "before\nt,   cube\n-1.00000e+02  -1.00000e+06 \n-9.90000e+01  -9.70299e+05 \nbehindab\n",
    ),
    "write of a matrix": (
        (
            "connect 'list' as output 3\nARRAY A[2,6] | A[1,6] = -1.5 | A[2,1] = 1e5\nwrite #3, A\nwrite #3, A[1,6]\n"
            "disconnect 3\n"
        ),
        "\nA[2,6]  : REAL ARRAY (in ROW major sequence)\n"
        + "0.000000e+00   " * 5
        + "\n-1.500000e+00   \n\n"
        + "1.000000e+05   "
        + "0.000000e+00   " * 4
        + "\n0.000000e+00   \n\n-1.5\n",
    ),
}


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("name", PROGRAMS)
def test_files_to_the_letter(name, backend, tmp_path):
    text, expected = PROGRAMS[name]
    (tmp_path / "printing.src").write_text(text)
    result = desire_tui.run(tmp_path / "printing.src", backend=backend)
    assert result.status == "done", result.problems
    assert (tmp_path / "list.dat").read_text() == expected
