"""What a statement leaves as it was still counts: a masked matrix depends on what its skipped elements held."""

from __future__ import annotations

import pytest

from desire_tui.engine.passes.sparsity import sparsity_pattern
from tests.lowering.programs import segment

ARRAYS = {"x": (2,), "c": (2,), "W": (2, 2), "M": (2, 2)}


@pytest.mark.parametrize(
    ("body", "depends"),
    [
        ("MATRIX W = x*c", True),
        ("MATRIX W = x*c\nMATRIX W = 1", False),
        ("MATRIX W = x*c\nMATRIX W = [M] 1", True),
        ("MATRIX W = x*c\nDELTA W = 1", True),
    ],
)
def test_a_derivative_through_a_matrix(body, depends):
    lowered, _ = segment(f"{body}\nVectr d/dt x = W*c", **ARRAYS)
    rows, columns = sparsity_pattern(lowered)
    entries = set(zip(rows.tolist(), columns.tolist(), strict=True))
    assert entries == ({(0, 0), (0, 1), (1, 0), (1, 1)} if depends else set())
