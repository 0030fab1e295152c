"""Who gets the app imports its type alone: only `launch` makes one."""

from __future__ import annotations

import ast
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "desire_tui"
MAKES_ONE = PACKAGE / "launch.py"


def imports_of_the_app(text: str) -> list[int]:
    """Return the lines that import the app, other than for the type checker."""
    if "desire_tui.app" not in text:  # 900 files are not parsed for nothing
        return []
    tree = ast.parse(text)
    checked = [n for n in ast.walk(tree) if isinstance(n, ast.If) and ast.unparse(n.test) == "TYPE_CHECKING"]
    for_types = {id(node) for block in checked for part in block.body for node in ast.walk(part)}
    return [
        node.lineno
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module == "desire_tui.app" and id(node) not in for_types
    ]


def test_the_app_is_imported_as_a_type():
    importers = {path for path in PACKAGE.rglob("*.py") if imports_of_the_app(path.read_text("utf-8"))}
    assert importers == {MAKES_ONE}
