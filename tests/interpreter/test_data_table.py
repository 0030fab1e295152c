"""Lines of data files that are neither names nor numbers."""

from __future__ import annotations

from desire_tui.engine.data_files.data_table import begins_with_number, column_names


def test_a_line_of_quotes_begins_with_no_number():
    assert not begins_with_number('""')
    assert begins_with_number("1 2")


def test_a_cell_of_any_length_is_read():
    assert begins_with_number("1," + "9" * 200_000)
    assert column_names("a," + "b" * 200_000, None) == ["a", "b" * 200_000]
