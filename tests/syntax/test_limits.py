"""Hostile texts get a message, quickly; the grammar's tables survive a bad cache."""

from __future__ import annotations

import marshal
import subprocess
import sys
from time import thread_time

import pytest

from desire_tui.engine import disk_cache
from desire_tui.engine.nodes.files import Data
from desire_tui.engine.recently_used import RecentlyUsed
from desire_tui.engine.source import Source
from desire_tui.engine.structure.structure import structure
from desire_tui.engine.syntax import lalr_tables as tables_module
from desire_tui.engine.syntax.parse import parse
from desire_tui.engine.syntax.parsed_lines import forget_lines
from tests.syntax.format.statements import format_statement

WRONG = disk_cache._check(marshal.dumps({"start": 1})) + marshal.dumps({"start": 1})
"""Whole, but not what it should be."""

HOSTILE = {
    "x = " + "(" * 10_000 + "1" + ")" * 10_000: "nested-too-deep",
    "x = " + "-" * 1 + "+" * 10_000 + "1": "expression-too-deep",
    "x = " + "2^" * 10_000 + "1": "expression-too-deep",
    "x = " + "1-(-" * 99 + "1" + ")" * 99: "expression-too-deep",
    "if " + "not " * 10_000 + "a > b then": "expression-too-deep",
    "x = " + "y" * 10_000_000: "line-too-long",
    "x = 1 + _\n" * 200_000: "line-too-long",
    "x = " + "a[" * 10_000: "nested-too-deep",
}


@pytest.mark.parametrize("text", HOSTILE, ids=lambda text: text[:14].replace("\n", " "))
def test_hostile_text_gets_a_message_at_once(text: str) -> None:
    began = thread_time()
    program = parse(Source(text))
    assert [problem.key for problem in program.problems] == [HOSTILE[text]]
    assert thread_time() - began < 10.0


def test_long_lists_are_fine() -> None:
    program = parse(Source("data " + "1," * 50_000 + "1"))
    assert not program.problems
    node = program.script[0].node
    assert isinstance(node, Data)
    assert len(node.items) == 50_001


@pytest.mark.parametrize(
    "text", ["x = " + "-+" * 90 + "1", "x = " + "1 + " * 190 + "1", "x = " + "(" * 100 + "1" + ")" * 100]
)
def test_deep_expressions_below_the_limit(text: str) -> None:
    results = []
    for _ in range(4):
        forget_lines()
        program = parse(Source(text))
        assert not program.problems
        results.append(format_statement(program.script[0].node))
    assert len(set(results)) == 1


def test_messages_quote_only_the_beginning_of_long_words() -> None:
    problems = parse(
        Source("y" * 100_000 + " 3\nx = 1.1." + "1" * 100_000 + "\nx = 3 " + "z" * 100_000)
    ).problems
    assert len(problems) == 3
    assert all(len(problem.message) < 120 for problem in problems)


@pytest.mark.parametrize(("store", "line"), [("_lines", "write {}.{}"), ("_plain", "x = {}.{}")])
def test_the_stores_of_lines_are_bounded(monkeypatch, store: str, line: str) -> None:
    module = sys.modules[forget_lines.__module__]
    lines = RecentlyUsed(10_000, cost=lambda line: len(line) + module.LINE_COST)
    monkeypatch.setattr(module, store, lines)
    for program in range(100):
        parse(Source("\n".join(line.format(program, i) for i in range(50))))
    assert 50 <= lines.size <= 300


def test_nested_blocks_of_any_depth() -> None:
    program = parse(Source("for i = 1 to 2\n" * 5_000 + "next\n" * 5_000))
    found = structure(program)
    assert not found.problems
    assert found.partner[0] == 9_999


@pytest.mark.parametrize("content", [None, b"", b"{}", b"\0\0\0\0", b"\0\0\0\0{", WRONG])
def test_tables_survive_a_bad_cache(content, tmp_path, monkeypatch) -> None:
    file = tmp_path / "cache" / "grammar.tables"
    if content is not None:
        file.parent.mkdir()
        file.write_bytes(content)
    monkeypatch.setattr(disk_cache, "_path", lambda _: str(file))
    before = tables_module.tables()
    tables_module.tables.cache_clear()
    try:
        again = tables_module.tables()
        assert len(again.actions) == len(before.actions)
        assert len(file.read_bytes()) > 10_000, "the good tables are stored"
        tables_module.tables.cache_clear()
        assert tables_module.tables() == again
    finally:
        tables_module.tables.cache_clear()


def test_tables_without_a_writable_cache(monkeypatch) -> None:
    monkeypatch.setattr(disk_cache, "_path", lambda _: "/proc/nowhere/grammar.tables")
    tables_module.tables.cache_clear()
    try:
        assert tables_module.tables().rules
    finally:
        tables_module.tables.cache_clear()


def test_lark_is_not_imported_when_the_tables_are_stored() -> None:
    tables_module.tables()
    code = (
        "import sys; from desire_tui.engine.source import Source; from desire_tui.engine.syntax.parse import parse;"
        "parse(Source('x = 1')); print([m for m in ('lark', 'numpy', 'textual') if m in sys.modules])"
    )
    assert (
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        == "[]\n"
    )
