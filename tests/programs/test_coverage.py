"""No statement, form, function, display code or command without a test."""

from __future__ import annotations

from typing import get_args, get_type_hints

import pytest

from desire_tui.engine import nodes
from tests.programs.coverage import command_tests, users
from tests.programs.features import _ONE, DYNAMIC, FUNCTIONS, SCRIPT


@pytest.fixture(scope="module")
def tables():
    return users()


@pytest.mark.parametrize("row", SCRIPT)
def test_script_row_has_a_program(row, tables):
    assert tables[0][row]


@pytest.mark.parametrize("row", DYNAMIC)
def test_dynamic_row_has_a_program(row, tables):
    assert tables[1][row]


@pytest.mark.parametrize("row", FUNCTIONS)
def test_function_has_a_program(row, tables):
    assert tables[0][row] or tables[1][row]


@pytest.mark.parametrize(("word", "files"), command_tests().items())
def test_command_has_a_test(word, files):
    assert files, word


def test_the_table_has_every_statement():
    """A new class of node or keyword must get a row."""
    statements = {
        cls for cls in vars(nodes).values() if isinstance(cls, type) and issubclass(cls, nodes.Statement)
    }
    with_rows = set(_ONE) | {
        nodes.Statement, nodes.Simple, nodes.Assign, nodes.If, nodes.For, nodes.GoTo, nodes.Declare, nodes.Restore,
        nodes.Input, nodes.Write, nodes.Connect, nodes.Dump, nodes.Irule, nodes.Drun, nodes.Fft, nodes.Display, nodes.Plot,
        nodes.Derivative, nodes.Delay, nodes.FunctionTable, nodes.Bare, nodes.Request, nodes.Learn, nodes.VectorAssign,
        nodes.MatrixAssign, nodes.Dot, nodes.FileCommand,
    }  # fmt: skip
    assert {cls.__name__ for cls in statements} == {
        cls.__name__ for cls in with_rows if issubclass(cls, nodes.Statement)
    }
    codes = set(get_args(get_type_hints(nodes.Display, localns=vars(nodes))["mode"]))
    assert {row.split()[1] for row in SCRIPT if row.startswith("display ")} == codes
