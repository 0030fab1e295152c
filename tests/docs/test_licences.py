"""Notices that others' work asks for are there, and go along with the package."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_notices_that_files_refer_to_are_shipped():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    shipped = {
        path.relative_to(ROOT).as_posix() for glob in project["license-files"] for path in ROOT.glob(glob)
    }
    named = {
        name
        for path in (ROOT / "desire_tui").rglob("*.py")
        for name in re.findall(r"LICENSES/\w+\.txt", path.read_text(encoding="utf-8"))
    }
    assert "LICENSES/SUNDIALS.txt" in named
    assert named | {"LICENSE"} <= shipped
