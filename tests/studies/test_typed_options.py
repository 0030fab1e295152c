"""The options of a study as they are typed on the desktop's command line."""

from __future__ import annotations

import pytest

from desire_tui import DesireError
from desire_tui.studies.typed_options import typed_options


def test_values_need_no_quotes_and_may_have_them():
    found = typed_options(
        '--over k=1:10:10 --over r=0,1 --sample "a=normal(4, 0.5), b=uniform(-1, 1)" --runs 100 --seed 7'
        " --keep x[end], max(abs(x - k)) --set TMAX=2 --design sobol -o out.nc"
    )
    assert found["over"] == ["k=1:10:10", "r=0,1"]
    assert found["sample"] == ["a=normal(4, 0.5), b=uniform(-1, 1)"]
    assert (found["runs"], found["seed"], found["design"]) == (100, 7, "sobol")
    assert found["keep"] == ["x[end], max(abs(x - k))"]
    assert (found["settings"], found["output"]) == ({"TMAX": 2.0}, "out.nc")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("--ovr k=1:10:10", "did you mean --over?"),
        ("k=1:10:10 --keep x[end]", "'k=1:10:10' belongs to no option"),
        ("--keep", "nothing stands behind '--keep'"),
        ("--keep x[end] --runs many", "--runs many: no whole number"),
        ("--keep x[end] --runs 0", "--runs 0: no whole number"),
        ("--keep x[end] --design latn", "there is no design 'latn'"),
        ("--keep x[end] --set TMAX", "'TMAX' sets nothing"),
    ],
)
def test_what_is_wrong_is_said_with_what_to_write(text, told):
    with pytest.raises(DesireError) as caught:
        typed_options(text)
    (problem,) = caught.value.diagnostics
    assert problem.code == 510
    assert told in f"{problem.message} {problem.hint}"
