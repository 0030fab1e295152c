"""Both back ends for every test of this folder: they must give the same."""

import pytest

from tests.runtime import running


@pytest.fixture(params=["reference", "native"], autouse=True)
def backend(request, monkeypatch):
    monkeypatch.setattr(running, "BACKEND", request.param)
    return request.param
