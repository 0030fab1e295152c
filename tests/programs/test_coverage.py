"""No statement, form, function, display code or command without a test."""

from __future__ import annotations

from typing import get_args, get_type_hints

import pytest

from desire_tui.engine.nodes import expressions
from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Simple
from desire_tui.engine.nodes.control import For, GoTo, If
from desire_tui.engine.nodes.declarations import Declare
from desire_tui.engine.nodes.display import Display, GraphText, Plot, Request
from desire_tui.engine.nodes.faulty import Faulty
from desire_tui.engine.nodes.files import Connect, Dump, Input, Restore, Write
from desire_tui.engine.nodes.segment import Delay, Derivative, FunctionTable, Learn
from desire_tui.engine.nodes.statements import Statement
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
    statements = set(get_args(Statement)) - {Faulty}  # which no program that works has
    with_rows = set(_ONE) | {
        Simple, Assign, If, For, GoTo, Declare, Restore,
        Input, Write, Connect, Dump, Irule, Drun, Fft, Display, GraphText, Plot,
        Derivative, Delay, FunctionTable, Bare, Request, Learn, VectorAssign,
        MatrixAssign, Dot, FileCommand,
    }  # fmt: skip
    assert {cls.__name__ for cls in statements} == {
        cls.__name__ for cls in with_rows if issubclass(cls, Statement)
    }
    codes = set(get_args(get_type_hints(Display, localns=vars(expressions))["mode"]))
    assert {row.split()[1] for row in SCRIPT if row.startswith("display ")} == codes
