"""What all tests share: hypothesis without deadlines, and without chance where a failure must be repeatable.

`HYPOTHESIS_PROFILE=search pytest …` looks for new examples, and more of them where a test names no number.
"""

from __future__ import annotations

import os
import tempfile

from hypothesis import settings

os.environ["XDG_STATE_HOME"] = tempfile.mkdtemp(
    prefix="desire-tests-"
)  # the user's own record is not for tests

settings.register_profile("repeatable", deadline=None, derandomize=True, database=None)
settings.register_profile("search", deadline=None, max_examples=1000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))
