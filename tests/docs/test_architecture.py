"""docs/ARCHITECTURE.md names folders and files that are there, and all parts of the engine."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "desire_tui"
TEXT = (ROOT / "docs" / "ARCHITECTURE.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| .*\? \| (.*) \|$", TEXT, re.MULTILINE)


@pytest.mark.parametrize("row", ROWS)
def test_what_the_table_names_is_there(row):
    names = re.findall(r"`([\w./*]+)`", row)
    folder = names[0].partition("/")[0]
    places = (PACKAGE / "engine" / folder, PACKAGE / folder, PACKAGE / "engine", PACKAGE)
    for name in names:
        path = name.rstrip("/")
        assert any([*place.glob(path), *place.glob(f"{path}.py")] for place in places), name


def test_every_part_of_the_engine_is_named():
    parts = {p.stem for p in (PACKAGE / "engine").iterdir() if p.stem not in {"__init__", "__pycache__"}}
    assert {part for part in parts if f"engine/{part}" not in TEXT} == set()


def test_every_folder_of_the_front_ends_is_named():
    folders = {p.name for p in PACKAGE.iterdir() if p.is_dir()} - {"engine", "__pycache__"}
    assert {name for name in folders if f"{name}/" not in TEXT and f"`{name}`" not in TEXT} == set()
