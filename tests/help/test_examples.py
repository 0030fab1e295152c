"""The help pages' example programs print what the pages say, on both back ends."""

from __future__ import annotations

import pytest

from desire_tui.help.page_catalogue import topics
from tests.programs.execution import execute


@pytest.mark.parametrize("backend", ["native", "reference"])
@pytest.mark.parametrize("name", [page.name for page in topics().values() if page.example])
def test_example(name, backend, tmp_path):
    page = topics()[name]
    outcome = execute(page.example, backend, tmp_path)
    assert outcome.error is None, str(outcome.error)
    shown = [line.rstrip() for line in outcome.console.rstrip("\n").split("\n")]
    assert shown == page.prints.split("\n")
