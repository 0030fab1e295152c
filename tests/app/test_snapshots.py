"""What the screen looks like. After a wanted change: `pytest tests/app/test_snapshots.py --snapshot-update`."""

from __future__ import annotations

import pytest

from .scenes import SCENES, Scene, app_for, before


# The words on help pages and in completions are others' business and have their own tests.
@pytest.mark.parametrize(
    "scene", [s for s in SCENES if not {"help", "complete"} & set(s.words)], ids=lambda s: s.name
)
def test_it_looks_as_before(snap_compare, tmp_path, scene: Scene):
    assert snap_compare(app_for(scene, tmp_path), terminal_size=scene.size, run_before=before(scene))
