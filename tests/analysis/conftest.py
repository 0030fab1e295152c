"""What the tests of analyses share: a subject made of a text."""

from __future__ import annotations

import pytest

from desire_tui.analysis.subject import Subject
from desire_tui.engine.source import Source


@pytest.fixture
def subject():
    def made(text, **settings):
        return Subject(Source(text, "test.src"), **settings)

    return made
