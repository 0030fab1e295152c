"""lark is used in one module, and there by public names only."""

from __future__ import annotations

import ast
from pathlib import Path

import lark

import desire_tui

PACKAGE = Path(desire_tui.__file__).parent
HOME = PACKAGE / "engine" / "syntax" / "lalr_builder.py"


def imports(tree: ast.AST) -> list[tuple[str, str]]:
    """Return (module, name) of every import of lark in a module; the name is empty for `import module`."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found += [(alias.name, "") for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and not node.level:
            found += [(node.module, alias.name) for alias in node.names]
    return [(module, name) for module, name in found if module.split(".")[0] == "lark"]


def test_one_module_imports_lark():
    texts = {path: path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.py")}
    users = [path for path, text in texts.items() if "lark" in text and imports(ast.parse(text))]
    assert users == [HOME]


def test_only_public_names_of_lark_are_used():
    tree = ast.parse(HOME.read_text(encoding="utf-8"))
    assert {module for module, _ in imports(tree)} == {"lark"}, "no module inside lark"
    assert {name for _, name in imports(tree)} <= set(lark.__all__)
    attributes = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    assert {name for name in attributes if name.startswith("_")} == set()
